#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "detail/json_text.hpp"
#include "run/control/status_json.hpp"

namespace skyloop {
namespace {

// Decimetres are enough for a picture, and keep the text short.
double decimetres(double metres) { return std::round(metres * 10) / 10; }

double area_from_above(const std::array<Eigen::Vector3d, 3>& corners) {
    const Eigen::Vector3d a = corners[1] - corners[0], b = corners[2] - corners[0];
    return std::abs(a.x() * b.y() - a.y() * b.x()) / 2;
}

// The largest roofs first.
std::vector<std::uint32_t> roofs_of(const UrbanScene& scene, std::size_t most) {
    std::vector<std::pair<double, std::uint32_t>> roofs;
    for (std::uint32_t i = 0; i < scene.statistics().triangles; ++i) {
        if (scene.planes()[scene.plane_of(i)].kind != SurfaceKind::roof) continue;
        const double area = area_from_above(scene.triangle(i));
        if (area > 0.01) roofs.emplace_back(-area, i);
    }
    std::sort(roofs.begin(), roofs.end());
    if (roofs.size() > most) roofs.resize(most);
    std::vector<std::uint32_t> indices;
    for (const auto& [area, index] : roofs)
        indices.push_back(index);
    return indices;
}

}  // namespace

std::string scene_json(const UrbanScene& scene, std::size_t most) {
    const Geodetic& origin = scene.frame().origin();
    Json roofs = Json::array(), trees = Json::array();
    for (const std::uint32_t index : roofs_of(scene, most)) {
        Json flat = Json::array();
        double top = -1e9;
        for (const Eigen::Vector3d& corner : scene.triangle(index)) {
            flat.push_back(decimetres(corner.x()));
            flat.push_back(decimetres(corner.y()));
            top = std::max(top, corner.z());
        }
        flat.push_back(decimetres(top));
        roofs.push_back(std::move(flat));
    }
    for (std::size_t i = 0; i < std::min(scene.foliage().size(), most); ++i) {
        Json ring = Json::array();
        for (const Eigen::Vector2d& corner : scene.foliage()[i].ring)
            ring.push_back({decimetres(corner.x()), decimetres(corner.y())});
        trees.push_back(std::move(ring));
    }
    return json_text({{"origin",
                       {{"lat_deg", origin.latitude.deg()},
                        {"lon_deg", origin.longitude.deg()},
                        {"height_m", origin.height.above_ellipsoid.value()}}},
                      {"roofs", std::move(roofs)},
                      {"trees", std::move(trees)}});
}

}  // namespace skyloop
