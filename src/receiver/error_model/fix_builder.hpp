/// The part of a fix that all sensor models make alike: satellites, DOP, geoid and motion.
/// White position noise that draws the same numbers whatever the sky looks like.
/// Which satellites a sensor model uses.
/// Velocity and course from one position to the next.
#pragma once

#include <Eigen/Core>

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "base/core/random.hpp"
#include "receiver/error_model/error_model.hpp"
#include "world/flow/arrivals.hpp"
#include "world/flow/fix.hpp"
#include "world/flow/sky_view.hpp"
#include "world/flow/truth_state.hpp"

namespace skyloop::inline receiver {

/// Three normal numbers an epoch. An epoch without a fix draws them too, so that no later epoch depends on how many
/// satellites were visible before.
class PositionNoise {
public:
    PositionNoise(std::uint64_t seed, std::string_view stream) : random_(seed, stream) {}
    /// Three independent standard normal numbers. Call once an epoch.
    Eigen::Vector3d draw() {
        Eigen::Vector3d numbers;
        for (double& number : numbers)
            number = random_.normal();
        return numbers;
    }

private:
    RandomStream random_;
};

/// A satellite is used when it is healthy and passes all of these; every limit is inclusive (MODELS.md D-18, D-19).
struct SelectionRule {
    Angle elevation_mask = Angle::degrees(5);       ///< at or above
    bool hidden_too = false;                        ///< true: use a satellite even when no ray of it arrives
    std::optional<DbHz> snr_cutoff = std::nullopt;  ///< at or above; a satellite without C/N0 fails
};

/// The satellites of `sky` as the receiver reports them, in its order. An invisible one has no C/N0.
/// @param arrivals one for each satellite of `sky`
std::vector<SatelliteStatus> select_satellites(const SkyView& sky, const Arrivals& arrivals, const SelectionRule& rule);

/// Directions of the used ones.
std::vector<SkyDirection> used_directions(const std::vector<SatelliteStatus>& satellites);

/// A position and when it was.
struct TimedPosition {
    GpsTime time;
    Geodetic position;
};

/// Motion over the ground.
struct GroundMotion {
    VelocityNed velocity;
    MetresPerSecond speed;  ///< horizontal
    Angle course;           ///< 0 … 360°, clockwise from true north; 0 at rest
};

/// Speed and course of a velocity.
GroundMotion ground_motion(const VelocityNed& velocity);

/// Differences of geodetic coordinates over time, with the radii of curvature at the mean latitude and height
/// (MODELS.md 3.10). Beyond 89.9° of latitude, where longitudes lose their meaning, the straight way in the local frame
/// of `after`. No motion when no time passes.
GroundMotion motion_between(const TimedPosition& before, const TimedPosition& after);

/// The motion of a series of fixes, each against the one before. The first fix, and the first after a gap, has nothing
/// to compare with and reports no motion.
class MotionOfFixes {
public:
    GroundMotion next(const TimedPosition& fix);
    /// There is no fix: the next one is a first again.
    void interrupt() { last_.reset(); }

private:
    std::optional<TimedPosition> last_;
};

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
    double geoid_step_deg_;
    LeapSeconds leap_seconds_;
    MotionOfFixes motion_;
    std::optional<Placed> last_;  // of `motion_`
};

}  // namespace skyloop::inline receiver
