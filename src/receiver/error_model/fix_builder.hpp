/// The part of a fix that all sensor models make alike: satellites, DOP, geoid and motion.
#pragma once

#include <optional>

#include "receiver/error_model/ground_motion.hpp"
#include "receiver/error_model/selection.hpp"
#include "receiver/error_model/sensor_context.hpp"
#include "world/flow/truth_state.hpp"

namespace skyloop {

/// Builds fixes, in ascending time. Its state is the last position and how good it was, for the motion.
class FixBuilder {
public:
    /// @param rule its mask is replaced by the context's
    FixBuilder(const SensorContext& context, SelectionRule rule);

    /// Time, satellites and DOP. With fewer than four usable satellites, or a geometry that does not determine a
    /// position, the type is `none` and no satellite is used.
    Fix start(const TruthState& truth, const SkyView& sky, const Arrivals& arrivals);
    /// Sets the position, and velocity and course from the position before, with their accuracies: those of the
    /// difference of two positions whose errors are independent (MODELS.md D-11).
    /// @param deviation 1 σ of the position in space, of all three axes together
    void place(Fix& fix, const Position<Ecef>& position, Metres deviation);

private:
    struct Placed {
        GpsTime time;
        Metres deviation;
    };
    void tell_motion_accuracy(Fix& fix, Metres deviation);

    SelectionRule rule_;
    const Geoid* geoid_;
    LeapSeconds leap_seconds_;
    MotionOfFixes motion_;
    std::optional<Placed> last_;  // of `motion_`
};

}  // namespace skyloop
