// The ways of autopilots from local metres to degrees (FEEDS.md 0.1). None of them is exact on WGS 84; they give the
// degrees that the autopilot itself gave.
#pragma once

#include <Eigen/Core>
#include <cstdint>

namespace skyloop {

// A place in degrees and metres above the sea.
struct GlobalSample {
    std::int64_t ns = 0;
    double latitude_deg = 0, longitude_deg = 0, height_m = 0;
};

// A degree of latitude of ArduPilot's flat Earth, m (libraries/AP_Common/Location).
inline constexpr double ardupilot_metres_per_degree = 111318.845;
// Of longitude, north_m from a latitude, at the middle between both.
double ardupilot_metres_per_degree_east(double latitude_deg, double north_m);
// ardupilot_flat. Not finite for metres that leave the Earth.
GlobalSample on_ardupilot_map(const GlobalSample& origin, const Eigen::Vector3d& ned_m);
// px4_azimuthal: a sphere's azimuthal equidistant map (PX4-Autopilot, lib/geo).
GlobalSample on_px4_map(const GlobalSample& origin, const Eigen::Vector3d& ned_m);

}  // namespace skyloop
