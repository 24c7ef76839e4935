// What leaves the receiver and when (RECEIVER.md 4.2, 4.5 to 4.7).
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "firmware/messages/make_message.hpp"
#include "firmware/messages/other_protocols.hpp"
#include "firmware/navigation_state.hpp"
#include "firmware/port_id.hpp"
#include "firmware/receiver_core.hpp"
#include "firmware/septentrio/rover_and_station.hpp"
#include "receiver/protocol/ubx_time.hpp"

namespace skyloop::firmware {
namespace {

constexpr double late_epochs = 0.005, late_by_s = 0.020;

std::uint32_t protocol_item(UbxMessageId message) {
    if (message.message_class == class_nmea || message.message_class == class_pubx) return protocol_nmea;
    return message.message_class == class_rtcm ? protocol_rtcm3 : protocol_ubx;
}

// By what a ready message begins with.
UbxMessageId protocol_of(const Bytes& message) {
    constexpr std::uint8_t rtcm3_sync = 0xD3;
    if (message.front() == ubx_sync_1) return {};
    return {message.front() == rtcm3_sync ? class_rtcm : class_nmea, 0};
}

std::string_view antenna_text(AntennaStatus status) {
    constexpr std::array<std::string_view, 5> texts{"ANTSTATUS=INIT", "ANTSTATUS=DONTKNOW", "ANTSTATUS=OK",
                                                    "ANTSTATUS=SHORT", "ANTSTATUS=OPEN"};
    return texts[static_cast<std::size_t>(status)];
}

// What measures was handed its corrections before; of models that measure nothing the fix has got those of now.
CorrectionState solved_with(const Epoch& epoch, CorrectionState handed, CorrectionState now) {
    return epoch.observations.signals.empty() ? now : handed;
}

// What of the corrections is in the solution: with few satellites, or none, it is less than there could be.
CorrectionState in_solution(const Fix& fix, CorrectionState at_most) {
    if (at_most == CorrectionState::none) return CorrectionState::none;
    switch (fix.type) {
        case FixType::dgnss:
            return CorrectionState::differential;
        case FixType::rtk_float:
            return CorrectionState::rtk_float;
        case FixType::rtk_fixed:
            return CorrectionState::rtk_fixed;
        default:
            return CorrectionState::none;
    }
}

}  // namespace

void Receiver::Core::look_at_ports() {
    statuses_.clear();
    for (PortUnit& unit : units_) {
        unit.status.pending = unit.transmit.pending();
        statuses_.push_back(unit.status);
    }
}

ReportContext Receiver::Core::context(PortId port) {
    look_at_ports();
    return context(port, *reported_);
}

ReportContext Receiver::Core::context(PortId port, const NavigationState& state) const {
    return {board_, store_, state, statuses_, port};
}

bool Receiver::Core::lets_out(PortId port, UbxMessageId message) const {
    return port_is_on(store_, port) && store_.flag(key::out_protocol(port, protocol_item(message)));
}

// Commands are worked off one after the other; each takes the board's usual time and what it has to do besides.
GpsTime Receiver::Core::answer_time(GpsTime now, Seconds work) {
    busy_until_ = advanced(advanced(std::max(now, busy_until_), board_.timing.answer), work);
    last_answer_ = std::max(last_answer_, advanced(busy_until_, faults_.answer_delay));
    return last_answer_;
}

// Answers leave before the verdict. A new speed of the port of arrival comes in force with the answer, or after it, or
// swallows it, as the board's maker has it.
void Receiver::Core::reply(PortUnit& unit, Reply out, GpsTime now) {
    const PortId port = unit.id;
    const bool swallowed =
        board_.quirks.speed_change == SpeedChangeAnswer::lost && wanted_baud(port) != unit.configured_baud;
    if (stays_silent_to(out.to))
        out.answers.clear();
    else if (out.verdict && !swallowed)
        out.answers.push_back(*out.verdict);
    const bool anything = !out.answers.empty();
    if (!anything && configured_speeds_hold()) return;
    const GpsTime at = answer_time(now, out.work);
    const bool old_speed = board_.quirks.speed_change == SpeedChangeAnswer::at_old_speed;
    if (!old_speed) plan_speed_changes(at);
    if (anything)
        outbox_.plan(at, [this, port, messages = std::move(out.answers)](GpsTime t) {
            std::vector<Bytes> let_out;
            for (const Bytes& message : messages)
                if (lets_out(port, protocol_of(message))) let_out.push_back(message);
            send(port, let_out, t);
        });
    if (old_speed) plan_speed_changes(at);
}

bool Receiver::Core::configured_speeds_hold() const {
    return std::ranges::all_of(units_, [&](const PortUnit& u) { return wanted_baud(u.id) == u.configured_baud; });
}

void Receiver::Core::plan_speed_changes(GpsTime at) {
    const bool drain = board_.quirks.speed_change == SpeedChangeAnswer::at_old_speed;
    for (PortUnit& unit : units_) {
        const std::uint32_t baud = wanted_baud(unit.id);
        if (baud == unit.configured_baud) continue;
        unit.configured_baud = baud;
        const PortId port = unit.id;
        outbox_.plan(at, [this, port, drain](GpsTime t) {
            const Port& line = find_unit(units_, port)->transmit;
            const GpsTime when = drain ? line.drained_at().value_or(t) : line.between_bytes(t);
            outbox_.plan(when, [this, port](GpsTime then) { change_speed(port, then); });
        });
    }
}

void Receiver::Core::change_speed(PortId port, GpsTime at) {
    PortUnit& unit = *find_unit(units_, port);
    unit.transmit.set_baud(unit.configured_baud, at);
    unit.forget_input();
}

void Receiver::Core::send(PortId port, const std::vector<Bytes>& messages, GpsTime now) {
    if (!faults_.mute) outbox_.queue(port, std::vector<ByteSpan>(messages.begin(), messages.end()), now);
}

void Receiver::Core::send_in_turn(PortId port, std::span<const ByteSpan> messages, GpsTime now) {
    if (!faults_.mute) outbox_.queue_in_turn(port, messages, now);
}

ReceiverCounters Receiver::Core::counters() const {
    ReceiverCounters counters = counters_;
    for (const PortUnit& unit : units_) {
        counters.messages_sent += unit.totals.messages_out;
        counters.messages_dropped += unit.totals.messages_dropped;
    }
    return counters;
}

void Receiver::Core::send_text(int level, const std::string& text, GpsTime now) {
    for (const PortId port : board_.ports)
        send(port, make_text_message(level, text, context(port)), now);
}

GpsTime Receiver::Core::burst_time(GpsTime epoch) {
    const double deviation = board_.timing.latency_deviation.value();
    // Bounded at three deviations, with a rare epoch that comes much later (RECEIVER.md 4.6); one epoch's output never
    // overtakes another's.
    double jitter = 0;
    if (deviation > 0) {
        jitter = deviation * std::clamp(latency_noise_.normal(), -3.0, 3.0);
        if (latency_noise_.uniform() < late_epochs) jitter += late_by_s;
    }
    const double delay = std::max(0.0, faults_.solution_delay.value());
    const double latency = std::max(0.0, board_.solution_latency.value() + jitter) + delay;
    last_burst_ = std::max(last_burst_, advanced(epoch, Seconds(latency)));
    return last_burst_;
}

const ReceiverSettings& Receiver::Core::settings_at(GpsTime epoch) {
    settings_.corrections = allowed(corrections_.status(epoch, store_).state);
    if (console_) settings_.subframes = wants_messages(console_->state().settings);
    return settings_;
}

void Receiver::Core::on_epoch(const Epoch& epoch, const ReportEdit& edit) {
    const GpsTime time = epoch.fix.time;
    report_time_.reset();
    look_at_clock(time);
    if (sleep_ || falling_asleep_ || time < silent_until_) return;
    CorrectionStatus corrections = corrections_.status(time, store_);
    corrections.come = corrections.state != CorrectionState::none;
    corrections.state = allowed(corrections.state);
    const CorrectionState used = solved_with(epoch, settings_.corrections, corrections.state);
    settings_.corrections = corrections.state;
    const auto state = std::make_shared<NavigationState>(tracker_.update(epoch, store_, corrections));
    state->corrections.state = in_solution(state->epoch.fix, used);
    state->monitors.jamming_hidden = faults_.jamming_hidden;
    state->monitors.told_elsewhere = jamming_told_elsewhere_;
    carry_to_clock_instant(*state);
    const std::optional<PowerSave::Rest> off = settings_.navigating ? power_.update(*state) : std::nullopt;
    state->power_save = power_.state();
    follow_power();
    if (console_) {
        withhold_forbidden(console_->state().settings, *state);
        tell_given_place(*state);
    }
    if (edit) edit(*state);
    reported_ = state;
    ++counters_.epochs;
    if (!settings_.navigating) return;
    const GpsTime burst = advanced(burst_time(time), state->report_delay);
    for (int i = 0; i < state->reports; ++i)
        outbox_.plan(burst, [this, state](GpsTime t) { send_epoch(*state, t); });
    if (state->reports > 0 && !faults_.mute) report_time_ = burst;
    if (off) rest(*off, burst);
}

void Receiver::Core::send_epoch(const NavigationState& state, GpsTime now) {
    if (console_) console_->follow(state);
    for (PortUnit& unit : units_) {
        outbox_.give_up_turns(unit, now);
        unit.status.transmit_full = std::exchange(unit.overflowed, false);
    }
    look_at_ports();
    EpochMessages made(context(PortId::uart1, state));
    const auto send_all = [&](PortId port, const std::vector<Bytes>& messages) {
        send_in_turn(port, std::vector<ByteSpan>(messages.begin(), messages.end()), now);
    };
    for (PortUnit& unit : units_) {
        const std::vector<ByteSpan> messages = due_messages(unit, state, made);
        tell_overflow(unit, now);
        if (unit.id == PortId::uart1)
            send_all(unit.id, make_protocol_messages(board_.personality, context(unit.id, state), mavlink_sent_));
        if (console_ && port_is_on(store_, unit.id))
            send_all(unit.id, septentrio_output(console_->state(), context(unit.id, state)));
        send_in_turn(unit.id, messages, now);
    }
    tell_antenna_status(state, now);
}

// Before the next epoch's messages, which fill the line again.
void Receiver::Core::tell_overflow(PortUnit& unit, GpsTime now) {
    if (unit.status.transmit_full && board_.quirks.overflow_notice)
        send(unit.id, make_text_message(text_error, "txbuf alloc", context(unit.id, *reported_)), now);
}

// A receiver has hundreds of messages and sends a few: the others are not looked up again each epoch.
void Receiver::Core::read_configured_messages(PortUnit& unit) const {
    if (unit.configured.revision == store_.revision()) return;
    unit.configured = {{}, store_.revision()};
    for (const UbxMessageId message : board_.messages) {
        const int rate = store_.rate(message, unit.id);
        if (rate > 0 && lets_out(unit.id, message))
            unit.configured.messages.push_back({message, static_cast<std::uint64_t>(rate)});
    }
}

// What belongs to a time pulse counts pulses, whatever the navigation rate; the rest counts epochs.
bool Receiver::Core::is_due(PortUnit& unit, UbxMessageId message, std::uint64_t every,
                            const NavigationState& state) const {
    if (message != TimTp::message_id) return state.epoch_index % every == 0;
    const auto pulses = pulses_until_epoch(context(unit.id, state));
    if (!pulses) return false;
    const std::int64_t pulse = *pulses / static_cast<std::int64_t>(every);
    return std::exchange(unit.told_pulse, pulse) != pulse;
}

// They are those of `made`.
std::vector<ByteSpan> Receiver::Core::due_messages(PortUnit& unit, const NavigationState& state,
                                                   EpochMessages& made) const {
    read_configured_messages(unit);
    std::vector<UbxMessageId> due;
    for (const auto& [message, every] : unit.configured.messages)
        if (!faults_.withheld.contains(message) && is_due(unit, message, every, state)) due.push_back(message);
    std::vector<ByteSpan> frames;
    for (std::size_t i = 0; i < due.size(); ++i) {
        const std::vector<Bytes>& messages = made.of(due[i], unit.id, std::span(due).subspan(i + 1));
        frames.insert(frames.end(), messages.begin(), messages.end());
    }
    return frames;
}

void Receiver::Core::tell_antenna_status(const NavigationState& state, GpsTime now) {
    const AntennaStatus status = state.monitors.antenna;
    if (told_antenna_ && *told_antenna_ != status) send_text(text_notice, std::string(antenna_text(status)), now);
    told_antenna_ = status;
}

// What the banner says of the antenna has been told: the state that follows is a change from it.
void Receiver::Core::send_banner(GpsTime now, bool woken) {
    const bool of_waking = woken && !board_.power.texts.empty();
    for (const std::string& line : of_waking ? board_.power.texts : board_.identity.banner) {
        if (line == antenna_text(AntennaStatus::unknown)) told_antenna_ = AntennaStatus::unknown;
        send_text(text_notice, line, now);
    }
    if (woken) return;  // half a second after that a client may speak to it
    for (const PortUnit& unit : units_)
        deaf_until_ = std::max(deaf_until_, is_uart(unit.id) ? unit.transmit.drained_at().value_or(now) : now);
}

}  // namespace skyloop::firmware
