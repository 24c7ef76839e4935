#include "motion/trajectory/random_drive.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "base/core/random.hpp"
#include "motion/trajectory/waypoint_plan.hpp"

namespace skyloop {
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

}  // namespace skyloop
