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
    o.satellite = satellite_of_msm(constellation, cell.satellite);
    o.signal = signal;
    o.carrier = carrier_frequency(signal, glonass ? cell.satellite_info - channel_offset : 0);
    o.cn0 = DbHz(cell.cno_dbhz);
    o.pseudorange = Metres(cell.range_m);
    if (cell.phase_range_m) o.carrier_phase = *cell.phase_range_m * o.carrier.value() / speed_of_light;
    o.half_cycle_resolved = !cell.half_cycle_unknown;
    o.lock_time = Seconds(cell.lock_s);
    return o;
}

Observation observation_of(const Rtcm3LegacyCarrier& carrier, SatelliteId satellite, Signal signal, int channel) {
    Observation o;
    o.satellite = satellite;
    o.signal = signal;
    o.carrier = carrier_frequency(signal, channel);
    o.cn0 = DbHz(carrier.cno_dbhz);
    if (carrier.range_m) o.pseudorange = Metres(*carrier.range_m);
    if (carrier.phase_range_m) o.carrier_phase = *carrier.phase_range_m * o.carrier.value() / speed_of_light;
    o.lock_time = Seconds(carrier.lock_s);
    return o;
}

// Of an observation message.
std::optional<Constellation> constellation_of(int number) {
    if (!is_legacy_observables(number)) return msm_constellation(number);
    constexpr int first_glonass = 1009;
    return number >= first_glonass ? Constellation::glonass : Constellation::gps;
}

bool before(const Observation& a, const Observation& b) {
    return std::pair(a.satellite, a.signal) < std::pair(b.satellite, b.signal);
}

}  // namespace

std::optional<GpsTime> told_time(int number, std::uint32_t epoch, GpsTime near, int leap_seconds) {
    constexpr Nanoseconds week = 168h, day = 24h;
    const auto constellation = constellation_of(number);
    if (!constellation) return std::nullopt;
    if (*constellation == Constellation::glonass) {
        // DF034: of the Moscow day, which a leap second makes longer by one. MSM have the day of the week above it.
        constexpr std::uint32_t day_part = (1u << 27) - 1;
        const Nanoseconds of_day = std::chrono::milliseconds(epoch & day_part);
        if (of_day > day + 1s) return std::nullopt;
        return closest(near, of_day - 3h + std::chrono::seconds(leap_seconds), day);
    }
    const Nanoseconds of_week = std::chrono::milliseconds(epoch);
    if (of_week >= week) return std::nullopt;
    return closest(near, of_week + (*constellation == Constellation::beidou ? Nanoseconds(bdt_lag) : 0ns), week);
}

void ReferenceData::take_position(const Position<Ecef>& antenna) {
    stands_ = true;
    station_.position = antenna;
    station_.moves = false;
    if (!station_.epoch.signals.empty()) hand_on();
}

void ReferenceData::take_moving(const Position<Ecef>& antenna) {
    if (stands_) return;
    station_.position = antenna;
    station_.moves = true;
}

void ReferenceData::take_observations(const Rtcm3MsmObservations& message, GpsTime now, int leap_seconds) {
    const auto constellation = msm_constellation(message.number);
    if (!constellation) return;
    std::vector<Observation> signals;
    for (const Rtcm3MsmCell& cell : message.cells)
        if (const auto signal = msm_carrier(*constellation, cell.signal))
            signals.push_back(observation_of(cell, *constellation, *signal));
    take(told_time(message.number, message.epoch, now, leap_seconds), std::move(signals), message.more);
}

void ReferenceData::take_observations(const Rtcm3LegacyObservables& message, GpsTime now, int leap_seconds) {
    if (!is_extended_legacy(message.number)) return;
    constexpr int first_sbas = 40, sbas_offset = 20;
    const Constellation system = *constellation_of(message.number);
    const bool glonass = system == Constellation::glonass;
    std::vector<Observation> signals;
    for (const Rtcm3LegacySatellite& s : message.satellites) {
        const bool sbas = !glonass && s.satellite >= first_sbas;
        const SatelliteId id =
            sbas ? SatelliteId{Constellation::sbas, s.satellite - sbas_offset} : SatelliteId{system, s.satellite};
        if (id.number == 0) continue;  // of GLONASS an unknown slot
        signals.push_back(observation_of(s.l1, id, glonass ? Signal::g1 : Signal::l1, s.frequency_channel));
        if (s.l2) signals.push_back(observation_of(*s.l2, id, glonass ? Signal::g2 : Signal::l2, s.frequency_channel));
    }
    take(told_time(message.number, message.epoch, now, leap_seconds), std::move(signals), message.more);
}

void ReferenceData::take(std::optional<GpsTime> time, std::vector<Observation> signals, bool more) {
    if (!time) return;
    if (coming_.time != *time) {
        if (coming_.time > station_.epoch.time) hand_on();
        coming_ = {*time, {}};
    }
    for (Observation& o : signals)
        if (o.pseudorange) coming_.signals.push_back(std::move(o));
    // Of several codes of one carrier the first.
    std::stable_sort(coming_.signals.begin(), coming_.signals.end(), before);
    const auto same = [](const Observation& a, const Observation& b) { return !before(a, b) && !before(b, a); };
    coming_.signals.erase(std::unique(coming_.signals.begin(), coming_.signals.end(), same), coming_.signals.end());
    if (!more) hand_on();
}

void ReferenceData::hand_on() {
    if (!coming_.signals.empty()) station_.epoch = coming_;
    if (station_.position && !station_.epoch.signals.empty())
        handed_on_ = std::make_shared<const ReferenceStation>(station_);
}

}  // namespace skyloop::firmware
