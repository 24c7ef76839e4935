/// Recorded paths as rows, whatever format they came in, and their cleaning.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "skyloop/base/result.hpp"
#include "skyloop/base/units.hpp"
#include "skyloop/geo/attitude.hpp"
#include "skyloop/geo/frames.hpp"
#include "skyloop/time/gps_time.hpp"

namespace skyloop {

/// One row of a recorded path. Every reader of a format gives these and nothing else.
struct TrackRow {
    Nanoseconds time{0};  ///< since Track::origin
    Position<Ecef> position;
    std::optional<Velocity<Ecef>> velocity;
    std::optional<Attitude> attitude;
    std::size_t line = 0;  ///< of the file, where it has lines
    bool jump = false;     ///< the source says that it begins anew here: no way leads from the row before to this one
};

/// A recorded path as it was read.
struct Track {
    std::string name;               ///< of the file, for messages
    std::string format;             ///< "CSV", "GPX 1.1", "ULog, vehicle_local_position"
    std::optional<GpsTime> origin;  ///< GPS time of TrackRow::time 0; nothing: the file counts from its own start
    std::vector<TrackRow> points;
    std::vector<std::string> notes;  ///< what its user should be told, a sentence each, without the name of the file
};

/// A stretch without rows, longer than what is told.
struct TrackGap {
    Nanoseconds from{0}, to{0};  ///< since Track::origin
};

/// Puts the rows in order of time (FEEDS.md 1.14): of equal times the last row counts, rows that go back in time are
/// left out. Adds to the notes what was left out, and each stretch longer than `gap`, of which there are at most a few
/// lines. Fails with `input` when fewer than two rows are left.
Result<std::vector<TrackGap>> clean_track(Track& track, Seconds gap);

}  // namespace skyloop
