// What a client's bytes do (RECEIVER.md 1.3, 1.4, 4.1, 4.2).
#include <algorithm>
#include <iterator>

#include "base/core/units.hpp"
#include "firmware/board_profile.hpp"
#include "firmware/corrections_and_assistance.hpp"
#include "firmware/messages/make_message.hpp"
#include "firmware/port_id.hpp"
#include "firmware/receiver_core.hpp"
#include "receiver/protocol/ubx_cfg.hpp"
#include "receiver/protocol/ubx_cfg_device.hpp"
#include "receiver/protocol/ubx_mon.hpp"
#include "receiver/protocol/ubx_nav.hpp"
#include "receiver/protocol/ubx_raw.hpp"

namespace skyloop::firmware {
namespace {

using namespace std::chrono_literals;

// A frame that was begun and not ended within this belongs to a client's hunt for the speed.
constexpr Nanoseconds frame_timeout = 2s;

constexpr UbxMessageId cfg_rst{0x06, 0x04}, cfg_valset{0x06, 0x8A}, cfg_valget{0x06, 0x8B}, cfg_valdel{0x06, 0x8C},
    nav_resetodo{0x01, 0x10};

ConfigOutcome refusal() { return {{}, Verdict::refuse, Seconds(0)}; }
ConfigOutcome silent() { return {{}, Verdict::silence, Seconds(0)}; }

std::optional<Bytes> verdict_frame(Verdict verdict, UbxMessageId to) {
    switch (verdict) {
        case Verdict::acknowledge:
            return encode_frame(AckAck{to.message_class, to.id});
        case Verdict::refuse:
            return encode_frame(AckNak{to.message_class, to.id});
        case Verdict::silence:
            break;
    }
    return std::nullopt;
}

bool takes(const BoardProfile& board, UbxMessageId legacy) {
    const auto known = board.legacy.find(legacy);
    return known != board.legacy.end() && known->second == LegacyAnswer::apply;
}

void count_input(PortStatus& status, const StreamPiece& piece) {
    switch (piece.kind) {
        case StreamKind::ubx:
            ++status.messages_in[0];
            break;
        case StreamKind::nmea:
            ++status.messages_in[1];
            break;
        case StreamKind::rtcm3:
            ++status.messages_in[2];
            break;
        default:
            status.skipped += static_cast<std::uint32_t>(piece.bytes.size());
            break;
    }
}

}  // namespace

void Receiver::Core::input(PortId port, ByteSpan bytes, GpsTime now) {
    counters_.bytes_received += bytes.size();
    PortUnit* unit = find_unit(units_, port);
    look_at_clock(now);
    if (unit == nullptr || faults_.deaf || bytes.empty()) return;
    if (sleep_) return feel(port, now);
    if (now < deaf_until_) return;
    unit->status.bytes_in += bytes.size();
    give_up_unfinished(*unit, now);
    give_way(*unit, now);
    unit->last_input = now;
    if (console_) return read_command_lines(*unit, bytes, now);
    const auto damaged = [&] { return unit->splitter.counts().bad[static_cast<std::size_t>(StreamKind::rtcm3)]; };
    std::uint64_t told = damaged();
    const std::vector<StreamPiece> pieces = unit->splitter.feed(bytes, now);
    for (; told < damaged(); ++told)
        if (board_.personality == Personality::ublox && accepts(*unit, StreamKind::rtcm3))
            answer_corrections(CorrectionInput::answer_to_damaged(), now);
    work_off(*unit, pieces, now);
    plan_to_give_way(*unit);
}

// Planned, so that what comes out does not depend on when one looks.
void Receiver::Core::plan_to_give_way(const PortUnit& unit) {
    const std::optional<GpsTime> at = unit.splitter.gives_way_at();
    if (at) outbox_.plan(*at, [this, port = unit.id](GpsTime t) { give_way(*find_unit(units_, port), t); });
}

void Receiver::Core::give_way(PortUnit& unit, GpsTime now) {
    const std::optional<GpsTime> at = unit.splitter.gives_way_at();
    if (console_ || !at || now < *at) return;  // a command line takes lines, and nothing inside them
    const std::vector<StreamPiece> pieces = unit.splitter.give_way();
    if (!sleep_ && *at >= deaf_until_) work_off(unit, pieces, *at);
}

void Receiver::Core::give_up_unfinished(PortUnit& unit, GpsTime now) {
    if (now - unit.last_input <= frame_timeout) return;
    give_way(unit, now);
    unit.last_input = now;
    work_off(unit, unit.splitter.finish(), now);
}

std::vector<Receiver::Sent> Receiver::Core::output(GpsTime now) {
    for (PortUnit& unit : units_)
        give_up_unfinished(unit, now);
    std::vector<Sent> sent = outbox_.run(now);
    while (wakes_by(now)) {
        look_at_clock(now);
        std::vector<Sent> after = outbox_.run(now);
        std::move(after.begin(), after.end(), std::back_inserter(sent));
    }
    return sent;
}

void Receiver::Core::work_off(PortUnit& unit, const std::vector<StreamPiece>& pieces, GpsTime now) {
    for (const StreamPiece& piece : pieces) {
        count_input(unit.status, piece);
        const std::uint32_t baud = unit.configured_baud;
        dispatch(unit, piece, now);
        // What follows was sent at a speed that the port no longer has.
        if (unit.configured_baud != baud || now < deaf_until_) {
            unit.forget_input();
            return;
        }
    }
}

bool Receiver::Core::accepts(const PortUnit& unit, StreamKind kind) const {
    const std::uint32_t protocol = kind == StreamKind::ubx    ? protocol_ubx
                                   : kind == StreamKind::nmea ? protocol_nmea
                                                              : protocol_rtcm3;
    return port_is_on(store_, unit.id) && store_.flag(key::in_protocol(unit.id, protocol));
}

void Receiver::Core::dispatch(PortUnit& unit, const StreamPiece& piece, GpsTime now) {
    if (piece.kind == StreamKind::noise || board_.personality == Personality::mute || !accepts(unit, piece.kind))
        return;
    if (piece.kind == StreamKind::nmea) return dispatch_sentence(unit, piece.bytes, now);
    if (board_.personality != Personality::ublox) return;
    if (piece.kind == StreamKind::ubx) return dispatch_ubx(unit, piece.bytes, now);
    answer_corrections(corrections_.take(piece.bytes, now, CorrectionLimits::of(store_)), now);
}

void Receiver::Core::dispatch_ubx(PortUnit& unit, ByteSpan bytes, GpsTime now) {
    const auto frame = parse_frame(bytes);
    if (!frame) return;
    if (faults_.refused.contains(frame->id))
        return reply(unit, {{}, verdict_frame(Verdict::refuse, frame->id), Seconds(0), frame->id}, now);
    if (frame->id.message_class == class_cfg) return configure(unit, *frame, now);
    command(unit, *frame, now);
}

void Receiver::Core::configure(PortUnit& unit, const UbxFrameView& frame, GpsTime now) {
    if (frame.id == cfg_rst) {
        values_.cancel();
        const auto rst = decode_payload<CfgRst>(frame.payload);
        if (!rst) return reply(unit, {{}, verdict_frame(Verdict::refuse, frame.id), Seconds(0), frame.id}, now);
        return reset(rst->nav_bbr_mask, rst->reset_mode, now);
    }
    if (frame.id == CfgPwr::message_id && takes(board_, frame.id)) return change_power_state(unit, frame, now);
    const ConfigOutcome outcome = configured(frame, unit.id);
    apply_changes(now);
    for (const std::string& warning : outcome.warnings)
        send_text(text_warning, warning, now);
    reply(unit, {outcome.answers, verdict_frame(outcome.verdict, frame.id), outcome.work, frame.id}, now);
}

ConfigOutcome Receiver::Core::configured(const UbxFrameView& frame, PortId from) {
    const bool by_values = frame.id == cfg_valset || frame.id == cfg_valget || frame.id == cfg_valdel;
    if (!by_values) {
        values_.cancel();
        return legacy_.handle(frame.id, frame.payload, from);
    }
    if (board_.quirks.value_config == ValueConfigSupport::refuse) return refusal();
    if (board_.quirks.value_config == ValueConfigSupport::silence) return silent();
    if (frame.id == cfg_valset) {
        if (!refuses_items(frame)) return values_.valset(frame.payload);
        values_.cancel();
        return refusal();
    }
    return frame.id == cfg_valget ? values_.valget(frame.payload) : values_.valdel(frame.payload);
}

// Everything but configuration: polls, and the few commands of other classes.
void Receiver::Core::command(PortUnit& unit, const UbxFrameView& frame, GpsTime now) {
    // A command, though not of class CFG, that is acknowledged (F9 interface description, UBX-NAV-RESETODO).
    if (frame.id == nav_resetodo && frame.payload.empty() && sends(board_, NavOdo::message_id)) {
        reset_odometer();
        return reply(unit, {{}, verdict_frame(Verdict::acknowledge, frame.id), Seconds(0), frame.id}, now);
    }
    if (frame.id == RxmPmreq::message_id && board_.power.backup) return request_backup(unit, frame, now);
    if (frame.id.message_class == class_mga) return assist(unit, frame, now);
    // There is no log to work on.
    if (frame.id.message_class == class_log)
        return reply(unit, {{}, verdict_frame(Verdict::refuse, frame.id), Seconds(0), frame.id}, now);
    if (!knows(board_, frame.id)) return;
    if (frame.id == UpdSos::message_id) return save_on_shutdown(unit, frame, now);
    // Of the messages that are answered none has a poll that selects a part of it.
    if (!frame.payload.empty()) return;
    std::vector<Bytes> answers = answers_of(frame.id, unit.id);
    if (answers.empty()) return;
    reply(unit, {std::move(answers), std::nullopt, Seconds(0), frame.id}, now);
}

// Assistance is taken and, where the client wants to know, acknowledged. The satellites themselves tell the receiver
// all it needs; of a time that it is told it remembers that it was, as what follows is judged by that.
void Receiver::Core::assist(PortUnit& unit, const UbxFrameView& frame, GpsTime now) {
    const TimeKnowledge& known = tracker_.state().time;
    const AssistanceInfo info = judge_assistance(frame, told_time_ || (known.time && known.date));
    if (info == AssistanceInfo::accepted && tells_time(frame)) told_time_ = true;
    if (!store_.flag(key::navspg_ackaiding)) return;
    MgaAck answer;
    answer.type = info == AssistanceInfo::accepted ? 1 : 0;
    answer.info_code = static_cast<std::uint8_t>(info);
    answer.msg_id = frame.id.id;
    std::copy_n(frame.payload.begin(), std::min(answer.payload_start.size(), frame.payload.size()),
                answer.payload_start.begin());
    reply(unit, {{encode_frame(answer)}, std::nullopt, Seconds(0), frame.id}, now);
}

// UPD-SOS: there is no backup, and none is made; to clear it is easily done.
void Receiver::Core::save_on_shutdown(PortUnit& unit, const UbxFrameView& frame, GpsTime now) {
    constexpr std::uint8_t create = 0, clear = 1, created = 2, restored = 3, no = 0, no_backup = 3;
    const auto told = [](std::uint8_t subject, std::uint8_t response) {
        return encode_frame(UpdSosStatus{.cmd = subject, .reserved0 = {}, .response = response, .reserved1 = {}});
    };
    Reply answer{{}, std::nullopt, Seconds(0), frame.id};
    const auto asked = decode_payload<UpdSos>(frame.payload);
    if (frame.payload.empty())
        answer.answers.push_back(told(restored, no_backup));
    else if (asked && asked->cmd == create)
        answer.answers.push_back(told(created, no));
    else
        answer.verdict = verdict_frame(asked && asked->cmd == clear ? Verdict::acknowledge : Verdict::refuse, frame.id);
    reply(unit, std::move(answer), now);
}

void Receiver::Core::dispatch_sentence(PortUnit& unit, ByteSpan line, GpsTime now) {
    const std::string text = to_string(line);
    const auto sentence = parse_sentence(text);
    if (!sentence) return;
    const UbxMessageId id = sentence_id(*sentence);
    // Sentences have no refusal: nothing happens.
    if (faults_.refused.contains(id)) return;
    carry_out(unit, execute_sentence(*sentence, board_, store_, unit.id), id, now);
}

void Receiver::Core::read_command_lines(PortUnit& unit, ByteSpan bytes, GpsTime now) {
    if (!port_is_on(store_, unit.id)) return;
    for (const StreamPiece& piece : unit.splitter.feed(bytes, now)) {
        count_input(unit.status, piece);
        if (piece.kind == StreamKind::rtcm3 && console_->hears_corrections(unit.id))
            corrections_.take(piece.bytes, now, CorrectionLimits::of(store_));
    }
    const std::uint32_t baud = unit.configured_baud;
    for (const std::string& line : unit.command_line.feed(bytes)) {
        carry_out(unit, console_->execute(line, store_, unit.id), {}, now);
        // What follows was sent at a speed that the port no longer has.
        if (unit.configured_baud != baud || now < deaf_until_) {
            unit.command_line = {};
            return;
        }
    }
}

void Receiver::Core::carry_out(PortUnit& unit, CommandOutcome outcome, UbxMessageId id, GpsTime now) {
    apply_changes(now);
    for (const UbxMessageId message : outcome.polled)
        for (Bytes& answer : make_message(message, context(unit.id)))
            outcome.answers.push_back(std::move(answer));
    const bool answered = !outcome.answers.empty() && !stays_silent_to(id);
    reply(unit, {std::move(outcome.answers), std::nullopt, Seconds(0), id}, now);
    if (outcome.positioning) switch_navigating(*outcome.positioning, now);
    if (outcome.standby) stand_by(std::max(now, last_answer_));
    if (!outcome.restart) return;
    const Forgotten forgotten = Forgotten::of(*outcome.restart);
    if (!answered) return reboot(forgotten, now, BootCause::software_reset);
    // What acknowledges a restart leaves before it.
    const PortId port = unit.id;
    outbox_.plan(last_answer_, [this, port, forgotten](GpsTime t) {
        const GpsTime told = find_unit(units_, port)->transmit.drained_at().value_or(t);
        outbox_.plan(told, [this, forgotten](GpsTime then) { reboot(forgotten, then, BootCause::software_reset); });
    });
}

void Receiver::Core::answer_corrections(const CorrectionAnswer& answer, GpsTime now) {
    const GpsTime at = answer_time(now, Seconds(0));
    const auto tell = [&](PortId port, UbxMessageId message, const Bytes& frame) {
        if (store_.rate(message, port) > 0 && lets_out(port, message) && !faults_.withheld.contains(message))
            outbox_.plan(at, [this, port, frame](GpsTime t) { send(port, {frame}, t); });
    };
    for (const PortId port : board_.ports) {
        tell(port, RxmRtcm::message_id, answer.rtcm);
        tell(port, RxmCor::message_id, answer.cor);
    }
}

}  // namespace skyloop::firmware
