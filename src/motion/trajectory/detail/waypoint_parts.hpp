// The two ways of going through waypoints, and what they share.
#pragma once

#include <numbers>
#include <string>
#include <vector>

#include "motion/trajectory/waypoint_plan.hpp"

namespace skyloop::inline motion {

// Notes of which there may be many: a few are told, the others counted.
class PlanNotes {
public:
    void add(std::string note) {
        if (notes_.size() < most_told) notes_.push_back(std::move(note));
        ++count_;
    }
    [[nodiscard]] std::vector<std::string> take() const;

private:
    static constexpr std::size_t most_told = 3;
    std::vector<std::string> notes_;
    std::size_t count_ = 0;
};

// Speeds that are allowed at the ends of sections, lowered so that each can be reached from its neighbours.
// sections: of the way between two stations; stations: one more than sections
struct SpeedSection {
    double length = 0;
    SpeedLimits limits;
};
void make_speeds_reachable(const std::vector<SpeedSection>& sections, std::vector<double>& stations);

inline constexpr double shortest_leg_m = 1e-3;
inline constexpr double turns_on_the_spot = std::numbers::pi / 2;  // at most, rad/s

// A leg as the turn at one of its ends finds it, m.
struct LegOfTurn {
    double length, wanted_by_other;  // by the turn at its other end
};
// How far a turn that would like `wanted` of both its legs may reach into them, m: where the turns at both ends of a
// leg would like more than there is, each has its part.
double room_for_turn(double wanted, const LegOfTurn& before, const LegOfTurn& after);

// Of a place from the straight way between two others, m.
double distance_from_leg(const Eigen::Vector3d& place, const Eigen::Vector3d& from, const Eigen::Vector3d& to);

// How notes call a waypoint, "item 5" of a plan or "waypoint 6", and the way from it to the next: "from waypoint 6 to
// 7".
std::string waypoint_called(const std::vector<PlannedWaypoint>& waypoints, std::size_t i);
std::string leg_called(const std::vector<PlannedWaypoint>& waypoints, std::size_t i);

PathPlanResult plan_fly_through(const WaypointWish& wish);
PathPlanResult plan_steered(const WaypointWish& wish);

}  // namespace skyloop::inline motion
