/// The part of a fix that all sensor models make alike: satellites, DOP, geoid and motion.
#pragma once

#include "skyloop/error_model/ground_motion.hpp"
#include "skyloop/error_model/selection.hpp"
#include "skyloop/error_model/sensor_context.hpp"
#include "skyloop/flow/truth_state.hpp"

namespace skyloop {

/// Builds fixes, in ascending time. Its state is the last position, for the motion.
class FixBuilder {
public:
    /// @param rule its mask is replaced by the context's
    FixBuilder(const SensorContext& context, SelectionRule rule);

    /// Time, satellites and DOP. With fewer than four usable satellites, or a geometry that does not determine a
    /// position, the type is `none` and no satellite is used.
    Fix start(const TruthState& truth, const SkyView& sky, const Arrivals& arrivals);
    /// Sets the position, and velocity and course from the position before.
    void place(Fix& fix, const Position<Ecef>& position);

private:
    SelectionRule rule_;
    const Geoid* geoid_;
    LeapSeconds leap_seconds_;
    MotionOfFixes motion_;
};

}  // namespace skyloop
