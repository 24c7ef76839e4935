/// Where all satellites go over hours.
#pragma once

#include <vector>

#include "base/core/units.hpp"
#include "base/geo/frames.hpp"
#include "world/gnss/ephemeris.hpp"

namespace skyloop::inline world {

/// One point of a track.
struct TrackPoint {
    GpsTime time;
    Position<Ecef> position;
};

/// The way of one satellite in the Earth-fixed frame.
struct SatelliteTrack {
    SatelliteId satellite;
    std::vector<TrackPoint> points;
};

/// Which instants a track has: `start`, then every `step` up to and including `start` + `duration`.
struct TrackTimes {
    GpsTime start;
    Seconds duration{46 * 3600};
    Seconds step{300};  ///< above 0
};

/// ECEF tracks of every satellite of `source`, ascending by satellite. Each point comes from the record with the
/// nearest toe within two days of the track, however old: beyond a record's validity a track is an illustration, not an
/// ephemeris, and an SBAS satellite stands where it last was. Satellites without such a record are absent.
std::vector<SatelliteTrack> satellite_tracks(const NavigationSource& source, const TrackTimes& times);

}  // namespace skyloop::inline world
