#include "world/sky/satellite_tracks.hpp"

#include <algorithm>
#include <cassert>

#include "world/gnss/navigation_data.hpp"
#include "world/gnss/orbit.hpp"

namespace skyloop::inline world {
namespace {

// How far from the track records are looked for, and how densely: no broadcast record is renewed more often.
constexpr std::chrono::hours track_record_reach{48};
constexpr std::chrono::minutes track_record_spacing{15};

// The records that `source` gives between two instants, ascending by toe.
std::vector<Ephemeris> records_between(const NavigationSource& source, SatelliteId satellite, TimeSpan window) {
    std::vector<Ephemeris> records;
    for (GpsTime t = window.first; t <= window.last; t += track_record_spacing) {
        std::optional<Ephemeris> record = source.ephemeris(satellite, t);
        if (record && (records.empty() || toe_of(records.back()) != toe_of(*record)))
            records.push_back(std::move(*record));
    }
    return records;
}

TimeSpan record_window(const NavigationSource& source, GpsTime start, GpsTime end) {
    const std::optional<TimeSpan> span = source.span();
    if (!span) return {start, end};
    return {std::max(span->first, start - track_record_reach), std::min(span->last, end + track_record_reach)};
}

// A geostationary satellite stays where its record still served: the acceleration that is sent for minutes would carry
// it off within hours.
GpsTime time_on_orbit(const Ephemeris& record, GpsTime time) {
    if (message_of(record) != NavigationMessage::sbas) return time;
    const Nanoseconds validity = to_nanoseconds(usual_validity(record));
    return std::clamp(time, toe_of(record) - validity, toe_of(record) + validity);
}

SatelliteTrack extrapolated_track(SatelliteId satellite, const std::vector<Ephemeris>& records,
                                  const TrackTimes& times) {
    SatelliteTrack track{satellite, {}};
    const GpsTime end = advanced(times.start, times.duration);
    const Nanoseconds step = to_nanoseconds(times.step);
    std::size_t serving = 0;
    for (GpsTime t = times.start; t <= end; t += step) {
        while (serving + 1 < records.size() &&
               std::chrono::abs(t - toe_of(records[serving + 1])) <= std::chrono::abs(t - toe_of(records[serving])))
            ++serving;
        track.points.push_back({t, satellite_state(records[serving], time_on_orbit(records[serving], t)).position});
    }
    return track;
}

}  // namespace

std::vector<SatelliteTrack> satellite_tracks(const NavigationSource& source, const TrackTimes& times) {
    assert(to_nanoseconds(times.step) > Nanoseconds(0));
    const TimeSpan window = record_window(source, times.start, advanced(times.start, times.duration));
    std::vector<SatelliteTrack> tracks;
    for (const SatelliteId satellite : source.satellites()) {
        const std::vector<Ephemeris> records = records_between(source, satellite, window);
        if (!records.empty()) tracks.push_back(extrapolated_track(satellite, records, times));
    }
    return tracks;
}

}  // namespace skyloop::inline world
