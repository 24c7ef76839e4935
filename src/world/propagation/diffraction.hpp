/// Waves that bend around edges.
/// Edges of a city near the line to a satellite.
#pragma once

#include <Eigen/Core>

#include <vector>

#include "base/core/units.hpp"
#include "world/scene/urban_scene.hpp"

namespace skyloop::inline world {

/// Below this a wave passes clear of the edge.
constexpr double knife_edge_clear = -0.78;

/// Fresnel parameter of an edge against a source that is very far: θ √(2d ∕ λ) (MODELS.md 7.10).
/// @param detour angle between the source and the edge; below 0 when the source is in sight
/// @param distance of the edge
double knife_edge_parameter(Angle detour, Metres distance, Hertz carrier);

/// How far away an edge is of which a wave passes just clear at an angle: λ ∕ 2 (0.78 ∕ θ)². One that is farther away
/// does not weaken it.
/// @param beside angle between the source, which is in sight, and the edge
Metres knife_edge_reach(Angle beside, Hertz carrier);

/// J(v) = 6.9 + 20 lg(√((v − 0.1)² + 1) + v − 0.1), 0 below −0.78 (ITU-R P.526; MODELS.md 7.10).
Decibels knife_edge_loss(double v);

/// Where a ray bends round the end of a roof or a corner: of the straight edge there, the point over which the way to
/// the satellite is shortest, so that it leaves the edge at the angle at which it meets it, or the end of the edge
/// before it.
struct SceneEdge {
    Eigen::Vector3d direction;  ///< unit, from the antenna
    Metres distance;
    Angle detour;  ///< between the satellite and the edge, above 0
};

/// Of a satellite that is blocked: the edges over which and around which a bent ray would come, at most one upwards and
/// one on either side, by up to 45°. Edges from which the satellite is blocked again are left out: rays that bend twice
/// are not followed.
std::vector<SceneEdge> edges_around_obstacle(const UrbanScene& scene, const SceneRay& to_satellite);

/// Of a satellite in sight: what ends within 8° of the line, or farther off it, up to 45°, and so near the antenna that
/// a wave of this carrier does not pass clear of it; at most one towards each of four sides. The ground is no edge.
std::vector<SceneEdge> edges_near_sight(const UrbanScene& scene, const SceneRay& to_satellite, Hertz carrier);

}  // namespace skyloop::inline world
