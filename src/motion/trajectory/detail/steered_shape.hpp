// Vehicles on a curve over the ground, and their height.
#pragma once

#include <memory>
#include <vector>

#include "motion/trajectory/local_shape.hpp"
#include "motion/trajectory/planar_curve.hpp"
#include "motion/trajectory/speed_profile.hpp"

namespace skyloop {

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

}  // namespace skyloop
