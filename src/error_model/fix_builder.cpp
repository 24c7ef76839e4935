#include "skyloop/error_model/fix_builder.hpp"

namespace skyloop {

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
    return fix;
}

void FixBuilder::place(Fix& fix, const Position<Ecef>& position) {
    fix.position = to_geodetic(position);
    if (geoid_ != nullptr) fix.geoid_undulation = geoid_->undulation(fix.position.latitude, fix.position.longitude);
    const GroundMotion motion = motion_.next({fix.time, fix.position});
    fix.velocity = motion.velocity;
    fix.speed = motion.speed;
    fix.course = motion.course;
}

}  // namespace skyloop
