/// Houses from their outlines.
/// The hull around places of a plane.
#pragma once

#include <Eigen/Core>

#include <vector>

#include "base/core/result.hpp"
#include "world/scene/city_model.hpp"

namespace skyloop::inline world {

/// The convex hull, anticlockwise (Andrew 1979); fewer than three corners where the points have no area.
/// Points without a place are left out.
std::vector<Eigen::Vector2d> convex_hull(std::vector<Eigen::Vector2d> points);

/// The area of a convex ring, in the square of its unit.
double hull_area(const std::vector<Eigen::Vector2d>& ring);

/// The normal of a ring in space, its length twice the area (Newell; Sutherland 1974); not of an empty one.
Eigen::Vector3d area_vector(const std::vector<Eigen::Vector3d>& ring);

/// An outline with courtyards; rings in any sense, closed or not; east, north, m.
struct Footprint {
    std::vector<Eigen::Vector2d> outer;
    std::vector<std::vector<Eigen::Vector2d>> holes;
};

/// The triangles of a polygon with holes, as indices of its points: outer first, then hole after hole. Points that
/// repeat and edges that cross are tolerated: the result covers what can be covered. Empty for a polygon without area.
std::vector<std::array<std::uint32_t, 3>> triangulated(const Footprint& footprint);

/// Adds walls from `base` to `top` and a roof; an outer ring that crosses itself (a bow-tie) covers all its loops.
/// @returns false, and adds nothing, for an outline without area
bool add_extruded(CityModel& city, const Footprint& footprint, double base, double top, std::uint8_t material = 0);

/// Adds a plane polygon in space with holes, by triangles; kind by the caller. @returns false when it has no area
bool add_polygon(CityModel& city, const std::vector<std::vector<Eigen::Vector3d>>& rings, SurfaceKind kind,
                 std::uint8_t material = 0);

}  // namespace skyloop::inline world
