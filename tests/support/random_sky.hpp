/// Satellites anywhere in the sky over a place of a scene.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <numbers>
#include <vector>

#include "base/core/random.hpp"
#include "world/scene/scene_path.hpp"

namespace skyloop::test {

/// Uniform over the sky above `least_elevation_deg`, 20,200 … 25,200 km away; the same seed gives the same sky.
inline std::vector<SceneSatellite> random_sky(int count, const Eigen::Vector3d& place, std::uint64_t seed,
                                              double least_elevation_deg = 5) {
    RandomStream random(seed, "random sky");
    std::vector<SceneSatellite> sky;
    const double lowest = std::sin(least_elevation_deg * std::numbers::pi / 180);
    for (int i = 0; i < count; ++i) {
        const double up = lowest + (1 - lowest) * random.uniform(), level = std::sqrt(1 - up * up);
        const double azimuth = 2 * std::numbers::pi * random.uniform();
        const Eigen::Vector3d u(level * std::sin(azimuth), level * std::cos(azimuth), up);
        SceneSatellite satellite;
        satellite.id = {Constellation::gps, i + 1};
        satellite.position = place + u * (2.02e7 + 5e6 * random.uniform());
        sky.push_back(satellite);
    }
    return sky;
}

}  // namespace skyloop::test
