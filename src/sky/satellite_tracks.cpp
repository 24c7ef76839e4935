#include "skyloop/sky/satellite_tracks.hpp"

#include <algorithm>
#include <cassert>

#include "skyloop/gnss/orbit.hpp"

namespace skyloop {
namespace {

// How far from the track records are looked for, and how densely: no broadcast record is renewed more often.
constexpr std::chrono::hours track_record_reach{48};
constexpr std::chrono::minutes track_record_spacing{15};

// The records that `source` gives between two instants, ascending by toe.
std::vector<KeplerEphemeris> records_between(const NavigationSource& source, SatelliteId satellite, TimeSpan window) {
    std::vector<KeplerEphemeris> records;
    for (GpsTime t = window.first; t <= window.last; t += track_record_spacing) {
        std::optional<KeplerEphemeris> record = source.ephemeris(satellite, t);
        if (record && (records.empty() || records.back().toe != record->toe)) records.push_back(std::move(*record));
    }
    return records;
}

TimeSpan record_window(const NavigationSource& source, GpsTime start, GpsTime end) {
    const std::optional<TimeSpan> span = source.span();
    if (!span) return {start, end};
    return {std::max(span->first, start - track_record_reach), std::min(span->last, end + track_record_reach)};
}

SatelliteTrack extrapolated_track(SatelliteId satellite, const std::vector<KeplerEphemeris>& records,
                                  const TrackTimes& times) {
    SatelliteTrack track{satellite, {}};
    const GpsTime end = advanced(times.start, times.duration);
    const Nanoseconds step = to_nanoseconds(times.step);
    std::size_t serving = 0;
    for (GpsTime t = times.start; t <= end; t += step) {
        while (serving + 1 < records.size() &&
               std::chrono::abs(t - records[serving + 1].toe) <= std::chrono::abs(t - records[serving].toe))
            ++serving;
        track.points.push_back({t, satellite_state(records[serving], t).position});
    }
    return track;
}

}  // namespace

std::vector<SatelliteTrack> satellite_tracks(const NavigationSource& source, const TrackTimes& times) {
    assert(to_nanoseconds(times.step) > Nanoseconds(0));
    const TimeSpan window = record_window(source, times.start, advanced(times.start, times.duration));
    std::vector<SatelliteTrack> tracks;
    for (const SatelliteId satellite : source.satellites()) {
        const std::vector<KeplerEphemeris> records = records_between(source, satellite, window);
        if (!records.empty()) tracks.push_back(extrapolated_track(satellite, records, times));
    }
    return tracks;
}

}  // namespace skyloop
