#include "world/scene/urban_scene.hpp"

#include <algorithm>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "world/scene/city_model.hpp"

namespace skyloop::inline world {
namespace {

constexpr double wood_on_slope = 60;  // m, of one prism

std::optional<double> lowest_ground(std::span<const Eigen::Vector3d> vertices, const UrbanScene& terrain) {
    std::optional<double> lowest;
    Eigen::Vector2d asked = Eigen::Vector2d::Constant(1e300);
    for (const Eigen::Vector3d& vertex : vertices) {
        if (vertex.head<2>() == asked) continue;  // the other end of the same edge
        asked = vertex.head<2>();
        const auto ground = terrain.ground_at(asked.x(), asked.y());
        if (ground) lowest = std::min(lowest.value_or(*ground), *ground);
    }
    return lowest;
}

std::optional<double> mean_ground(std::span<const Eigen::Vector2d> ring, const UrbanScene& terrain) {
    double sum = 0;
    int known = 0;
    for (const Eigen::Vector2d& corner : ring)
        if (const auto ground = terrain.ground_at(corner.x(), corner.y())) {
            sum += *ground;
            ++known;
        }
    if (known == 0) return std::nullopt;
    return sum / known;
}

// @returns whether any of it stands beyond the terrain
bool plant(const FoliageVolume& wood, const UrbanScene& terrain, std::vector<FoliageVolume>& planted) {
    bool beyond = false;
    for (std::vector<Eigen::Vector2d>& ring : ring_pieces(wood.ring, wood_on_slope)) {
        const auto ground = mean_ground(ring, terrain);
        beyond = beyond || !ground;
        const double level = ground.value_or(*wood.ground), shift = level - *wood.ground;
        planted.push_back({std::move(ring), wood.base + shift, wood.top + shift, level});
    }
    return beyond;
}

}  // namespace

std::size_t stand_on_terrain(CityModel& city, const UrbanScene& terrain) {
    std::size_t beyond = 0;
    for (GroundedBuilding& building : city.grounded) {
        const std::span vertices = std::span(city.vertices).subspan(building.first, building.count);
        const auto ground = lowest_ground(vertices, terrain);
        if (!ground) {
            ++beyond;
            continue;
        }
        for (Eigen::Vector3d& vertex : vertices)
            vertex.z() += *ground - building.ground;
        building.ground = *ground;
    }
    std::vector<FoliageVolume> planted;
    for (FoliageVolume& wood : city.foliage) {
        if (!wood.ground)
            planted.push_back(std::move(wood));
        else if (plant(wood, terrain, planted))
            ++beyond;
    }
    city.foliage = std::move(planted);
    return beyond;
}

}  // namespace skyloop::inline world
