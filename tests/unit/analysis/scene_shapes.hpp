/// Scenes of which everything is known, for the tests of what is made of them.
#pragma once

#include <memory>

#include "world/scene/generated_city.hpp"
#include "world/scene/urban_scene.hpp"

namespace skyloop::test {

inline Geodetic scene_origin() { return Geodetic::degrees(46.4775, 30.7326, 50); }

/// A canyon that runs north: its walls stand `half_width` west and east of the origin.
inline std::shared_ptr<const UrbanScene> canyon_scene(double half_width, double height) {
    StreetCanyonSettings settings;
    settings.width = 2 * half_width;
    settings.length = 4000;
    settings.left_height = settings.right_height = height;
    return UrbanScene::build(street_canyon(settings, scene_origin())).value();
}

/// A single wall of `height` that faces west, `distance` east of the origin, 2 km long.
inline std::shared_ptr<const UrbanScene> wall_scene(double distance, double height) {
    CityModel city;
    city.origin = scene_origin();
    city.add_quad({Eigen::Vector3d(distance, -1000, 0), Eigen::Vector3d(distance, 1000, 0),
                   Eigen::Vector3d(distance, 1000, height), Eigen::Vector3d(distance, -1000, height)},
                  SurfaceKind::wall);
    return UrbanScene::build(city).value();
}

}  // namespace skyloop::test
