#include "skyloop/city/footprint.hpp"

#include <Eigen/Geometry>
#include <cmath>

#include "ear_clipper.hpp"

namespace skyloop {

namespace {

/// The normal of a ring in space, its length twice the area (Newell; Sutherland 1974).
Eigen::Vector3d newell_normal(const std::vector<Eigen::Vector3d>& ring) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (std::size_t i = 1; i + 1 < ring.size(); ++i)
        sum += (ring[i] - ring[0]).cross(ring[i + 1] - ring[0]);
    return sum;
}

void add_walls(CityModel& city, const std::vector<Eigen::Vector2d>& ring, std::pair<double, double> heights,
               std::uint8_t material) {
    for (std::size_t i = 0; i < ring.size(); ++i) {
        const Eigen::Vector2d& a = ring[i];
        const Eigen::Vector2d& b = ring[(i + 1) % ring.size()];
        if (a == b) continue;
        const auto [base, top] = heights;
        city.add_quad({Eigen::Vector3d(a.x(), a.y(), base), Eigen::Vector3d(b.x(), b.y(), base),
                       Eigen::Vector3d(b.x(), b.y(), top), Eigen::Vector3d(a.x(), a.y(), top)},
                      SurfaceKind::wall, material);
    }
}

bool all_finite(const std::vector<std::vector<Eigen::Vector2d>>& rings) {
    for (const auto& ring : rings)
        for (const Eigen::Vector2d& point : ring)
            if (!point.allFinite()) return false;
    return true;
}

/// Adds triangles that index `points`.
void add_indexed(CityModel& city, const std::vector<Eigen::Vector3d>& points,
                 const std::vector<std::array<std::uint32_t, 3>>& triangles, CityTriangle like) {
    const auto first = static_cast<std::uint32_t>(city.vertices.size());
    city.vertices.insert(city.vertices.end(), points.begin(), points.end());
    for (const auto& [a, b, c] : triangles) {
        like.corners = {first + a, first + b, first + c};
        city.triangles.push_back(like);
    }
}

}  // namespace

std::vector<std::array<std::uint32_t, 3>> triangulated(const Footprint& footprint) {
    return EarClipper(footprint).triangles();
}

bool add_extruded(CityModel& city, const Footprint& footprint, double base, double top, std::uint8_t material) {
    if (!(std::isfinite(base) && std::isfinite(top) && base < top) || !all_finite({footprint.outer})) return false;
    if (!all_finite(footprint.holes)) return false;
    const auto roof = triangulated(footprint);
    if (roof.empty()) return false;
    add_walls(city, footprint.outer, {base, top}, material);
    for (const auto& hole : footprint.holes)
        add_walls(city, hole, {base, top}, material);
    std::vector<Eigen::Vector3d> points;
    for (const Eigen::Vector2d& point : footprint.outer)
        points.emplace_back(point.x(), point.y(), top);
    for (const auto& hole : footprint.holes)
        for (const Eigen::Vector2d& point : hole)
            points.emplace_back(point.x(), point.y(), top);
    add_indexed(city, points, roof, {{}, SurfaceKind::roof, material});
    return true;
}

bool add_polygon(CityModel& city, const std::vector<std::vector<Eigen::Vector3d>>& rings, SurfaceKind kind,
                 std::uint8_t material) {
    if (rings.empty() || rings.front().size() < 3) return false;
    for (const auto& ring : rings)
        for (const Eigen::Vector3d& point : ring)
            if (!point.allFinite()) return false;
    const Eigen::Vector3d normal = newell_normal(rings.front());
    const double length = normal.norm();
    if (!(length > 0 && std::isfinite(length))) return false;
    const Eigen::Vector3d u = (normal / length).unitOrthogonal();
    const Eigen::Vector3d v = (normal / length).cross(u);
    const Eigen::Vector3d base = rings.front().front();
    Footprint flat;
    std::vector<Eigen::Vector3d> points;
    for (std::size_t i = 0; i < rings.size(); ++i) {
        std::vector<Eigen::Vector2d>& ring = i == 0 ? flat.outer : flat.holes.emplace_back();
        for (const Eigen::Vector3d& point : rings[i]) {
            ring.emplace_back(u.dot(point - base), v.dot(point - base));
            points.push_back(point);
        }
    }
    const auto triangles = triangulated(flat);
    if (triangles.empty()) return false;
    add_indexed(city, points, triangles, {{}, kind, material});
    return true;
}

}  // namespace skyloop
