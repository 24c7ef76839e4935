#include "skyloop/emulator/emulator.hpp"

#include <algorithm>

namespace skyloop {
namespace {

using namespace std::chrono_literals;

// Receivers solve on a grid of GPS time: where the period divides the week, the time of week is a multiple of it.
GpsTime first_epoch(GpsTime start, Nanoseconds period) {
    const Nanoseconds past = start.time_since_epoch() % period;
    return past > 0ns ? start - past + period : start - past;
}

}  // namespace

Emulator::Emulator(Parts parts, GpsTime start)
    : parts_(std::move(parts)),
      now_(start),
      next_epoch_(first_epoch(start, parts_.receiver.settings().navigation_period)) {}

GpsTime Emulator::next_instant(GpsTime end) const {
    GpsTime next = std::min(end, next_epoch_);
    const Nanoseconds tick = parts_.pacer->tick(parts_.receiver.drained_at().has_value());
    if (tick > 0ns && !parts_.links.empty()) next = std::min(next, now_ + tick);
    return next;
}

void Emulator::run_until(GpsTime end, const std::atomic<bool>& stop) {
    while (now_ < end && !stop) {
        const GpsTime next = next_instant(end);
        const auto lateness = parts_.pacer->wait_until(next);
        if (stop) break;
        if (!lateness) continue;
        now_ = next;
        exchange_bytes();
        if (now_ == next_epoch_ && now_ < end) run_epoch(*lateness);
        if (parts_.recorder && parts_.recorder->failure()) break;
    }
    if (parts_.recorder) parts_.recorder->flush();
}

void Emulator::exchange_bytes() {
    firmware::Receiver& receiver = parts_.receiver;
    for (Link& link : parts_.links) {
        const Bytes heard = link.receive(receiver.baud());
        if (heard.empty()) continue;
        receiver.input(heard, now_);
        if (parts_.recorder) parts_.recorder->record_input(heard);
    }
    const Bytes sent = receiver.output(now_);
    const bool at_rest = !receiver.drained_at().has_value();
    for (Link& link : parts_.links)
        link.send(sent, receiver.baud(), at_rest);
    if (parts_.recorder) parts_.recorder->record_output(sent, now_, parts_.pacer->monotonic_ns(now_));
}

void Emulator::run_epoch(Nanoseconds lateness) {
    const Trace trace = parts_.simulation.run(now_, parts_.receiver.settings());
    parts_.receiver.on_epoch(trace.epoch);
    if (parts_.recorder) {
        parts_.recorder->record(trace, parts_.simulation.navigation());
        // In real time an epoch's worth is little to write and much to lose.
        if (!parts_.pacer->is_virtual()) parts_.recorder->flush();
    }

    ++counts_.epochs;
    if (trace.epoch.fix.has_position()) ++counts_.epochs_with_fix;
    counts_.lateness.add(lateness);
    if (status_) status_({now_, &trace, lateness});
    next_epoch_ += parts_.receiver.settings().navigation_period;
}

}  // namespace skyloop
