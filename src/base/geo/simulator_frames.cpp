#include "base/geo/simulator_frames.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "base/geo/local_frame.hpp"

namespace skyloop::inline base {

LevelFrame::LevelFrame(const LevelPlacement& placement) : placement_(placement), local_(placement.origin) {
    const double s = std::sin(placement.yaw.rad());
    const double c = std::cos(placement.yaw.rad());
    const double y = placement.left_handed ? 1 : -1;  // Y points to the right of X, or to its left
    level_to_enu_ << s, y * c, 0,                     //
        c, -y * s, 0,                                 //
        0, 0, 1;
    level_to_enu_ *= placement.unit.value();
}

Position<Ecef> LevelFrame::to_ecef(const Position<Level>& point) const {
    return local_.to_ecef(Position<Enu>(level_to_enu_ * point.vector()));
}

Velocity<Ecef> LevelFrame::to_ecef(const Velocity<Level>& velocity) const {
    return local_.to_ecef(Velocity<Enu>(level_to_enu_ * velocity.vector()));
}

bool LevelFrame::beyond_reach(const Position<Level>& point) const {
    return point.vector().head<2>().norm() * placement_.unit.value() > placement_.reach.value();
}

namespace {

constexpr std::array<std::string_view, 4> local_map_names{"tangent", "ardupilot_flat", "px4_azimuthal",
                                                          "airsim_sphere"};

constexpr double ardupilot_degree_m = 111318.845;  // FEEDS.md 0.1
constexpr double px4_radius_m = 6371000;           // CONSTANTS_RADIUS_OF_EARTH
constexpr double airsim_radius_m = 6378137;        // EARTH_RADIUS

Angle wrapped_longitude(double radians) { return Angle::radians(std::remainder(radians, 2 * std::numbers::pi)); }

Geodetic on_flat_map(const Geodetic& origin, const Eigen::Vector3d& ned) {
    const double half_turn = 90;
    const double latitude = origin.latitude.deg() + ned.x() / ardupilot_degree_m;
    const double half_way = Angle::degrees((origin.latitude.deg() + latitude) / 2).rad();
    const double longitude =
        origin.longitude.deg() + ned.y() / (ardupilot_degree_m * std::max(std::cos(half_way), 0.01));
    return {Angle::degrees(std::clamp(latitude, -half_turn, half_turn)),
            wrapped_longitude(Angle::degrees(longitude).rad()), origin.height};
}

// Azimuthal equidistant projection, inverse: Snyder, Map Projections - A Working Manual, equations 20-14 and 20-15.
Geodetic on_sphere(double radius, const Geodetic& origin, const Eigen::Vector3d& ned) {
    const double north = ned.x() / radius, east = ned.y() / radius;
    const double arc = std::hypot(north, east);
    if (arc == 0) return origin;
    const double sin_arc = std::sin(arc), cos_arc = std::cos(arc);
    const double sin_lat = std::sin(origin.latitude.rad()), cos_lat = std::cos(origin.latitude.rad());
    const double latitude = std::asin(std::clamp(cos_arc * sin_lat + north * sin_arc * cos_lat / arc, -1.0, 1.0));
    const double turn = std::atan2(east * sin_arc, arc * cos_lat * cos_arc - north * sin_lat * sin_arc);
    return {Angle::radians(latitude), wrapped_longitude(origin.longitude.rad() + turn), origin.height};
}

}  // namespace

std::optional<LocalMap> local_map_of_name(std::string_view name) {
    const auto found = std::find(local_map_names.begin(), local_map_names.end(), name);
    if (found == local_map_names.end()) return std::nullopt;
    return static_cast<LocalMap>(found - local_map_names.begin());
}

Geodetic place_on_map(LocalMap map, const Geodetic& origin, const Eigen::Vector3d& ned) {
    if (map == LocalMap::tangent)
        return to_geodetic(LocalFrame(origin).to_ecef(Position<Enu>(ned.y(), ned.x(), -ned.z())));
    Geodetic place = map == LocalMap::ardupilot_flat  ? on_flat_map(origin, ned)
                     : map == LocalMap::px4_azimuthal ? on_sphere(px4_radius_m, origin, ned)
                                                      : on_sphere(airsim_radius_m, origin, ned);
    place.height.above_ellipsoid -= Metres(ned.z());
    return place;
}

Eigen::Matrix3d axes_on_map(LocalMap map, const Geodetic& origin, const Geodetic& place) {
    return ned_to_ecef(map == LocalMap::tangent ? origin : place).toRotationMatrix();
}

}  // namespace skyloop::inline base
