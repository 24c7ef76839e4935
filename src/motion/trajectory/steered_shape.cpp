#include "detail/steered_shape.hpp"

#include <algorithm>
#include <cmath>

#include "detail/smooth_step.hpp"

namespace skyloop {

WayHeights::Height WayHeights::at(double way) const {
    const auto after =
        std::upper_bound(knots_.begin(), knots_.end(), way, [](double value, const Knot& k) { return value < k.way; });
    if (after == knots_.begin()) return {knots_.front().height, 0, 0};
    if (after == knots_.end()) return {knots_.back().height, 0, 0};
    const Knot& from = *std::prev(after);
    const double length = after->way - from.way, rise = after->height - from.height;
    const SmoothStep step = smooth_step((way - from.way) / length);
    return {from.height + rise * step.value, rise * step.slope / length, rise * step.bend / (length * length)};
}

LocalMotion SteeredShape::at(double t) const {
    const AlongWay along = profile_.at(t);
    const CurvePoint point = curve_->at(along.way);
    const WayHeights::Height height = heights_.at(along.way);
    const double s = std::sin(point.heading), c = std::cos(point.heading);
    const double inward = along.speed * along.speed * point.curvature;
    LocalMotion m;
    m.position << point.position, height.value;
    m.velocity = along.speed * Eigen::Vector3d(s, c, height.slope);
    m.acceleration = {along.acceleration * s + inward * c, along.acceleration * c - inward * s,
                      along.acceleration * height.slope + along.speed * along.speed * height.bend};
    m.heading = point.heading;
    return m;
}

}  // namespace skyloop
