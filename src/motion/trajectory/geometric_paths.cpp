#include "motion/trajectory/geometric_paths.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/geo/geodetic.hpp"
#include "base/geo/local_frame.hpp"

namespace skyloop::inline motion {
namespace {

// A place and a motion over ground as a state: `motion` is east and north along the ellipsoid, and up. At a height the
// antenna covers more metres than its shadow on the ellipsoid.
TruthState state_at(GpsTime time, const Geodetic& place, const Eigen::Vector3d& motion) {
    const CurvatureRadii radii = curvature_radii(place.latitude);
    const double height = place.height.above_ellipsoid.value();
    const Velocity<Enu> velocity(motion.x() * (1 + height / radii.prime_vertical),
                                 motion.y() * (1 + height / radii.meridian), motion.z());
    TruthState state;
    state.time = time;
    state.geodetic = place;
    state.position = to_ecef(place);
    state.velocity = LocalFrame(place).to_ecef(velocity);
    return state;
}

Geodetic at_height(const GeodesicPoint& point, double height) {
    return {point.latitude, point.longitude, {Metres(height)}};
}

}  // namespace

FixedPoint::FixedPoint(const Geodetic& place) : place_(place), ecef_(to_ecef(place)) {}

TruthState FixedPoint::at(GpsTime time) const { return {time, ecef_, {}, place_}; }

Waypoints::Waypoints(GpsTime start, std::vector<Waypoint> corners) : start_(start), last_(corners.back().place) {
    double clock = 0;
    for (std::size_t i = 0; i + 1 < corners.size(); ++i) {
        const GeodesicLeg leg = geodesic_between(corners[i].place, corners[i + 1].place);
        const double climb =
            (corners[i + 1].place.height.above_ellipsoid - corners[i].place.height.above_ellipsoid).value();
        // A leg straight up or down has no length over ground: its speed is then the climb's.
        const double way = leg.length.value() > 1e-3 ? leg.length.value() : std::abs(climb);
        clock += corners[i].hold.value();
        const double departs = clock;
        clock += way / corners[i].speed.value();
        legs_.push_back({corners[i], corners[i + 1].place, leg.azimuth, leg.length.value(), departs, clock});
    }
}

Seconds Waypoints::duration() const { return Seconds(legs_.empty() ? 0 : legs_.back().arrives); }

TruthState Waypoints::at(GpsTime time) const {
    const double t = difference(time, start_).value();
    const auto leg = std::find_if(legs_.begin(), legs_.end(), [t](const Leg& l) { return t < l.arrives; });
    if (leg == legs_.end()) return state_at(time, last_, Eigen::Vector3d::Zero());
    if (t < leg->departs) return state_at(time, leg->from.place, Eigen::Vector3d::Zero());

    const double span = leg->arrives - leg->departs;
    const double part = (t - leg->departs) / span;
    const double from_height = leg->from.place.height.above_ellipsoid.value();
    const double climb = leg->to.height.above_ellipsoid.value() - from_height;
    const GeodesicPoint point = geodesic_direct(leg->from.place, leg->azimuth, Metres(part * leg->length));
    const double speed = leg->length / span;
    return state_at(time, at_height(point, from_height + part * climb),
                    {speed * std::sin(point.azimuth.rad()), speed * std::cos(point.azimuth.rad()), climb / span});
}

TruthState Circle::at(GpsTime time) const {
    const double t = std::max(0.0, difference(time, start_).value());
    const double turned = shape_.speed.value() * t / shape_.radius.value();
    const Angle azimuth = Angle::radians(std::remainder(shape_.start_azimuth.rad() + turned, 2 * std::numbers::pi));
    const GeodesicPoint point = geodesic_direct(shape_.centre, azimuth, shape_.radius);
    // The tangent is a quarter turn right of the direction away from the centre.
    const double heading = point.azimuth.rad() + std::numbers::pi / 2;
    const double speed = shape_.speed.value();
    return state_at(time, at_height(point, shape_.centre.height.above_ellipsoid.value()),
                    {speed * std::sin(heading), speed * std::cos(heading), 0});
}

}  // namespace skyloop::inline motion
