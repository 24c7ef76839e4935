#include "receiver/error_model/fix_builder.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

#include "base/geo/local_frame.hpp"

namespace skyloop::inline receiver {
namespace {

bool visible(const Arrival& arrival) { return arrival.paths > 0 && !arrival.cut_off; }

bool usable(const SatelliteInView& satellite, const Arrival& arrival, const SelectionRule& rule) {
    if (!satellite.healthy || arrival.called_unhealthy || arrival.cut_off || satellite.elevation < rule.elevation_mask)
        return false;
    if (!rule.hidden_too && !visible(arrival)) return false;
    return !rule.snr_cutoff || (arrival.cn0 && *arrival.cn0 >= *rule.snr_cutoff);
}

}  // namespace

std::vector<SatelliteStatus> select_satellites(const SkyView& sky, const Arrivals& arrivals,
                                               const SelectionRule& rule) {
    assert(arrivals.satellites.size() == sky.satellites.size());
    std::vector<SatelliteStatus> statuses;
    statuses.reserve(sky.satellites.size());
    for (std::size_t i = 0; i < sky.satellites.size(); ++i) {
        const SatelliteInView& satellite = sky.satellites[i];
        const Arrival& arrival = arrivals.satellites[i];
        SatelliteStatus status;
        status.id = satellite.id;
        status.azimuth = satellite.azimuth;
        status.elevation = satellite.elevation;
        status.healthy = satellite.healthy && !arrival.called_unhealthy;
        if (visible(arrival)) status.cn0 = arrival.cn0;
        status.used = usable(satellite, arrival, rule);
        statuses.push_back(status);
    }
    return statuses;
}

std::vector<SkyDirection> used_directions(const std::vector<SatelliteStatus>& satellites) {
    std::vector<SkyDirection> directions;
    for (const SatelliteStatus& satellite : satellites)
        if (satellite.used) directions.push_back({satellite.azimuth, satellite.elevation});
    return directions;
}

namespace {

// Within 11 km of a pole a step is no longer short against the circle of latitude.
bool is_near_pole(const Geodetic& place) { return std::abs(place.latitude.deg()) > 89.9; }

}  // namespace

GroundMotion ground_motion(const VelocityNed& velocity) {
    double course = std::atan2(velocity.east, velocity.north);
    if (course < 0) course += 2 * std::numbers::pi;
    // A tiny negative angle rounds up to a full turn, which is north again.
    if (course >= 2 * std::numbers::pi) course = 0;
    return {velocity, MetresPerSecond(std::hypot(velocity.north, velocity.east)), Angle::radians(course)};
}

GroundMotion motion_between(const TimedPosition& before, const TimedPosition& after) {
    const double dt = difference(after.time, before.time).value();
    if (dt <= 0) return {};
    const Geodetic& a = before.position;
    const Geodetic& b = after.position;
    const double h_a = a.height.above_ellipsoid.value();
    const double h_b = b.height.above_ellipsoid.value();
    const Angle latitude = (a.latitude + b.latitude) * 0.5;
    const double height = (h_a + h_b) / 2;
    const CurvatureRadii radii = curvature_radii(latitude);
    // The short way round across the antimeridian.
    const double d_longitude = std::remainder((b.longitude - a.longitude).rad(), 2 * std::numbers::pi);
    VelocityNed velocity;
    velocity.north = (radii.meridian + height) * (b.latitude - a.latitude).rad() / dt;
    velocity.east = (radii.prime_vertical + height) * std::cos(latitude.rad()) * d_longitude / dt;
    velocity.down = -(h_b - h_a) / dt;
    if (is_near_pole(a) || is_near_pole(b)) {
        const Displacement<Enu> way = LocalFrame(b).to_enu(to_ecef(b) - to_ecef(a));
        velocity.north = way.vector().y() / dt;
        velocity.east = way.vector().x() / dt;
    }
    return ground_motion(velocity);
}

GroundMotion MotionOfFixes::next(const TimedPosition& fix) {
    const GroundMotion motion = last_ ? motion_between(*last_, fix) : GroundMotion{};
    last_ = fix;
    return motion;
}

namespace {

// What a u-blox receiver tells while it has no velocity (sAcc of NAV-PVT).
constexpr MetresPerSecond unknown_velocity{20};

}  // namespace

FixBuilder::FixBuilder(const SensorContext& context, SelectionRule rule)
    : rule_(rule), geoid_(context.geoid), geoid_step_deg_(context.geoid_step_deg), leap_seconds_(context.leap_seconds) {
    rule_.elevation_mask = context.selection.elevation_mask;
}

Fix FixBuilder::start(const TruthState& truth, const SkyView& sky, const Arrivals& arrivals) {
    Fix fix;
    fix.time = truth.time;
    fix.leap_seconds = leap_seconds_.offset(truth.time);
    fix.satellites = select_satellites(sky, arrivals, rule_);
    if (const auto dop = dilution_of_precision(used_directions(fix.satellites))) {
        fix.type = FixType::fix_3d;
        fix.dop = *dop;
        return fix;
    }
    for (SatelliteStatus& satellite : fix.satellites)
        satellite.used = false;
    motion_.interrupt();
    last_.reset();
    return fix;
}

void FixBuilder::place(Fix& fix, const Position<Ecef>& position, Metres deviation) {
    fix.position = to_geodetic(position);
    if (geoid_ != nullptr)
        fix.geoid_undulation = geoid_->undulation(fix.position.latitude, fix.position.longitude, geoid_step_deg_);
    const GroundMotion motion = motion_.next({fix.time, fix.position});
    fix.velocity = motion.velocity;
    fix.speed = motion.speed;
    fix.course = motion.course;
    tell_motion_accuracy(fix, deviation);
}

void FixBuilder::tell_motion_accuracy(Fix& fix, Metres deviation) {
    const double passed = last_ ? difference(fix.time, last_->time).value() : 0;
    fix.speed_accuracy = unknown_velocity;
    if (passed > 0)
        fix.speed_accuracy = MetresPerSecond(std::hypot(deviation.value(), last_->deviation.value()) / passed);
    const double turn = fix.speed.value() > 0 ? fix.speed_accuracy.value() / fix.speed.value() : std::numbers::pi;
    fix.course_accuracy = Angle::radians(std::min(turn, std::numbers::pi));
    last_ = Placed{fix.time, deviation};
}

}  // namespace skyloop::inline receiver
