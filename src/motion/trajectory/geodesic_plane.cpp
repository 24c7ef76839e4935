#include "motion/trajectory/geodesic_plane.hpp"

#include <cmath>
#include <numbers>

#include "base/geo/geodesic.hpp"
#include "base/geo/local_frame.hpp"

namespace skyloop {

Eigen::Vector3d GeodesicPlane::to_local(const Geodetic& place) const {
    const GeodesicLeg leg = geodesic_between(origin_, place);
    const double length = leg.length.value();
    return {length * std::sin(leg.azimuth.rad()), length * std::cos(leg.azimuth.rad()),
            place.height.above_ellipsoid.value()};
}

GeodesicPlane::Placed GeodesicPlane::place(GpsTime time, const LocalMotion& motion) const {
    constexpr double nearest_m = 1;  // below it the plane and the ellipsoid differ by less than 1e-13
    const double east = motion.position.x(), north = motion.position.y();
    const double distance = std::hypot(east, north);
    const double azimuth = distance > 0 ? std::atan2(east, north) : 0;
    const GeodesicPoint point = geodesic_direct(origin_, Angle::radians(azimuth), Metres(distance));
    const double across = distance > nearest_m ? point.reduced_length.value() / distance : 1;
    // The velocity along the geodesic keeps its size; the one across it has that of the lines that draw apart.
    const double s = std::sin(azimuth), c = std::cos(azimuth);
    const double outward = motion.velocity.x() * s + motion.velocity.y() * c;
    const double clockwise = across * (motion.velocity.x() * c - motion.velocity.y() * s);
    const double end_s = std::sin(point.azimuth.rad()), end_c = std::cos(point.azimuth.rad());
    const CurvatureRadii radii = curvature_radii(point.latitude);
    const double height = motion.position.z();
    Placed placed;
    placed.north = Angle::radians(std::remainder(point.azimuth.rad() - azimuth, 2 * std::numbers::pi));
    placed.state.time = time;
    placed.state.geodetic = {point.latitude, point.longitude, {Metres(height)}};
    placed.state.position = to_ecef(placed.state.geodetic);
    // At a height the vehicle covers more metres than its shadow on the ellipsoid.
    const Velocity<Enu> velocity((outward * end_s + clockwise * end_c) * (1 + height / radii.prime_vertical),
                                 (outward * end_c - clockwise * end_s) * (1 + height / radii.meridian),
                                 motion.velocity.z());
    placed.state.velocity = LocalFrame(placed.state.geodetic).to_ecef(velocity);
    return placed;
}

}  // namespace skyloop
