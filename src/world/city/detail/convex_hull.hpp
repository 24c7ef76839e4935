/// The hull around places of a plane.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace skyloop {

/// The convex hull, anticlockwise (Andrew 1979); fewer than three corners where the points have no area.
/// Points without a place are left out.
std::vector<Eigen::Vector2d> convex_hull(std::vector<Eigen::Vector2d> points);

/// The area of a convex ring, in the square of its unit.
double hull_area(const std::vector<Eigen::Vector2d>& ring);

}  // namespace skyloop
