#include "firmware/ublox/ublox.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "firmware/ublox/assistance.hpp"
#include "firmware/ublox/config/legacy_support.hpp"
#include "receiver/protocol/ubx_cfg.hpp"
#include "receiver/protocol/ubx_cfg_device.hpp"
#include "receiver/protocol/ubx_hardware.hpp"
#include "receiver/protocol/ubx_mon.hpp"
#include "receiver/protocol/ubx_nav.hpp"
#include "receiver/protocol/ubx_raw.hpp"
#include "receiver/protocol/ubx_time.hpp"

namespace skyloop::firmware {
namespace {

constexpr UbxMessageId cfg_rst{0x06, 0x04}, cfg_valset{0x06, 0x8A}, cfg_valget{0x06, 0x8B}, cfg_valdel{0x06, 0x8C},
    nav_resetodo{0x01, 0x10};

ConfigOutcome refusal() { return {{}, Verdict::refuse, Seconds(0)}; }
ConfigOutcome silent() { return {{}, Verdict::silence, Seconds(0)}; }

CommandOutcome with_verdict(bool positive, UbxMessageId of) {
    CommandOutcome outcome;
    outcome.verdict = acknowledgement(of, positive);
    outcome.to = of;
    return outcome;
}

bool applies(const BoardProfile& board, UbxMessageId legacy) {
    const auto known = board.legacy.find(legacy);
    return known != board.legacy.end() && known->second == LegacyAnswer::apply;
}

bool has_refused_item(const UbxFrameView& frame, const FirmwareFaults& faults) {
    if (faults.refused_keys.empty()) return false;
    const auto message = decode_payload<CfgValset>(frame.payload);
    return message && std::ranges::any_of(message->pairs, [&](const ConfigPair& pair) {
               return faults.refused_keys.contains(pair.key);
           });
}

// What is polled, with the identity that faults give the receiver.
std::vector<Bytes> answers_to(UbxMessageId polled, const Situation& asked) {
    const bool disguised = asked.faults.software || asked.faults.extensions;
    if (polled != MonVer::message_id || !disguised) return make_message(polled, asked.report);
    BoardProfile board = asked.report.board;
    if (asked.faults.software) board.identity.software = *asked.faults.software;
    if (asked.faults.extensions) board.identity.extensions = *asked.faults.extensions;
    return make_message(polled, {board, asked.report.config, asked.report.state, asked.report.ports, asked.from});
}

std::string do_not_go_together(const BoardProfile& board) {
    return "these items do not go together: " + board.name +
           " would refuse them, as no system that gives a position, too many, or signals that exclude each other";
}

}  // namespace

Bytes acknowledgement(UbxMessageId of, bool positive) {
    return positive ? encode_frame(AckAck{of.message_class, of.id}) : encode_frame(AckNak{of.message_class, of.id});
}

UbloxMaker::UbloxMaker(const BoardProfile& board, const ReceiverOptions& options)
    : Maker(board),
      base_(options.settings),
      store_(initial_config(board, options)),
      values_(board, store_),
      legacy_(board, store_) {}

const ReceiverConfig& UbloxMaker::config() const {
    if (config_revision_ == store_.revision()) return config_;
    config_ = receiver_config(store_, board(), base_);
    config_revision_ = store_.revision();
    return config_;
}

CommandOutcome UbloxMaker::receive(const StreamPiece& piece, const Situation& asked) {
    if (piece.kind == StreamKind::nmea) return receive_sentence(piece.bytes, asked);
    const auto frame = piece.kind == StreamKind::ubx ? parse_frame(piece.bytes) : std::nullopt;
    return frame ? receive_frame(*frame, asked) : CommandOutcome{};
}

CommandOutcome UbloxMaker::receive_frame(const UbxFrameView& frame, const Situation& asked) {
    if (asked.faults.refused.contains(frame.id)) return with_verdict(false, frame.id);
    CommandOutcome outcome = frame.id.message_class == class_cfg ? configure(frame, asked) : command(frame, asked);
    outcome.to = frame.id;
    return outcome;
}

CommandOutcome UbloxMaker::configure(const UbxFrameView& frame, const Situation& asked) {
    if (frame.id == cfg_rst) return reset(frame);
    if (frame.id == CfgPwr::message_id && applies(board(), frame.id)) {
        values_.cancel();
        return change_power_state(frame);
    }
    ConfigOutcome outcome = configured(frame, asked);
    CommandOutcome reply;
    reply.answers = std::move(outcome.answers);
    if (outcome.verdict != Verdict::silence)
        reply.verdict = acknowledgement(frame.id, outcome.verdict == Verdict::acknowledge);
    reply.work = outcome.work;
    reply.warnings = std::move(outcome.warnings);
    return reply;
}

ConfigOutcome UbloxMaker::configured(const UbxFrameView& frame, const Situation& asked) {
    const bool by_values = frame.id == cfg_valset || frame.id == cfg_valget || frame.id == cfg_valdel;
    if (!by_values) {
        values_.cancel();
        return legacy_.handle(frame.id, frame.payload, asked.from);
    }
    const ValueConfigSupport support = board().quirks.value_config;
    if (support == ValueConfigSupport::refuse) return refusal();
    if (support == ValueConfigSupport::silence) return silent();
    if (frame.id == cfg_valset) {
        if (!has_refused_item(frame, asked.faults)) return values_.valset(frame.payload);
        values_.cancel();
        return refusal();
    }
    return frame.id == cfg_valget ? values_.valget(frame.payload) : values_.valdel(frame.payload);
}

// resetMode (u-blox M8 interface description, 32.11.28). Other modes are not defined: nothing happens, and nothing is
// answered.
CommandOutcome UbloxMaker::reset(const UbxFrameView& frame) {
    constexpr std::uint8_t hardware = 0, software = 1, navigation = 2, hardware_after_shutdown = 4, stop = 8, start = 9;
    values_.cancel();
    const auto rst = decode_payload<CfgRst>(frame.payload);
    if (!rst) return with_verdict(false, frame.id);
    const Forgotten forgotten = Forgotten::by_mask(rst->nav_bbr_mask);
    CommandOutcome outcome;
    switch (rst->reset_mode) {
        case hardware:
        case hardware_after_shutdown:
            outcome.reset = Reset{Reset::Kind::hardware, forgotten};
            if (!board().quirks.hardware_reset_clears_battery) break;
            store_.clear(in_battery);
            outcome.reset->forgotten = Forgotten::of(StartKind::cold);
            break;
        case software:
            outcome.reset = Reset{Reset::Kind::software, forgotten};
            break;
        case navigation:
            outcome.reset = Reset{Reset::Kind::navigation, forgotten};
            break;
        case stop:
            outcome.reset = Reset{Reset::Kind::stop_navigation};
            break;
        case start:
            outcome.reset = Reset{Reset::Kind::start_navigation};
            break;
        default:
            break;
    }
    return outcome;
}

// Everything but configuration: polls, and the few commands of other classes.
CommandOutcome UbloxMaker::command(const UbxFrameView& frame, const Situation& asked) {
    CommandOutcome outcome;
    // A command, though not of class CFG, that is acknowledged (F9 interface description, UBX-NAV-RESETODO).
    if (frame.id == nav_resetodo && frame.payload.empty() && sends(board(), NavOdo::message_id)) {
        outcome = with_verdict(true, frame.id);
        outcome.resets_odometer = true;
        return outcome;
    }
    if (frame.id == RxmPmreq::message_id && board().power.backup) {
        outcome.sleep = requested_backup(frame, asked.from, board().power);
        return outcome;
    }
    if (frame.id.message_class == class_mga) return assist(frame, asked);
    // There is no log to work on.
    if (frame.id.message_class == class_log) return with_verdict(false, frame.id);
    if (!knows(board(), frame.id)) return outcome;
    if (frame.id == UpdSos::message_id) return save_on_shutdown(frame);
    // Of the messages that are answered none has a poll that selects a part of it.
    if (frame.payload.empty()) outcome.answers = answers_to(frame.id, asked);
    return outcome;
}

// Assistance is taken and, where the client wants to know, acknowledged. The satellites themselves give the receiver
// all it needs; of a time that it is given it remembers that it was, as what follows is judged by that.
CommandOutcome UbloxMaker::assist(const UbxFrameView& frame, const Situation& asked) {
    const bool time_known = knows_time_by_assistance_ || (asked.time.time && asked.time.date);
    const AssistanceInfo info = judge_assistance(frame, time_known);
    if (info == AssistanceInfo::accepted && tells_time(frame)) knows_time_by_assistance_ = true;
    CommandOutcome outcome;
    if (!store_.flag(key::navspg_ackaiding)) return outcome;
    MgaAck answer;
    answer.type = info == AssistanceInfo::accepted ? 1 : 0;
    answer.info_code = static_cast<std::uint8_t>(info);
    answer.msg_id = frame.id.id;
    std::copy_n(frame.payload.begin(), std::min(answer.payload_start.size(), frame.payload.size()),
                answer.payload_start.begin());
    outcome.answers.push_back(encode_frame(answer));
    return outcome;
}

CommandOutcome UbloxMaker::receive_sentence(ByteSpan line, const Situation& asked) {
    CommandOutcome outcome;
    const std::string text = to_string(line);
    const auto sentence = parse_sentence(text);
    if (!sentence) return outcome;
    outcome.to = sentence_id(*sentence);
    // Sentences have no refusal: nothing happens.
    if (asked.faults.refused.contains(outcome.to)) return outcome;
    const SentenceOutcome done = execute_ublox(*sentence, board(), store_);
    for (const UbxMessageId polled : done.polled)
        std::ranges::move(make_message(polled, asked.report), std::back_inserter(outcome.answers));
    if (!done.unknown || !board().quirks.answers_unknown_nmea) return outcome;
    // What M8 says to a maker's sentence that it does not know.
    constexpr std::size_t shown = 4;
    const ReceiverConfig& now = config();
    const PortConfig& port = now.port(asked.from);
    const bool passes = port.out.nmea && (port.nmea_texts >> text_warning & 1) != 0;
    const std::string warning = std::string(sentence->address.substr(0, shown)) + " inv format";
    if (passes)
        outcome.answers.push_back(
            to_bytes(encode(Txt{nmea_talker(board(), now), 1, 1, text_warning, warning}, nmea_format(board(), now))));
    return outcome;
}

std::optional<std::vector<PortMessage>> UbloxMaker::correction_reports(const CorrectionAnswer& answer,
                                                                       const FirmwareFaults& faults) const {
    std::vector<PortMessage> reports;
    const auto report = [&](PortId port, UbxMessageId message, const Bytes& frame) {
        if (store_.rate(message, port) > 0 && config().port(port).lets_out(message) &&
            !faults.withheld.contains(message))
            reports.push_back({port, frame});
    };
    for (const PortId port : board().ports) {
        report(port, RxmRtcm::message_id, answer.rtcm);
        report(port, RxmCor::message_id, answer.cor);
    }
    return reports;
}

// A receiver has hundreds of messages and sends a few: the others are not looked up again each epoch.
const std::vector<UbloxMaker::Periodic>& UbloxMaker::periodic_messages(PortId port) {
    if (periodic_revision_ != store_.revision()) periodic_.clear();
    periodic_revision_ = store_.revision();
    const auto [entry, is_new] = periodic_.try_emplace(port);
    if (!is_new) return entry->second;
    for (const UbxMessageId message : board().messages) {
        const int rate = store_.rate(message, port);
        if (rate > 0 && config().port(port).lets_out(message))
            entry->second.push_back({message, static_cast<std::uint64_t>(rate)});
    }
    return entry->second;
}

// What belongs to a time pulse counts pulses, whatever the navigation rate; the rest counts epochs.
bool UbloxMaker::is_due(const Periodic& message, PortId port, const EpochMessages& made) {
    if (message.id != TimTp::message_id) return made.state().epoch_index % message.every == 0;
    const auto pulses = pulses_until_epoch(made.context(port));
    if (!pulses) return false;
    const std::int64_t pulse = *pulses / static_cast<std::int64_t>(message.every);
    const auto [sent, is_first] = sent_pulses_.try_emplace(port, pulse);
    return is_first || std::exchange(sent->second, pulse) != pulse;
}

DueMessages UbloxMaker::due(PortId port, EpochMessages& made, const FirmwareFaults& faults) {
    std::vector<UbxMessageId> due;
    for (const Periodic& message : periodic_messages(port))
        if (!faults.withheld.contains(message.id) && is_due(message, port, made)) due.push_back(message.id);
    DueMessages messages;
    for (std::size_t i = 0; i < due.size(); ++i) {
        const std::vector<Bytes>& frames = made.of(due[i], port, std::span(due).subspan(i + 1));
        messages.frames.insert(messages.frames.end(), frames.begin(), frames.end());
    }
    return messages;
}

std::string_view UbloxMaker::navigation_text(bool on) const { return on ? "Starting GNSS" : "Stopping GNSS"; }

void UbloxMaker::restart(bool keeps_ram) {
    if (!keeps_ram) store_.reload();
    values_.cancel();
    sent_pulses_.clear();
}

void UbloxMaker::navigation_restarts(const Forgotten& forgotten) {
    if (forgotten.rtc) knows_time_by_assistance_ = false;
}

void UbloxMaker::forget_settings() {
    store_.clear(in_battery | in_flash);
    store_.reload();
    values_.cancel();
}

bool UbloxMaker::takes_speed(std::uint32_t baud) const { return is_in_range(board(), key::uart1_baudrate, baud); }

Result<void> UbloxMaker::configure(const std::map<std::uint32_t, std::uint64_t>& items) {
    ConfigStore after = store_;
    for (const auto& [id, value] : items) {
        const ConfigKey* item = find_config_key(id);
        const std::string name = item == nullptr ? fmt::format("item 0x{:08x}", id) : std::string(item->name);
        if (!store_.has(id)) return fail(ErrorCode::usage, fmt::format("{} has no {}", board().name, name));
        if (!is_in_range(board(), id, value))
            return fail(ErrorCode::usage,
                        fmt::format("{} is {}, which {} itself would refuse", name, value, board().name));
        after.set(has_flash(board()) ? in_flash : in_battery, id, value);
    }
    return keep(std::move(after), ErrorCode::usage, "");
}

// Settings that a receiver would refuse, it would go on to refuse with every later one.
Result<void> UbloxMaker::restore(const std::string& text, const std::string& name) {
    ConfigStore after = store_;
    const auto allows = [&](std::uint32_t key, std::uint64_t value) { return is_in_range(board(), key, value); };
    const ConfigLayers layers = has_flash(board()) ? in_battery | in_flash : in_battery;
    if (auto restored = after.restore(text, name, allows, layers); !restored) return restored;
    return keep(std::move(after), ErrorCode::input, name + ": ");
}

Result<void> UbloxMaker::keep(ConfigStore after, ErrorCode code, const std::string& prefix) {
    if (spoils_start(board(), store_, after)) return fail(code, prefix + do_not_go_together(board()));
    store_ = std::move(after);
    store_.reload();
    return {};
}

std::unique_ptr<Maker> make_ublox(const BoardProfile& board, const ReceiverOptions& options) {
    return std::make_unique<UbloxMaker>(board, options);
}

std::optional<RefusedOptions> ublox_refuses(const BoardProfile& board, const ReceiverOptions& options) {
    const ConfigValues values = initial_config(board, options);
    if (const auto* item = first_out_of_range(board, values))
        return RefusedOptions{item->first, fmt::format("{} is {}, which {} itself would refuse",
                                                       find_config_key(item->first)->name, item->second, board.name)};
    if (is_consistent(board, values)) return std::nullopt;
    return RefusedOptions{std::nullopt,
                          board.name +
                              " itself would refuse these systems: none that gives a position, too many, or "
                              "signals that exclude each other"};
}

}  // namespace skyloop::firmware
