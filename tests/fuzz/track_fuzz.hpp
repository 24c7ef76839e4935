/// Any bytes as a track: a clear error, or rows that are finite and a path between them.
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>

#include "motion/tracks/read_track.hpp"
#include "motion/trajectory/recorded_path.hpp"
#include "motion/trajectory/route.hpp"
#include "require.hpp"

namespace skyloop {

/// Places without times: a way, or one clear line.
inline int fly_any_route(const Track& track, std::size_t size) {
    const auto route = fly_route(track, {static_cast<VehicleClass>(size % track_vehicle_count), {}, 2, 0});
    if (!route) {
        require(route.error().message.find('\n') == std::string::npos);
        return 0;
    }
    const RoutePath path(*route, to_gps_time(2304, 0.0));
    for (int i = -1; i <= 21; ++i) {
        const double seconds = std::min(path.duration().value(), 1e6) * i / 20;
        const TruthState state = path.at(advanced(to_gps_time(2304, 0.0), Seconds(seconds)));
        require(state.position.vector().allFinite() && state.velocity.vector().allFinite());
    }
    return 0;
}

inline int read_any_track(const std::uint8_t* data, std::size_t size, const std::string& name) {
    auto track = read_track({data, size}, name, {nullptr, Geodetic::degrees(47, 8, 500)});
    if (!track) {
        require(track.error().message.starts_with(name));
        require(track.error().message.find('\n') == std::string::npos);
        return 0;
    }
    for (const TrackRow& row : track->points) {
        require(row.position.vector().allFinite());
        require(!row.velocity || row.velocity->vector().allFinite());
        require(!row.attitude || row.attitude->body_to_ned().coeffs().allFinite());
    }
    for (const std::string& note : track->notes)
        require(note.find('\n') == std::string::npos);
    if (track->route) return fly_any_route(*track, size);
    const auto gaps = clean_track(*track, Seconds(10));
    if (!gaps) return 0;
    const GpsTime start = to_gps_time(2304, 0.0);
    const RecordedPath path(*track, *gaps, start);
    for (int i = -1; i <= 21; ++i) {
        const TruthState state = path.at(advanced(start, Seconds(path.duration().value() * i / 20)));
        require(state.position.vector().allFinite() && state.velocity.vector().allFinite());
    }
    return 0;
}

}  // namespace skyloop
