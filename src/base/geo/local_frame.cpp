#include "base/geo/local_frame.hpp"

#include <cmath>
#include <numbers>

namespace skyloop::inline base {

LocalFrame::LocalFrame(const Geodetic& origin) : origin_(origin), origin_ecef_(skyloop::to_ecef(origin)) {
    const double sin_lat = std::sin(origin.latitude.rad());
    const double cos_lat = std::cos(origin.latitude.rad());
    const double sin_lon = std::sin(origin.longitude.rad());
    const double cos_lon = std::cos(origin.longitude.rad());
    rotation_ << -sin_lon, cos_lon, 0,                    //
        -sin_lat * cos_lon, -sin_lat * sin_lon, cos_lat,  //
        cos_lat * cos_lon, cos_lat * sin_lon, sin_lat;
}

Position<Enu> LocalFrame::to_enu(const Position<Ecef>& point) const {
    return Position<Enu>(rotation_ * (point - origin_ecef_).vector());
}

Displacement<Enu> LocalFrame::to_enu(const Displacement<Ecef>& vector) const {
    return Displacement<Enu>(rotation_ * vector.vector());
}

Velocity<Enu> LocalFrame::to_enu(const Velocity<Ecef>& velocity) const {
    return Velocity<Enu>(rotation_ * velocity.vector());
}

Position<Ecef> LocalFrame::to_ecef(const Position<Enu>& point) const {
    return origin_ecef_ + Displacement<Ecef>(rotation_.transpose() * point.vector());
}

Displacement<Ecef> LocalFrame::to_ecef(const Displacement<Enu>& vector) const {
    return Displacement<Ecef>(rotation_.transpose() * vector.vector());
}

Velocity<Ecef> LocalFrame::to_ecef(const Velocity<Enu>& velocity) const {
    return Velocity<Ecef>(rotation_.transpose() * velocity.vector());
}

LookAngles LocalFrame::look_angles(const Position<Ecef>& target) const {
    const Eigen::Vector3d enu = to_enu(target).vector();
    const double horizontal = std::hypot(enu.x(), enu.y());
    double azimuth = std::atan2(enu.x(), enu.y());
    if (azimuth < 0) azimuth += 2 * std::numbers::pi;
    // A tiny negative angle rounds up to a full turn, which is north again; so is minus zero.
    if (azimuth >= 2 * std::numbers::pi || azimuth == 0) azimuth = 0;
    return {Angle::radians(azimuth), Angle::radians(std::atan2(enu.z(), horizontal)), Metres(enu.norm())};
}

}  // namespace skyloop::inline base
