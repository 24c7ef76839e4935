/// Recorded paths of every format that is read.
#pragma once

#include <optional>
#include <string>

#include "base/core/bytes.hpp"
#include "base/core/result.hpp"
#include "base/geo/geodetic.hpp"
#include "base/geo/geoid.hpp"
#include "motion/trajectory/track.hpp"

namespace skyloop::inline motion {

/// How a track is read.
struct TrackReading {
    const Geoid* geoid = nullptr;      ///< for heights above the sea; null: a file with such heights fails
    std::optional<Geodetic> origin{};  ///< of local metres, and of heights above the ground; nothing: these fail
};

/// Reads a track; its format is told by its content, and by the ending of its name where the content says nothing.
/// Places without times, and with times that cannot be used, are a route: Track::route.
/// Fails with `input` and one line that begins with the name: what was found and what was expected.
Result<Track> read_track(ByteSpan bytes, const std::string& name, const TrackReading& reading);

/// Whether the content is a format of tracks, other than a table with the names of its columns.
bool is_track(ByteSpan bytes, const std::string& name);

}  // namespace skyloop::inline motion
