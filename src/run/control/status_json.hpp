/// Snapshots as JSON, for pages and programs.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

#include "run/emulator/status_snapshot.hpp"
#include "world/scene/urban_scene.hpp"

namespace skyloop::inline run {

/// From where on the lines of a snapshot are new to somebody.
struct SeenLines {
    std::uint64_t dialogue = 0, events = 0;  ///< the last sequence numbers that are known
};

/// Kinds of solution by corrections, as `corrections.solution` of a receiver has them, in the order of CorrectionState.
inline constexpr std::array<std::string_view, 4> correction_words{"none", "differential", "float", "fixed"};

/// The snapshot as one JSON object without line end. Angles are in degrees, lengths in metres, times of GPS as
/// "time_utc", as "gps_week" (not reduced modulo 1024) with "gps_tow_s", and as seconds since the start; what is not
/// known is null. A receiver has "corrections" once such have come in.
std::string status_json(const StatusSnapshot& snapshot, const SeenLines& seen = {});

/// The last lines of a snapshot.
SeenLines last_lines(const StatusSnapshot& snapshot);

/// As status_json(), with the last 64 lines of dialogue alone.
std::string recent_status_json(const StatusSnapshot& snapshot);

/// {"now_s", "span_s", "entries": [{"name", "kind", "begins_s", "ends_s", "active", …}]}
std::string timeline_json(const StatusSnapshot& snapshot);

/// The roofs of a scene seen from above: origin and [[east, north] × 3, top] triangles of roofs, metres, at most
/// `most` of them (the largest), and trees as boxes.
std::string scene_json(const UrbanScene& scene, std::size_t most = 20000);

}  // namespace skyloop::inline run
