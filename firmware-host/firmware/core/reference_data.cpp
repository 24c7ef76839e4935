#include "firmware/core/reference_data.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

#include "receiver/protocol/rtcm3_signals.hpp"
#include "world/gnss/constants.hpp"

namespace skyloop::firmware {
namespace {

using namespace std::chrono_literals;

// The time that is `offset` past some whole number of periods, nearest to another.
GpsTime closest(GpsTime near, Nanoseconds offset, Nanoseconds period) {
    const Nanoseconds past = (near.time_since_epoch() - offset) % period;
    const GpsTime earlier = near - (past < 0ns ? past + period : past);
    return near - earlier > period / 2 ? earlier + period : earlier;
}

Observation observation_of(const Rtcm3MsmCell& cell, Constellation constellation, Signal signal) {
    constexpr int channel_offset = 7;  // DF419
    const bool glonass = constellation == Constellation::glonass;
    Observation o;
    o.satellite = {constellation, cell.satellite};
    o.signal = signal;
    o.carrier = carrier_frequency(signal, glonass ? cell.satellite_info - channel_offset : 0);
    o.cn0 = DbHz(cell.cno_dbhz);
    o.pseudorange = Metres(cell.range_m);
    if (cell.phase_range_m) o.carrier_phase = *cell.phase_range_m * o.carrier.value() / speed_of_light;
    o.half_cycle_resolved = !cell.half_cycle_unknown;
    o.lock_time = Seconds(cell.lock_s);
    return o;
}

bool before(const Observation& a, const Observation& b) {
    return std::pair(a.satellite, a.signal) < std::pair(b.satellite, b.signal);
}

}  // namespace

std::optional<GpsTime> told_time(const Rtcm3MsmObservations& message, GpsTime near, int leap_seconds) {
    constexpr Nanoseconds week = 168h, day = 24h;
    const auto constellation = msm_constellation(message.number);
    if (!constellation) return std::nullopt;
    if (*constellation == Constellation::glonass) {
        // DF034: of the Moscow day, which a leap second makes longer by one.
        const Nanoseconds of_day = std::chrono::milliseconds(message.epoch & ((1u << 27) - 1));
        if (of_day > day + 1s) return std::nullopt;
        return closest(near, of_day - 3h + std::chrono::seconds(leap_seconds), day);
    }
    const Nanoseconds of_week = std::chrono::milliseconds(message.epoch);
    if (of_week >= week) return std::nullopt;
    return closest(near, of_week + (*constellation == Constellation::beidou ? Nanoseconds(bdt_lag) : 0ns), week);
}

void ReferenceData::take_position(const Rtcm3Station& told) {
    constexpr double metres = 1e-4;
    const auto at = [&](std::size_t axis) { return metres * static_cast<double>(told.position[axis]); };
    station_.position = Position<Ecef>(at(0), at(1), at(2));
    if (!station_.epoch.signals.empty()) hand_on();
}

bool ReferenceData::take_observations(const Rtcm3MsmObservations& message, GpsTime now, int leap_seconds) {
    const auto constellation = msm_constellation(message.number);
    const auto time = told_time(message, now, leap_seconds);
    if (!constellation || !time) return false;
    if (coming_.time != *time) {
        if (coming_.time > station_.epoch.time) hand_on();
        coming_ = {*time, {}};
    }
    for (const Rtcm3MsmCell& cell : message.cells)
        if (const auto signal = msm_carrier(*constellation, cell.signal))
            coming_.signals.push_back(observation_of(cell, *constellation, *signal));
    // Of several codes of one carrier the first.
    std::stable_sort(coming_.signals.begin(), coming_.signals.end(), before);
    const auto same = [](const Observation& a, const Observation& b) { return !before(a, b) && !before(b, a); };
    coming_.signals.erase(std::unique(coming_.signals.begin(), coming_.signals.end(), same), coming_.signals.end());
    if (!message.more) hand_on();
    return true;
}

void ReferenceData::hand_on() {
    if (!coming_.signals.empty()) station_.epoch = coming_;
    if (station_.position && !station_.epoch.signals.empty())
        handed_on_ = std::make_shared<const ReferenceStation>(station_);
}

}  // namespace skyloop::firmware
