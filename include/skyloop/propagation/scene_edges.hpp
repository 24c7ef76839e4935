/// Edges of a city near the line to a satellite.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "skyloop/base/units.hpp"
#include "skyloop/scene/urban_scene.hpp"

namespace skyloop {

/// Where a roof or a corner ends, as seen from the antenna.
struct SceneEdge {
    Eigen::Vector3d direction;  ///< unit, from the antenna: the last that is free
    Metres distance;
    Angle detour;  ///< between the satellite and the edge, above 0
};

/// Of a satellite that is blocked: the edges over which and around which a bent ray would come, at most one upwards and
/// one on either side, by up to 45°. Edges from which the satellite is blocked again are left out: rays that bend twice
/// are not followed.
std::vector<SceneEdge> edges_around_obstacle(const UrbanScene& scene, const SceneRay& to_satellite);

/// Of a satellite in sight: what ends within 8° of the line, at most one towards each of four sides. The ground is no
/// edge.
std::vector<SceneEdge> edges_near_sight(const UrbanScene& scene, const SceneRay& to_satellite);

}  // namespace skyloop
