#include "skyloop/emulator/emulator.hpp"

#include <algorithm>

namespace skyloop {
namespace {

constexpr Nanoseconds no_time{0};

}  // namespace

Emulator::Emulator(Parts parts, GpsTime start)
    : parts_(std::move(parts)), now_(start), traces_(parts_.stations.size()) {
    for (Station& station : parts_.stations)
        station.start(start);
}

GpsTime Emulator::next_instant(GpsTime end) const {
    GpsTime next = end;
    bool busy = false, wired = false;
    for (const Station& station : parts_.stations) {
        next = std::min(next, station.next_epoch());
        busy = busy || station.busy();
        wired = wired || !station.wires().empty();
    }
    const Nanoseconds tick = parts_.pacer->tick(busy);
    if (tick > no_time && wired) next = std::min(next, now_ + tick);
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
        if (now_ < end) run_epochs(*lateness);
        if (recording_failed()) break;
    }
    for (Station& station : parts_.stations)
        station.finish(now_);
}

bool Emulator::recording_failed() const {
    return std::any_of(parts_.stations.begin(), parts_.stations.end(),
                       [](const Station& s) { return s.recorder() && s.recorder()->failure(); });
}

void Emulator::exchange_bytes() {
    const LoopTime time{now_, parts_.pacer->monotonic_ns(now_)};
    for (Station& station : parts_.stations) {
        station.exchange(time);
        // As fast as the machine can, the end of the run is soon enough.
        if (!parts_.pacer->is_virtual()) station.keep_state(now_);
    }
}

// All that is due is solved before any of it is reported: a rover needs what its base has at the same instant.
void Emulator::run_epochs(Nanoseconds lateness) {
    auto& stations = parts_.stations;
    for (std::size_t i = 0; i < stations.size(); ++i) {
        traces_[i].reset();
        if (stations[i].next_epoch() == now_) traces_[i] = stations[i].observe();
    }
    for (std::size_t i = 0; i < stations.size(); ++i) {
        const auto base = stations[i].base();
        if (traces_[i] && base) stations[i].relate(*traces_[i], traces_[*base] ? &*traces_[*base] : nullptr);
    }
    for (std::size_t i = 0; i < stations.size(); ++i) {
        if (!traces_[i]) continue;
        stations[i].report(*traces_[i], lateness, !parts_.pacer->is_virtual());
        if (status_) status_({now_, &*traces_[i], lateness, i});
    }
}

}  // namespace skyloop
