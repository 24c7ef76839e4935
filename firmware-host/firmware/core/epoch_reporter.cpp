#include "firmware/core/epoch_reporter.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "firmware/sentences/own_lines.hpp"

namespace skyloop::firmware {
namespace {

constexpr double late_epochs = 0.005, late_by_s = 0.020;

std::string_view antenna_text(AntennaStatus status) {
    constexpr std::array<std::string_view, 5> texts{"ANTSTATUS=INIT", "ANTSTATUS=DONTKNOW", "ANTSTATUS=OK",
                                                    "ANTSTATUS=SHORT", "ANTSTATUS=OPEN"};
    return texts[static_cast<std::size_t>(status)];
}

}  // namespace

GpsTime EpochReporter::burst_time(GpsTime epoch) {
    const double deviation = parts_.board.timing.latency_deviation.value();
    // Bounded at three deviations, with a rare epoch that comes much later (u-blox M8, captured); one epoch's output
    // never overtakes another's.
    double jitter = 0;
    if (deviation > 0) {
        jitter = deviation * std::clamp(latency_noise_.normal(), -3.0, 3.0);
        if (latency_noise_.uniform() < late_epochs) jitter += late_by_s;
    }
    const double delay = std::max(0.0, parts_.faults.solution_delay.value());
    const double latency = std::max(0.0, parts_.board.solution_latency.value() + jitter) + delay;
    last_burst_ = std::max(last_burst_, advanced(epoch, Seconds(latency)));
    return last_burst_;
}

GpsTime EpochReporter::plan(const std::shared_ptr<const NavigationState>& state, GpsTime epoch) {
    const GpsTime burst = advanced(burst_time(epoch), state->report_delay);
    for (int i = 0; i < state->reports; ++i)
        parts_.outbox.plan(burst, [this, state](GpsTime t) { send(*state, t); });
    return burst;
}

void EpochReporter::send(const NavigationState& state, GpsTime now) {
    parts_.maker->follow(state, now);
    for (PortUnit& unit : parts_.units) {
        parts_.outbox.give_up_turns(unit, now);
        unit.status.transmit_full = std::exchange(unit.overflowed, false);
    }
    parts_.look_at_ports();
    EpochMessages made(parts_.context(PortId::uart1, state));
    for (PortUnit& unit : parts_.units) {
        DueMessages due = parts_.maker->due(unit.id, made, parts_.faults);
        add_own_lines(due, made, unit.id);
        report_overflow(unit, now);
        parts_.send_in_turn(unit.id, due.frames, now);
    }
    report_antenna(state.monitors.antenna, now);
}

// Before the epoch's messages, which fill the line again.
void EpochReporter::report_overflow(PortUnit& unit, GpsTime now) {
    if (unit.status.transmit_full && parts_.board.quirks.overflow_notice)
        parts_.send(unit.id, make_text_message(text_error, "txbuf alloc", parts_.context(unit.id, *parts_.reported)),
                    now);
}

void EpochReporter::report_antenna(AntennaStatus status, GpsTime now) {
    if (reported_antenna_ && *reported_antenna_ != status)
        parts_.send_text(text_notice, std::string(antenna_text(status)), now);
    reported_antenna_ = status;
}

// What the banner says of the antenna has been reported: the state that follows is a change from it.
void EpochReporter::send_banner(GpsTime now, bool woken) {
    const BoardProfile& board = parts_.board;
    const bool of_waking = woken && !board.power.texts.empty();
    for (const std::string& line : of_waking ? board.power.texts : board.identity.banner) {
        if (line == antenna_text(AntennaStatus::unknown)) reported_antenna_ = AntennaStatus::unknown;
        parts_.send_text(text_notice, line, now);
    }
    for (const PortUnit& unit : parts_.units)
        parts_.send(unit.id, parts_.maker->greeting(unit.id), now);
}

}  // namespace skyloop::firmware
