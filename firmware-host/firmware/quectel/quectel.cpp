#include "firmware/quectel/quectel.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "firmware/airoha/airoha.hpp"
#include "firmware/messages/station_messages.hpp"
#include "receiver/protocol/rtcm3.hpp"

namespace skyloop::firmware {
namespace {

// A base of a few letters in the name of the module: LC29H-BS.
bool is_base_module(const BoardProfile& board) { return board.identity.hardware.ends_with("BS"); }

constexpr std::array<std::uint8_t, 5> msm4_ids{74, 84, 94, 114, 124}, msm7_ids{77, 87, 97, 117, 127};

}  // namespace

OwnSettings quectel_settings(const BoardProfile& board) {
    OwnSettings settings;
    const bool base = is_base_module(board);
    settings.add(QuectelKeys::mode, "receiver_mode", base ? quectel_base : quectel_rover);
    settings.add(QuectelKeys::survey, "survey_mode", 0);
    settings.add(QuectelKeys::survey_positions, "survey_positions", 0);
    settings.add(QuectelKeys::survey_accuracy_mm, "survey_accuracy_mm", 0);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        settings.add(QuectelKeys::metres(axis), fmt::format("survey_{}_m", "xyz"[axis]),
                     static_cast<std::uint64_t>(quectel_axis_offset_m));
        settings.add(QuectelKeys::rest(axis), fmt::format("survey_{}_rest", "xyz"[axis]), 0);
    }
    settings.add(QuectelKeys::msm, "msm", base ? 7 : 4);
    settings.add(QuectelKeys::station, "station_message", 1);
    settings.add(QuectelKeys::elevation, "elevation_deg",
                 static_cast<std::uint64_t>(std::lround(board.elevation_mask.deg())));
    for (const PortId port : board.ports)
        if (is_uart(port))
            settings.add(SentenceSettings::baud(port),
                         fmt::format("baud_{}", port_names[static_cast<std::size_t>(port)]), board.baud);
    for (const PortId port : board.ports)
        for (std::size_t i = 0; i < quectel_messages.size(); ++i)
            settings.add(QuectelKeys::rate(i, port),
                         fmt::format("{}_{}", quectel_messages[i].name, port_names[static_cast<std::size_t>(port)]), 0);
    return settings;
}

QuectelMaker::QuectelMaker(const BoardProfile& board, const ReceiverOptions& options)
    : SentenceMaker(board, options, false, quectel_settings(board).list) {}

CommandOutcome QuectelMaker::receive(const StreamPiece& piece, const Situation& asked) {
    CommandOutcome outcome;
    const std::string text = to_string(piece.bytes);
    if (piece.kind != StreamKind::nmea) return outcome;
    const auto sentence = parse_sentence(text);
    if (!sentence) return outcome;
    if (sentence->address.starts_with("PQTM")) {
        execute({*sentence, asked, outcome});
        return outcome;
    }
    if (!has_pair() || !sentence->address.starts_with("PAIR")) return outcome;
    if (correction_output(*sentence, outcome)) return outcome;
    return execute_pair(*sentence, board(), settings(), asked.from);
}

void QuectelMaker::restart(bool keeps_ram) {
    coming_.clear();
    topics_.clear();
    SentenceMaker::restart(keeps_ram);
}

void QuectelMaker::forget_settings() {
    coming_.clear();
    topics_.clear();
    SentenceMaker::forget_settings();
}

std::uint64_t QuectelMaker::coming(std::uint32_t key) const {
    const auto found = coming_.find(key);
    return found == coming_.end() ? settings().value(key) : found->second;
}

void QuectelMaker::adjust(ReceiverConfig& config) const {
    const SentenceSettings& store = settings();
    for (const PortId port : board().ports) {
        PortConfig& one = config.ports[static_cast<std::size_t>(port)];
        one.in = {.ubx = false, .nmea = true, .rtcm3 = !is_base()};
        one.out = {.ubx = false, .nmea = true, .rtcm3 = true};
        one.nmea_texts = 0;
    }
    const auto elevation = store.value(QuectelKeys::elevation);
    if (store.stored(ConfigLayer::factory, QuectelKeys::elevation) != elevation)
        config.elevation_mask = config.settings.elevation_mask = Angle::degrees(static_cast<double>(elevation));
    if (!is_base()) return;
    constexpr std::uint64_t surveys = 1, stands = 2;
    constexpr double any_accuracy_m = 1e6, thousandths = 1000;
    if (store.value(QuectelKeys::survey) == surveys) {
        const auto mm = static_cast<double>(store.value(QuectelKeys::survey_accuracy_mm));
        config.survey = SurveyLimits{Seconds(static_cast<double>(store.value(QuectelKeys::survey_positions))),
                                     Metres(mm > 0 ? mm / thousandths : any_accuracy_m)};
    }
    if (store.value(QuectelKeys::survey) != stands) return;
    const auto axis_m = [&](std::size_t axis) {
        return quectel_axis_m(store.value(QuectelKeys::metres(axis)), store.value(QuectelKeys::rest(axis)));
    };
    config.place = BasePlace{Position<Ecef>(axis_m(0), axis_m(1), axis_m(2)), Metres(0)};
}

// A rover sends sentences, as a module that is nothing but a base does where it is asked to; a base its place, its name
// and observations each second, and its survey where it is asked to.
DueMessages QuectelMaker::due(PortId port, EpochMessages& made, const FirmwareFaults& faults) {
    DueMessages due;
    if (!is_base() || is_base_module(board())) due = SentenceMaker::due(port, made, faults);
    std::vector<Bytes> own;
    for (std::size_t i = 0; i < quectel_messages.size(); ++i) {
        const std::uint64_t every = settings().value(QuectelKeys::rate(i, port));
        const bool of_base = quectel_messages[i].name == "PQTMSVINSTATUS";
        if (every == 0 || made.state().epoch_index % every != 0 || (is_base() && !of_base)) continue;
        if (const auto body = quectel_sentence(quectel_messages[i].name, made.context(port)))
            own.push_back(to_bytes(Sentence(*body).finish()));
    }
    due.add(std::move(own));
    const auto second = std::chrono::seconds(1);
    if (!is_base() || made.state().epoch.fix.time.time_since_epoch() % second >= std::chrono::milliseconds(1))
        return due;
    std::vector<UbxMessageId> messages;
    if (settings().flag(QuectelKeys::station)) messages.push_back({class_rtcm, 5});
    if (!has_pair()) messages.push_back({class_rtcm, 33});
    const std::uint64_t msm = settings().value(QuectelKeys::msm);
    if (msm != 0)
        for (const std::uint8_t id : msm == 4 ? msm4_ids : msm7_ids)
            messages.push_back({class_rtcm, id});
    for (std::size_t i = 0; i < messages.size(); ++i)
        if (!faults.withheld.contains(messages[i]))
            due.add(make_station_message(messages[i], made, port, std::span(messages).subspan(i + 1)));
    return due;
}

std::unique_ptr<Maker> make_quectel(const BoardProfile& board, const ReceiverOptions& options) {
    return std::make_unique<QuectelMaker>(board, options);
}

Abilities quectel_abilities(const BoardProfile& board) {
    return {.choice = Abilities::MessageChoice::rates,
            .accuracies = true,
            .weeks = !is_base_module(board),
            .time = true,
            .calendar = true,
            .dead_reckoning = false,
            .corrections = !is_base_module(board),
            .more = {"PAIR001", "RTCM-1005", "RTCM-1033", "RTCM-1074", "RTCM-1084", "RTCM-1094", "RTCM-1114",
                     "RTCM-1124", "RTCM-1077", "RTCM-1087", "RTCM-1097", "RTCM-1117", "RTCM-1127"},
            .own_prefix = "PQTM"};
}

}  // namespace skyloop::firmware
