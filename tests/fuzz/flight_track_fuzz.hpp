/// Any bytes as the log of a flight: a clear error, or a path that is finite everywhere.
#pragma once

#include <cstdint>

#include "require.hpp"
#include "skyloop/tracks/read_track.hpp"
#include "skyloop/trajectory/recorded_path.hpp"

namespace skyloop {

inline void read_any_flight(ByteSpan bytes) {
    auto track = read_track(bytes, "fuzz.log", {});
    if (!track) {
        require(track.error().message.starts_with("fuzz.log:"));
        require(track.error().message.find('\n') == std::string::npos);
        return;
    }
    for (const TrackRow& row : track->points) {
        require(row.position.vector().allFinite());
        require(!row.velocity || row.velocity->vector().allFinite());
        require(!row.attitude || row.attitude->body_to_ned().coeffs().allFinite());
    }
    const auto gaps = clean_track(*track, Seconds(10));
    if (!gaps) return;
    const GpsTime start = to_gps_time(2304, 0.0);
    const RecordedPath path(*track, *gaps, start);
    for (int i = -1; i <= 21; ++i) {
        const TruthState state = path.at(advanced(start, Seconds(path.duration().value() * i / 20)));
        require(state.position.vector().allFinite() && state.velocity.vector().allFinite());
    }
}

}  // namespace skyloop
