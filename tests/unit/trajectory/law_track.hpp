// Tracks whose rows follow a law, so that the curve between them can be compared with it.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "base/geo/local_frame.hpp"
#include "motion/trajectory/track.hpp"

namespace skyloop {

/// East, north, up of a time in s, m.
using PathLaw = std::function<Eigen::Vector3d(double)>;

inline const GpsTime recorded_start = to_gps_time(2304, 216000.0);
inline const LocalFrame recorded_frame(Geodetic::degrees(47, 8, 500));

inline Eigen::Vector3d slope_of(const PathLaw& law, double t) { return (law(t + 1e-4) - law(t - 1e-4)) / 2e-4; }

inline Track track_of(const PathLaw& law, const std::vector<double>& times, bool with_velocity) {
    Track track;
    track.name = "law";
    for (const double t : times) {
        TrackRow row;
        row.time = to_nanoseconds(Seconds(t));
        row.position = recorded_frame.to_ecef(Position<Enu>(law(t)));
        if (with_velocity) row.velocity = recorded_frame.to_ecef(Velocity<Enu>(slope_of(law, t)));
        track.points.push_back(row);
    }
    return track;
}

inline std::vector<double> evenly(double from, double to, double step) {
    std::vector<double> times;
    for (double t = from; t <= to + 1e-9; t += step)
        times.push_back(t);
    return times;
}

/// A level circle that climbs, clockwise seen from above, begun eastwards.
inline PathLaw circle_of(double radius, double speed, double climb = 0.5) {
    return [=](double t) {
        return Eigen::Vector3d(radius * std::sin(speed * t / radius), radius * std::cos(speed * t / radius), climb * t);
    };
}

}  // namespace skyloop
