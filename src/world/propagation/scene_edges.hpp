/// Edges of a city near the line to a satellite.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "base/core/units.hpp"
#include "world/scene/urban_scene.hpp"

namespace skyloop {

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

}  // namespace skyloop
