#include "firmware/messages/rtcm_observations.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <map>
#include <set>

#include "firmware/messages/field_values.hpp"
#include "receiver/protocol/rtcm3.hpp"
#include "receiver/protocol/rtcm3_legacy.hpp"
#include "receiver/protocol/rtcm3_signals.hpp"
#include "world/gnss/constants.hpp"

namespace skyloop::firmware {
namespace {

using namespace std::chrono_literals;

constexpr std::size_t most_cells = 64;
constexpr int most_msm_satellites = 64;

GpsTime msm_time(const RtcmEpoch& epoch) {
    return std::chrono::round<std::chrono::milliseconds>(epoch.observations.receive_time);
}

std::uint32_t of_week_ms(GpsTime time) { return static_cast<std::uint32_t>(week_and_tow(time).tow / 1ms); }

constexpr std::uint32_t day_ms = 86'400'000;
std::uint32_t moscow_ms(const RtcmEpoch& epoch) {
    return of_week_ms(msm_time(epoch) + 3h - std::chrono::seconds(epoch.leap_seconds));
}

std::uint32_t msm_epoch(Constellation constellation, const RtcmEpoch& epoch) {
    if (constellation == Constellation::beidou) return of_week_ms(msm_time(epoch) - bdt_lag);
    if (constellation != Constellation::glonass) return of_week_ms(msm_time(epoch));
    const std::uint32_t moscow = moscow_ms(epoch);
    return moscow / day_ms << 27 | moscow % day_ms;
}

// What the receiver's clock is past a whole millisecond, and how fast that grows.
struct PastMillisecond {
    double m = 0;
    MetresPerSecond drift{0};
};
PastMillisecond past_of(const RtcmEpoch& epoch) {
    return {difference(epoch.observations.receive_time, msm_time(epoch)).value() * speed_of_light, epoch.clock_drift};
}

// Ranges are told for a whole millisecond, and with the clock's error its drift leaves them: the rate has to go with
// the phase that it is of.
Rtcm3MsmCell msm_cell(const Observation& o, const PastMillisecond& past) {
    Rtcm3MsmCell cell;
    cell.satellite = msm_satellite(o.satellite);
    cell.signal = msm_signal(o.satellite.constellation, o.signal);
    cell.wavelength_m = speed_of_light / o.carrier.value();
    cell.range_m = o.pseudorange->value() - past.m;
    if (o.carrier_phase) cell.phase_range_m = *o.carrier_phase * cell.wavelength_m - past.m;
    if (o.doppler) cell.phase_range_rate = -o.doppler->value() * cell.wavelength_m - past.drift.value();
    cell.lock_s = o.carrier_phase ? o.lock_time.value() : 0;
    cell.half_cycle_unknown = !o.half_cycle_resolved;
    cell.cno_dbhz = o.cn0.value();
    if (o.satellite.constellation == Constellation::glonass)
        cell.satellite_info = frequency_id(o.satellite, o.signal, o.carrier);
    return cell;
}

bool is_told(const Observation& o, Constellation constellation) {
    return o.satellite.constellation == constellation && o.pseudorange && msm_signal(constellation, o.signal) != 0 &&
           msm_satellite(o.satellite) >= 1 && msm_satellite(o.satellite) <= most_msm_satellites;
}

std::vector<Rtcm3MsmCell> msm_cells(Constellation constellation, const RtcmEpoch& epoch) {
    const PastMillisecond past = past_of(epoch);
    std::vector<Rtcm3MsmCell> cells;
    for (const Observation& o : epoch.observations.signals)
        if (is_told(o, constellation)) cells.push_back(msm_cell(o, past));
    return cells;
}

// Satellites stay whole; each part has room for all signals of each of its satellites.
std::vector<std::vector<Rtcm3MsmCell>> parted(std::vector<Rtcm3MsmCell> cells) {
    std::set<int> signals, satellites;
    for (const Rtcm3MsmCell& cell : cells)
        signals.insert(cell.signal);
    std::vector<std::vector<Rtcm3MsmCell>> parts;
    std::ranges::stable_sort(cells, {}, &Rtcm3MsmCell::satellite);
    for (Rtcm3MsmCell& cell : cells) {
        const bool is_new = satellites.insert(cell.satellite).second;
        if (parts.empty() || (is_new && satellites.size() * signals.size() > most_cells)) {
            parts.emplace_back();
            satellites = {cell.satellite};
        }
        parts.back().push_back(cell);
    }
    return parts;
}

std::optional<Rtcm3LegacyCarrier> legacy_carrier(const Observation& o, const PastMillisecond& past) {
    if (!o.pseudorange) return std::nullopt;
    Rtcm3LegacyCarrier carrier;
    carrier.wavelength_m = speed_of_light / o.carrier.value();
    carrier.range_m = o.pseudorange->value() - past.m;
    if (o.carrier_phase) carrier.phase_range_m = *o.carrier_phase * carrier.wavelength_m - past.m;
    carrier.lock_s = o.carrier_phase ? o.lock_time.value() : 0;
    carrier.cno_dbhz = o.cn0.value();
    return carrier;
}

}  // namespace

bool has_msm_signals(const RtcmEpoch& epoch, Constellation constellation) {
    return std::ranges::any_of(epoch.observations.signals,
                               [&](const Observation& o) { return is_told(o, constellation); });
}

std::vector<Bytes> msm_frames(const RtcmEpoch& epoch, int number, bool more) {
    const auto constellation = msm_constellation(number);
    if (!constellation) return {};
    const auto parts = parted(msm_cells(*constellation, epoch));
    std::vector<Bytes> frames;
    for (std::size_t i = 0; i < parts.size(); ++i) {
        Rtcm3MsmObservations message;
        message.number = number;
        message.station = epoch.station;
        message.epoch = msm_epoch(*constellation, epoch);
        message.more = more || i + 1 < parts.size();
        message.cells = parts[i];
        if (Bytes frame = encode(message); !frame.empty()) frames.push_back(std::move(frame));
    }
    return frames;
}

Bytes legacy_frame(const RtcmEpoch& epoch, int number, bool more) {
    if (!is_legacy_observables(number)) return {};
    const bool glonass = number >= 1009;
    const Constellation constellation = glonass ? Constellation::glonass : Constellation::gps;
    const Signal first = glonass ? Signal::g1 : Signal::l1, second = glonass ? Signal::g2 : Signal::l2;
    const PastMillisecond past = past_of(epoch);
    std::map<int, Rtcm3LegacySatellite> satellites;
    for (const Observation& o : epoch.observations.signals) {
        if (o.satellite.constellation != constellation || (o.signal != first && o.signal != second)) continue;
        const auto carrier = legacy_carrier(o, past);
        Rtcm3LegacySatellite& satellite = satellites[o.satellite.number];
        satellite.satellite = o.satellite.number;
        if (glonass) satellite.frequency_channel = frequency_id(o.satellite, o.signal, o.carrier) - 7;
        if (o.signal == first && carrier) satellite.l1 = *carrier;
        if (o.signal == second) satellite.l2 = carrier;
    }
    Rtcm3LegacyObservables message;
    message.number = number;
    message.station = epoch.station;
    message.epoch = glonass ? moscow_ms(epoch) % day_ms : of_week_ms(msm_time(epoch));
    message.more = more;
    for (const auto& [id, satellite] : satellites)
        message.satellites.push_back(satellite);
    return encode(message);
}

}  // namespace skyloop::firmware
