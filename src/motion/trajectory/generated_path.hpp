/// Generated paths as settings: what was asked for, and how it becomes a shape.
#pragma once

#include <cstdint>
#include <optional>
#include <variant>
#include <vector>

#include "base/geo/geodetic.hpp"
#include "motion/trajectory/closed_paths.hpp"
#include "motion/trajectory/flight_profiles.hpp"
#include "motion/trajectory/path_sequence.hpp"
#include "motion/trajectory/random_drive.hpp"
#include "motion/trajectory/swaying_paths.hpp"
#include "motion/trajectory/waypoint_plan.hpp"

namespace skyloop {

using PathWish = std::variant<WaypointWish, OrbitWish, RacetrackWish, FigureEightWish, LawnmowerWish, HoverWish,
                              FloatWish, DriveWish, RocketWish, BalloonWish>;
/// @param seed for those that roll dice and have none of their own
PathPlanResult plan_path(const PathWish& wish, std::uint64_t seed);

/// A path that is generated: one wish, or several one after the other.
struct GeneratedPath {
    struct Step {
        PathWish wish{};
        double seconds = LocalShape::endless;    ///< after which the next one takes over
        std::optional<VehicleLimits> vehicle{};  ///< which goes it; nothing: that of the path
    };
    Geodetic origin{};                    ///< of the plane on which the wishes lie
    std::vector<Step> steps{};            ///< at least one
    VehicleLimits vehicle{};              ///< the limits of what joins the steps; its attitude, where a step has no own
    bool loop = false;                    ///< begins anew when it has ended
    Seconds start_delay{0};               ///< stands at its beginning for so long
    std::optional<std::uint64_t> seed{};  ///< of its dice; nothing: the run's
};
PathPlanResult plan_generated(const GeneratedPath& path, std::uint64_t run_seed);

}  // namespace skyloop
