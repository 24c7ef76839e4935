/// Which facets lie in one plane.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "world/scene/urban_scene.hpp"

namespace skyloop::inline world {

/// Planes, numbered as triangles come upon them, and the plane of each triangle.
struct MergedPlanes {
    std::vector<ScenePlane> planes;
    std::vector<std::uint32_t> plane_of;
};

/// Gathers triangles of one kind and material whose three corners lie within `tolerance` of one plane.
///
/// A plane is that of its largest facet (to a factor of two of the area), on which normals that are vertical within
/// the tolerance are made exactly so. Nothing is chained: every corner is held against the plane itself. Takes time
/// in proportion to the triangles, whose corners must be finite and which must have an area; the order of work is
/// theirs, so the same triangles give the same planes.
///
/// @param tolerance m
MergedPlanes merge_planes(std::span<const Eigen::Vector3d> vertices, std::span<const CityTriangle> triangles,
                          double tolerance);

}  // namespace skyloop::inline world
