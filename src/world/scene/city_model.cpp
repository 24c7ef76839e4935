#include "world/scene/city_model.hpp"

#include <algorithm>

namespace skyloop {

std::uint8_t CityModel::material_index(std::string_view name) {
    const auto known = std::find(materials.begin(), materials.end(), name);
    if (known == materials.end()) {
        if (materials.size() > 255) return 0;
        materials.emplace_back(name);
        return static_cast<std::uint8_t>(materials.size() - 1);
    }
    return static_cast<std::uint8_t>(known - materials.begin());
}

void CityModel::add_triangle(const std::array<Eigen::Vector3d, 3>& corners, SurfaceKind kind, std::uint8_t material) {
    const auto first = static_cast<std::uint32_t>(vertices.size());
    vertices.insert(vertices.end(), corners.begin(), corners.end());
    triangles.push_back({{first, first + 1, first + 2}, kind, material});
}

void CityModel::add_quad(const std::array<Eigen::Vector3d, 4>& corners, SurfaceKind kind, std::uint8_t material) {
    const auto first = static_cast<std::uint32_t>(vertices.size());
    vertices.insert(vertices.end(), corners.begin(), corners.end());
    triangles.push_back({{first, first + 1, first + 2}, kind, material});
    triangles.push_back({{first, first + 2, first + 3}, kind, material});
}

}  // namespace skyloop
