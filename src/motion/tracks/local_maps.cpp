#include "detail/local_maps.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace skyloop {

double ardupilot_metres_per_degree_east(double latitude_deg, double north_m) {
    const double middle_deg = latitude_deg + north_m / ardupilot_metres_per_degree / 2;
    return ardupilot_metres_per_degree * std::cos(middle_deg * std::numbers::pi / 180);
}

GlobalSample on_ardupilot_map(const GlobalSample& origin, const Eigen::Vector3d& ned_m) {
    return {origin.ns, origin.latitude_deg + ned_m.x() / ardupilot_metres_per_degree,
            origin.longitude_deg + ned_m.y() / ardupilot_metres_per_degree_east(origin.latitude_deg, ned_m.x()),
            origin.height_m - ned_m.z()};
}

GlobalSample on_px4_map(const GlobalSample& origin, const Eigen::Vector3d& ned_m) {
    constexpr double radius_m = 6'371'000, degree = std::numbers::pi / 180;
    const double phi = origin.latitude_deg * degree, north = ned_m.x() / radius_m, east = ned_m.y() / radius_m;
    const double c = std::hypot(north, east);
    GlobalSample there{origin.ns, origin.latitude_deg, origin.longitude_deg, origin.height_m - ned_m.z()};
    if (c == 0) return there;
    const double sine = std::cos(c) * std::sin(phi) + north * std::sin(c) * std::cos(phi) / c;
    there.latitude_deg = std::asin(std::clamp(sine, -1.0, 1.0)) / degree;
    there.longitude_deg +=
        std::atan2(east * std::sin(c), c * std::cos(phi) * std::cos(c) - north * std::sin(phi) * std::sin(c)) / degree;
    return there;
}

}  // namespace skyloop
