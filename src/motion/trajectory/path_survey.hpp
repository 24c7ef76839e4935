/// What a path asks for: how far, how high, how fast, how hard.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "base/core/result.hpp"
#include "motion/trajectory/trajectory.hpp"
#include "motion/trajectory/vehicle.hpp"

namespace skyloop::inline motion {

/// A part of a path.
struct PathSpan {
    GpsTime from{};
    Seconds length{};
};

/// The largest or smallest of something, and when it was.
struct PathExtreme {
    double value = 0;
    double at_s = 0;  ///< after the beginning of the span
};

/// Heights above the ellipsoid, m; speeds against the Earth, m/s.
struct PathSurvey {
    double duration_s = 0;
    Geodetic south_west, north_east;            ///< of the box around it; east of 180° the longitude goes on counting
    double east_west_m = 0, north_south_m = 0;  ///< sides of the box, through its middle; beyond 85° of the plane there
    double length_m = 0;                        ///< of the way, jumps not in it
    PathExtreme lowest, highest;                ///< m
    PathExtreme fastest, fastest_over_ground;   ///< m/s
    PathExtreme climb, descent;                 ///< m/s, both positive
    PathExtreme acceleration, jerk, turn_rate;  ///< m/s², m/s³, rad/s; steps of the velocity are no acceleration
    std::size_t velocity_steps = 0, jumps = 0;  ///< where velocity or place change in no time
    PathExtreme largest_step, largest_jump;     ///< m/s, m
    bool has_orientation = false;               ///< the path tells how the vehicle stands
};

/// Looks at the path 100 times a second, more seldom at spans of more than three hours, and searches the steps that it
/// finds down to a microsecond. Acceleration and jerk are differences of neighbouring velocities. That the vehicle
/// stops where the span ends is no step.
PathSurvey survey_path(const Trajectory& path, const PathSpan& span);

/// A limit that a path exceeds.
struct ExceededLimit {
    std::string of;    ///< "receiver", "plane"
    std::string what;  ///< "acceleration"
    std::string unit;
    double limit = 0;
    PathExtreme found;
};

/// West and east of a survey's box from -180 to 180 degrees; across 180 degrees east is less than west, and a path
/// round a pole has them all.
struct LongitudeSpan {
    double west_deg = 0, east_deg = 0;
};
LongitudeSpan longitude_span(const PathSurvey& survey);

/// Against what receivers keep their fix at (u-blox data sheets, "operational limits": 4 g, 50 000 m, 500 m/s; COCOM,
/// which others follow: 18 288 m and 515 m/s) and against a class of vehicles.
std::vector<ExceededLimit> exceeded_limits(const PathSurvey& survey, std::optional<VehicleClass> vehicle);

/// The path at one instant, in words that people and plots take.
struct PathSample {
    double time_s = 0;  ///< after the beginning of the span
    TruthState state;
    Eigen::Vector3d velocity_ned = Eigen::Vector3d::Zero();      ///< m/s
    Eigen::Vector3d acceleration_ned = Eigen::Vector3d::Zero();  ///< m/s²; over a millisecond, without steps
    bool jumped = false;                                         ///< the path jumps since the sample before
};

/// From the beginning of the span to its end, both among them: the last step may be a shorter one.
/// Fails with `usage` for more than ten million samples.
Result<std::vector<PathSample>> sample_path(const Trajectory& path, const PathSpan& span, Hertz rate);

/// A table that read_track_csv() takes: t_s, place, velocity, acceleration, attitude where it is told, and of a path
/// that jumps the count of its jumps as `reset`.
std::string path_csv(const std::vector<PathSample>& samples);

}  // namespace skyloop::inline motion
