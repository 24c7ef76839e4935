#include "receiver/error_model/fix_builder.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace skyloop {
namespace {

// What a u-blox receiver tells while it has no velocity (sAcc of NAV-PVT).
constexpr MetresPerSecond unknown_velocity{20};

}  // namespace

FixBuilder::FixBuilder(const SensorContext& context, SelectionRule rule)
    : rule_(rule), geoid_(context.geoid), leap_seconds_(context.leap_seconds) {
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
    if (geoid_ != nullptr) fix.geoid_undulation = geoid_->undulation(fix.position.latitude, fix.position.longitude);
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

}  // namespace skyloop
