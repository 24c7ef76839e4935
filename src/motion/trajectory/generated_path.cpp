#include "motion/trajectory/generated_path.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "base/core/random.hpp"
#include "base/core/std_additions.hpp"
#include "motion/trajectory/waypoint_plan.hpp"

namespace skyloop::inline motion {
namespace {

constexpr std::array<std::array<int, 2>, 4> street_directions{{{0, 1}, {1, 0}, {0, -1}, {-1, 0}}};

// The crossings of a drive, in the order in which it passes them.
class DriveDice {
public:
    explicit DriveDice(const DriveWish& wish)
        : wish_(wish), stream_(wish.seed, "path.drive"), reach_(static_cast<int>(wish.area / wish.block)) {}
    std::vector<PlannedWaypoint> roll(std::size_t most);

private:
    [[nodiscard]] bool inside(std::size_t direction) const {
        const auto& d = street_directions[direction];
        return std::abs(right_ + d[0]) <= reach_ && std::abs(ahead_ + d[1]) <= reach_;
    }
    std::size_t next_direction();
    PlannedWaypoint crossing();

    const DriveWish& wish_;
    RandomStream stream_;
    int reach_, right_ = 0, ahead_ = 0;
    std::size_t direction_ = 0;
};

// Straight on half of the time; never back. One of the three always stays inside.
std::size_t DriveDice::next_direction() {
    for (;;) {
        const double die = stream_.uniform();
        const std::size_t turned = die < 0.5 ? 0 : die < 0.75 ? 1 : 3;
        const std::size_t direction = (direction_ + turned) % 4;
        if (inside(direction)) return direction;
    }
}

PlannedWaypoint DriveDice::crossing() {
    const double s = std::sin(wish_.heading), c = std::cos(wish_.heading);
    const double ahead = ahead_ * wish_.block, right = right_ * wish_.block;
    PlannedWaypoint waypoint;
    waypoint.place = wish_.centre + Eigen::Vector3d(ahead * s + right * c, ahead * c - right * s, 0);
    const double slowest = std::max(0.6, wish_.vehicle.slowest / wish_.vehicle.along.speed);
    waypoint.speed = wish_.vehicle.along.speed * (slowest + (1 - slowest) * stream_.uniform());
    const bool waits = stream_.uniform() < wish_.stops && wish_.vehicle.slowest == 0;
    if (waits) waypoint.hold = 5 + 35 * stream_.uniform();
    return waypoint;
}

std::vector<PlannedWaypoint> DriveDice::roll(std::size_t most) {
    std::vector<PlannedWaypoint> way{crossing()};
    way.front().hold = 0;
    for (double seconds = 0; seconds < wish_.seconds && way.size() < most;) {
        direction_ = next_direction();
        right_ += street_directions[direction_][0];
        ahead_ += street_directions[direction_][1];
        seconds += wish_.block / way.back().speed;
        way.push_back(crossing());
        seconds += way.back().hold;
    }
    return way;
}

}  // namespace

PathPlanResult plan_drive(const DriveWish& wish) {
    constexpr std::size_t most_crossings = 20000;
    constexpr double most_blocks = 1e6;
    if (!(wish.area >= wish.block) || wish.area > most_blocks * wish.block)
        return tl::unexpected(
            fmt::format("the area reaches {:g} m from its centre, and a block is {:g} m long; expected "
                        "1 to {:.0f} blocks",
                        wish.area, wish.block, most_blocks));
    WaypointWish way;
    way.vehicle = wish.vehicle;
    way.heading = wish.heading;
    way.waypoints = DriveDice(wish).roll(most_crossings + 1);
    if (way.waypoints.size() > most_crossings)
        return tl::unexpected(
            fmt::format("a drive of {:g} s has more than {} crossings; expected a shorter drive or "
                        "longer blocks",
                        wish.seconds, most_crossings));
    auto plan = plan_waypoints(way);
    if (plan) plan->notes.clear();  // it slows down at every corner, as drives do
    return plan;
}

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

}  // namespace skyloop::inline motion
