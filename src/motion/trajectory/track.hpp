/// Recorded paths as rows, whatever format they came in, and their cleaning.
/// Rows of which their recorder did not know the place, and speeds in another unit (FEEDS.md 1.5).
/// Noise of recorded positions, and its removal.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/core/result.hpp"
#include "base/core/units.hpp"
#include "base/geo/attitude.hpp"
#include "base/geo/frames.hpp"
#include "base/time/gps_time.hpp"
#include "motion/trajectory/vehicle.hpp"

namespace skyloop::inline motion {

/// One row of a recorded path. Every reader of a format gives these and nothing else.
struct TrackRow {
    Nanoseconds time{0};  ///< since Track::origin
    Position<Ecef> position;
    std::optional<Velocity<Ecef>> velocity;
    std::optional<Attitude> attitude;
    std::size_t line = 0;  ///< of the file, where it has lines
    bool jump = false;     ///< the source says that it begins anew here: no way leads from the row before to this one
};

/// What a plan asks for at one of its places.
struct RouteStop {
    std::optional<double> speed{};  ///< from here on, m/s; nothing: as before
    double hold = 0;                ///< stands here for so long, s; with a radius what cannot stand circles for it
    double turns = 0;               ///< circles round the place before it goes on
    double radius = 0;              ///< of these, m; negative: anticlockwise; 0: it does not circle
    std::size_t item = 0;           ///< of the plan, as notes call it; 0: the file has none
};

/// How places without times are flown: one after the other, with the limits of a vehicle.
struct RouteOrder {
    std::string why;                        ///< there are no times: "no times in it"
    std::vector<RouteStop> stops{};         ///< of a plan, whose places are all meant: as many as rows; else none
    std::optional<VehicleClass> vehicle{};  ///< that the file names
    std::optional<double> speed{};          ///< that the file names, m/s
};

/// A recorded path as it was read.
struct Track {
    std::string name;               ///< of the file, for messages
    std::string format;             ///< "CSV", "GPX 1.1", "ULog, vehicle_local_position"
    std::optional<GpsTime> origin;  ///< GPS time of TrackRow::time 0; nothing: the file counts from its own start
    std::vector<TrackRow> points;
    std::vector<std::string> notes;  ///< what its user should be told, a sentence each, without the name of the file
    /// The rows are places in their order, and their times mean nothing; see fly_route(). Nothing: a track with times.
    std::optional<RouteOrder> route{};
};

/// Makes a route of a track whose times cannot be used: of a single row, of rows that all share one time, and of rows
/// more than nine tenths of which share one time at different places. It is told.
void find_useless_times(Track& track);

/// A stretch without rows, longer than what is told.
struct TrackGap {
    Nanoseconds from{0}, to{0};  ///< since Track::origin
};

/// What becomes of a gap.
enum class GapPolicy {
    bridge,    ///< a way is led across it
    hold,      ///< the path stands there, and jumps to the next row when its time comes
    compress,  ///< its time is left out
    outage     ///< a way is led across it, and who runs the path is to lose the signals there
};

/// Puts the rows in order of time and in order at all (FEEDS.md 1.14). Left out: rows without a place, rows that go
/// back in time by 2 s or less, single rows whose time ran ahead or fell back or that lie far from both neighbours, and
/// of equal times all but the last row. Where three rows or more share a time at different places, the rows are spread
/// over the step of the stamps. Rows with dates (an origin) are of one clock and keep their times: rows that came late,
/// by their places, and parts that go back further are put in its order, and a few rows of before the date was known
/// are left out. Without an origin times that go back further are a new beginning: each part follows the one before at
/// once, by a jump. A path that leaps and stays there jumps. Rows whose times only fall are turned round. Stretches
/// longer than `gap` become what `policy` says. All of it is told in the notes, with counts. Fails with `input`, and
/// the notes, when fewer than two rows are left.
/// @returns the gaps that are to be bridged
Result<std::vector<TrackGap>> clean_track(Track& track, Seconds gap, GapPolicy policy = GapPolicy::bridge);

/// Takes out the rows at latitude 0, longitude 0, where recorders put places that they do not know, unless all are
/// there. A jump of such a row is that of the next one. Says what was done, of so many rows of the file; empty:
/// nothing.
std::string leave_out_zero_places(Track& track, std::size_t rows);

/// Upwards, m/s, from the heights of the rows beside that are at most 30 s away: the slope of the parabola through
/// three of them, or of a line.
double climb_by_heights(std::span<const TrackRow> rows, std::size_t row);

/// The middle ratio of the speeds that rows tell to those of their places, where the vehicle moves; nothing where too
/// few tell one.
std::optional<double> speed_ratio(std::span<const TrackRow> rows);

/// Takes the velocities from rows whose speeds are in another unit than metres per second, by that ratio. Says so;
/// empty: they are not.
std::string leave_out_foreign_speeds(Track& track);

/// Whether the rows of a track are smoothed before the curve is led through them.
enum class Smoothing {
    none,    ///< the curve goes through the rows
    noise,   ///< by the noise that the rows show, where it is more than the vehicle's motion could be
    sensor,  ///< as positions of a satellite receiver: 1.5 m in plan, 3 m up
};

/// Standard deviations, m.
struct PositionNoise {
    double in_plan = 0, up = 0;
};

/// The noise of the rows, by the median of their fourth differences, less what a vehicle's white jerk makes of them: of
/// steps h, 2/3 q h⁵ (the integral of the third difference's quadratic B-spline), where white noise σ makes 70 σ². Zero
/// where the motion alone explains them. Rows that are not evenly spaced are left out.
PositionNoise noise_of(const Track& track, VehicleClass vehicle);

/// What smoothing did.
struct SmoothingReport {
    std::optional<PositionNoise> taken{};  ///< nothing: the rows were kept
    std::size_t outliers = 0;              ///< rows further than 5 σ from where the motion led, which did not count
    double largest_shift = 0;              ///< of a row that counts, m
};

/// Moves the rows onto the path that a Rauch–Tung–Striebel smoother gives (FEEDS.md 1.13.2, step 3): white jerk of the
/// vehicle's density on each axis, positions with this noise, velocities, where they are told, with 0.3 m/s. All rows
/// get a velocity. Works from jump to jump.
SmoothingReport smooth_track(Track& track, VehicleClass vehicle, Smoothing smoothing);

}  // namespace skyloop::inline motion
