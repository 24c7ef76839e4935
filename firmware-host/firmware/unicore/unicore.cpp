#include "firmware/unicore/unicore.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "base/core/number_text.hpp"
#include "base/core/words.hpp"
#include "firmware/core/factory_settings.hpp"
#include "firmware/core/state_tracker.hpp"
#include "firmware/messages/field_values.hpp"
#include "firmware/sentences/sentence_maker.hpp"
#include "firmware/unicore/commands.hpp"
#include "firmware/unicore/logs.hpp"

namespace skyloop::firmware {
namespace {

std::vector<std::string> lines_of_text(std::string_view text) {
    std::vector<std::string> lines;
    while (!text.empty()) {
        const std::size_t end = std::min(text.find('\n'), text.size());
        if (end > 0) lines.emplace_back(text.substr(0, end));
        text.remove_prefix(std::min(end + 1, text.size()));
    }
    return lines;
}

}  // namespace

UnicoreMaker::UnicoreMaker(const BoardProfile& board, const ReceiverOptions& options)
    : Maker(board),
      start_(factory_settings(board, options)),
      factory_(board),
      saved_(factory_),
      now_(factory_),
      pauses_(options.seed, "unicore.answers") {
    start_.reports_dead_reckoning = false;
    for (PortConfig& port : start_.ports) {
        port.in = {.ubx = false, .nmea = false, .rtcm3 = true};
        port.out = {.ubx = false, .nmea = true, .rtcm3 = true};
    }
    // What a run has its board send from the start on, by UART1.
    for (const BoardSentence& sentence : board_sentences(board)) {
        const std::uint64_t every = factory_rate(board, sentence.index);
        const std::string name = "GP" + std::string(nmea_sentence_names[sentence.index]);
        const auto kind = every == 0 ? std::nullopt : unicore_log(board, name);
        const auto own = static_cast<std::uint64_t>(start_.settings.navigation_period / std::chrono::milliseconds(1));
        if (kind) factory_.add({PortId::uart1, name, *kind, every * own});
    }
    saved_ = now_ = factory_;
    adopt();
}

std::vector<StreamPiece> UnicoreMaker::cut(PortUnit& unit, ByteSpan bytes, GpsTime now) {
    std::vector<StreamPiece> pieces = unit.splitter.feed(bytes, now);
    CommandLineReader& reader = lines_.try_emplace(unit.id, too_long_command, LongLine::is_cut).first->second;
    for (const std::string& line : reader.feed(bytes))
        if (!line.empty()) pieces.push_back({StreamKind::command, to_bytes(line)});
    return pieces;
}

CommandOutcome UnicoreMaker::receive(const StreamPiece& piece, const Situation& asked) {
    CommandOutcome outcome;
    if (piece.kind != StreamKind::command || com_name(asked.from).empty()) return outcome;
    const std::uint32_t speed = config_.port(asked.from).baud;
    execute(to_string(piece.bytes), asked, outcome);
    // What follows was sent at a speed that the port no longer has, or to a receiver that starts.
    const bool other_speed = config_.port(asked.from).baud != speed;
    if (outcome.reset || other_speed) lines_.erase(asked.from);
    // No log leaves at the old speed while answers still do.
    constexpr std::chrono::milliseconds answers_of_a_burst{250};
    if (other_speed) quiet_until_[asked.from] = asked.now + answers_of_a_burst;
    return outcome;
}

// The position is that of the master antenna, solved alone or with a base's corrections: the pair makes no better one.
// Its vector leads from there to the slave. What stands where it was told has that place.
void UnicoreMaker::restrict(NavigationState& state) const {
    tell_given_place(state);
    auto& relative = state.epoch.relative;
    if (!relative || !relative->base_moves) return;
    Fix& fix = state.epoch.fix;
    const bool of_pair = fix.type == FixType::rtk_fixed || fix.type == FixType::rtk_float;
    if (of_pair && !state.corrections.come) fix.type = fix.sbas_source ? FixType::dgnss : FixType::fix_3d;
    if (!has_two_antennas(board())) return relative.reset();
    relative->north_m *= -1;
    relative->east_m *= -1;
    relative->down_m *= -1;
}

void UnicoreMaker::follow(const NavigationState& state, GpsTime) {
    constexpr double full_answers_after_s = 2;  // SparkFun_RTK_Everywhere asks again then
    has_started_ = has_started_ || state.since_boot.value() >= full_answers_after_s;
}

DueMessages UnicoreMaker::due(PortId port, EpochMessages& made, const FirmwareFaults& faults) {
    DueMessages due;
    const std::uint64_t tow_ms = whole_milliseconds(gps_stamp(made.state().epoch.fix.time));
    std::vector<const UnicoreLog*> logs;
    std::vector<UbxMessageId> corrections;
    const auto quiet = quiet_until_.find(port);
    if (quiet != quiet_until_.end() && made.state().epoch.fix.time < quiet->second) return due;
    for (const UnicoreLog& log : now_.logs) {
        if (log.port != port || tow_ms % log.period_ms != 0 || faults.withheld.contains(log.kind.id)) continue;
        logs.push_back(&log);
        if (log.kind.form == UnicoreForm::rtcm) corrections.push_back(log.kind.id);
    }
    std::size_t passed = 0;
    for (const UnicoreLog* log : logs) {
        if (log->kind.form == UnicoreForm::rtcm) ++passed;
        due.add(unicore_messages(log->kind, made, port, std::span(corrections).subspan(passed)));
    }
    return due;
}

std::vector<Bytes> UnicoreMaker::greeting(PortId port) const {
    if (com_name(port).empty()) return {};
    return {to_bytes(unicore_answer_line(fmt::format("$devicename,{}", com_name(port))))};
}

void UnicoreMaker::restart(bool keeps_ram) {
    if (!keeps_ram) now_ = saved_;
    has_started_ = false;
    lines_.clear();
    adopt();
}

void UnicoreMaker::forget_settings() {
    saved_ = now_ = factory_;
    adopt();
}

void UnicoreMaker::set_speed(std::uint32_t baud) {
    now_.bauds[PortId::uart1] = baud;
    adopt();
}

Result<void> UnicoreMaker::restore(const std::string& text, const std::string& name) {
    now_ = factory_;
    for (const std::string& line : lines_of_text(text))
        if (!take_setting(unicore_words(line), PortId::uart1)) {
            now_ = saved_;
            return fail(ErrorCode::input,
                        fmt::format("{}: '{}' is no setting of a {}", name, line, board().identity.hardware));
        }
    saved_ = now_;
    adopt();
    return {};
}

// What measurement and solution must know.
void UnicoreMaker::adopt() {
    ++revision_;
    config_ = start_;
    const auto own = static_cast<std::uint64_t>(start_.settings.navigation_period / std::chrono::milliseconds(1));
    const std::uint64_t period = wanted_period_ms(now_).value_or(own);
    set_navigation_period(config_.settings, feasible_period(std::chrono::milliseconds(period), 1, board()), board());
    for (const auto& [port, baud] : now_.bauds)
        config_.ports[static_cast<std::size_t>(port)].baud = baud;
    if (now_.mask_deg != factory_.mask_deg)
        config_.elevation_mask = config_.settings.elevation_mask = Angle::degrees(now_.mask_deg);
    if (now_.least_cn0) config_.settings.minimum_cn0 = DbHz(*now_.least_cn0);
    if (const auto seconds = now_.topic_number("DGPS TIMEOUT")) config_.corrections.timeout = Seconds(*seconds);
    if (now_.mode.dynamic_model) {
        config_.limits.dynamic_model = *now_.mode.dynamic_model;
        config_.settings.dynamic_model = dynamic_model_of(static_cast<std::uint64_t>(*now_.mode.dynamic_model));
    }
    config_.survey = now_.mode.survey;
    config_.place = now_.mode.place;
    config_.station = now_.mode.station;
    adopt_systems();
}

// A mask that leaves no system which gives a position would leave no receiver: then nothing changes.
void UnicoreMaker::adopt_systems() {
    std::vector<Constellation> systems = start_.systems;
    std::erase_if(systems, [&](Constellation system) { return now_.masked.contains(system); });
    if (std::ranges::none_of(systems, gives_position)) return;
    config_.systems = systems;
    std::erase_if(config_.settings.signals,
                  [&](const SystemSignal& signal) { return now_.masked.contains(signal.constellation); });
}

std::unique_ptr<Maker> make_unicore(const BoardProfile& board, const ReceiverOptions& options) {
    return std::make_unique<UnicoreMaker>(board, options);
}

Abilities unicore_abilities(const BoardProfile& board) {
    return {.choice = Abilities::MessageChoice::command_line,
            .heading = has_two_antennas(board),
            .accuracies = true,
            .weeks = true,
            .time = true,
            .calendar = true,
            .dead_reckoning = false,
            .corrections = true,
            .more = {"UNICORE"},
            .own_prefix = "RTCM-"};
}

}  // namespace skyloop::firmware
