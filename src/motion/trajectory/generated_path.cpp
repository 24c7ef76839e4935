#include "motion/trajectory/generated_path.hpp"

#include <fmt/format.h>

#include <cmath>

#include "base/core/overloaded.hpp"

namespace skyloop {
namespace {

template <class Wish>
Wish with_seed(Wish wish, std::uint64_t seed) {
    wish.seed = seed;
    return wish;
}

}  // namespace

PathPlanResult plan_path(const PathWish& wish, std::uint64_t seed) {
    return std::visit(Overloaded{[](const WaypointWish& w) { return plan_waypoints(w); },
                                 [](const OrbitWish& w) { return plan_orbit(w); },
                                 [](const RacetrackWish& w) { return plan_racetrack(w); },
                                 [](const FigureEightWish& w) { return plan_figure_eight(w); },
                                 [](const LawnmowerWish& w) { return plan_lawnmower(w); },
                                 [&](const HoverWish& w) {
                                     return PathPlanResult(PathPlan{hover_shape(with_seed(w, seed)), {}, {}});
                                 },
                                 [&](const FloatWish& w) {
                                     return PathPlanResult(PathPlan{float_shape(with_seed(w, seed)), {}, {}});
                                 },
                                 [&](const DriveWish& w) { return plan_drive(with_seed(w, seed)); },
                                 [](const RocketWish& w) { return plan_rocket(w); },
                                 [](const BalloonWish& w) { return plan_balloon(w); }},
                      wish);
}

PathPlanResult plan_generated(const GeneratedPath& path, std::uint64_t run_seed) {
    const std::uint64_t seed = path.seed.value_or(run_seed);
    const bool single = path.steps.size() == 1;
    std::vector<SequenceStep> steps;
    std::vector<std::string> notes;
    std::string summary;
    for (std::size_t i = 0; i < path.steps.size(); ++i) {
        // Steps of one kind are to differ: each has dice of its own.
        auto plan = plan_path(path.steps[i].wish, seed + i);
        const std::string which = single ? std::string() : fmt::format("step {}: ", i + 1);
        if (!plan) return tl::unexpected(which + plan.error());
        for (const std::string& note : plan->notes)
            notes.push_back(which + note);
        if (!plan->summary.empty()) summary += (summary.empty() ? "" : "; ") + which + plan->summary;
        steps.push_back({std::move(plan->shape), path.steps[i].seconds, path.steps[i].vehicle.value_or(path.vehicle)});
    }
    const bool whole =
        single && !std::isfinite(path.steps[0].seconds) && steps.front().vehicle.kind == path.vehicle.kind;
    if (whole && !(path.loop && std::isfinite(steps[0].shape->duration())))
        return PathPlan{steps[0].shape, notes, summary};
    auto joined = plan_sequence(steps, path.vehicle, path.loop);
    if (!joined) return joined;
    joined->notes.insert(joined->notes.begin(), notes.begin(), notes.end());
    joined->summary = summary;
    return joined;
}

}  // namespace skyloop
