// Turns of planes, boats and cars at a speed.
// Vehicles on a curve over the ground, and their height.
// Places of a route that its vehicle goes past, because it cannot turn there.
// From where a plane, a boat or a car has come to rest to where it begins anew.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "motion/trajectory/local_shape.hpp"
#include "motion/trajectory/planar_curve.hpp"
#include "motion/trajectory/vehicle.hpp"
#include "motion/trajectory/waypoint_plan.hpp"

namespace skyloop::inline motion {

// The turn that needs the lateral acceleration, or the smallest radius where that asks for less.
inline TurnShape turn_at_speed(const VehicleLimits& vehicle, double angle, double speed) {
    constexpr double least_ramp = 0.05;  // of the radius: nothing steers at once
    TurnShape turn;
    turn.angle = angle;
    turn.radius = std::max({speed * speed / vehicle.lateral, vehicle.radius, 1e-3});
    turn.ramp = std::max(speed * vehicle.turn_ramp, least_ramp * turn.radius);
    return turn;
}

inline constexpr double no_turn = 1e-9;  // rad

// How far before its corner a turn would like to begin, m.
inline double wanted_by_turn(const VehicleLimits& vehicle, double angle, double speed) {
    if (std::abs(angle) < no_turn) return 0;
    return std::min(vehicle.corner, tangent_length(turn_at_speed(vehicle, angle, speed)));
}

inline double slowest_turn(const VehicleLimits& vehicle) { return std::max(vehicle.slowest, 0.1); }

// The fastest turn at a corner that begins within `free` metres of it; nothing: none does.
inline std::optional<double> fastest_turn(const VehicleLimits& vehicle, double angle, double speed, double free) {
    const auto fits = [&](double v) { return tangent_length(turn_at_speed(vehicle, angle, v)) <= free; };
    if (fits(speed)) return speed;
    double low = std::min(slowest_turn(vehicle), speed), high = speed;
    if (!fits(low)) return std::nullopt;
    for (int i = 0; i < 40; ++i) {
        const double middle = (low + high) / 2;
        (fits(middle) ? low : high) = middle;
    }
    return low;
}

// Heights along a way: level at each knot, and smooth between them.
class WayHeights {
public:
    explicit WayHeights(double height) : knots_{{0, height}} {}
    // way: not less than that of the knot before
    void add(double way, double height) { knots_.push_back({way, height}); }
    struct Height {
        double value, slope, bend;  // m, m/m, 1/m
    };
    [[nodiscard]] Height at(double way) const;

private:
    struct Knot {
        double way, height;
    };
    std::vector<Knot> knots_;
};

// Along the curve with the speed of a profile: p(s(t)), v = p' ds/dt, a = p'' (ds/dt)² + p' d²s/dt².
class SteeredShape : public LocalShape {
public:
    SteeredShape(std::shared_ptr<const PlanarCurve> curve, SpeedProfile profile, WayHeights heights)
        : curve_(std::move(curve)), profile_(std::move(profile)), heights_(std::move(heights)) {}
    [[nodiscard]] LocalMotion at(double t) const override;
    [[nodiscard]] double duration() const override { return profile_.duration(); }

private:
    std::shared_ptr<const PlanarCurve> curve_;
    SpeedProfile profile_;
    WayHeights heights_;
};

// Places that lie at another height than the one before, straight above or below it.
struct LeftOutAbove {
    std::size_t count = 0;
    double most = 0;  // of height, m
};

// Places above one another become one, at the height of the last; those above the first at the height of that, for
// there the way begins.
LeftOutAbove leave_out_same_ground(std::vector<PlannedWaypoint>& waypoints);

struct PassedPlaces {
    std::size_t count = 0;
    double farthest = 0;  // from the straight way between those beside it, m
};

// Leaves out places until every turn fits, but for the first and the last. Of neighbours that do not fit only the first
// goes at a time: without it the turn at the next one is another. Takes time in proportion to the places, for after the
// first look only those beside a place that is gone are looked at again.
// waypoints: after leave_out_same_ground(), and so afterwards
PassedPlaces pass_by_tight_turns(std::vector<PlannedWaypoint>& waypoints, const VehicleLimits& vehicle);

// Ahead from where it stands, round corners, and ahead into where it is to stand, in both of which it is at rest and
// level. Nothing where no such way of a reasonable length keeps the vehicle's turns, slope, climb and sink.
std::shared_ptr<const LocalShape> steered_joint(const LocalMotion& from, const LocalMotion& to,
                                                const VehicleLimits& vehicle);

}  // namespace skyloop::inline motion
