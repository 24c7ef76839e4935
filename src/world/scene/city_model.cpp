#include "world/scene/city_model.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <utility>

namespace skyloop::inline world {

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

namespace {

using Ring = std::vector<Eigen::Vector2d>;

constexpr double most_pieces_across = 256;

Eigen::AlignedBox2d box_of_ring(const Ring& ring) {
    Eigen::AlignedBox2d box;
    for (const Eigen::Vector2d& corner : ring)
        box.extend(corner);
    return box;
}

// What lies below `limit` (side 1) or above it (side −1) along an axis (Sutherland and Hodgman 1974).
Ring half_of_ring(const Ring& ring, int axis, double limit, double side) {
    Ring half;
    for (std::size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++) {
        const double before = side * (limit - ring[j][axis]), here = side * (limit - ring[i][axis]);
        if ((before < 0 && here > 0) || (before > 0 && here < 0)) {
            Eigen::Vector2d crossing = ring[j] + before / (before - here) * (ring[i] - ring[j]);
            crossing[axis] = limit;
            half.push_back(crossing);
        }
        if (here >= 0) half.push_back(ring[i]);
    }
    return half;
}

}  // namespace

double doubled_area(const Ring& ring) {
    double sum = 0;
    for (std::size_t i = 1; i + 1 < ring.size(); ++i) {
        const Eigen::Vector2d u = ring[i] - ring[0], v = ring[i + 1] - ring[0];
        sum += u.x() * v.y() - u.y() * v.x();
    }
    return sum;
}

bool inside_ring(const Ring& ring, const Eigen::Vector2d& p) {
    bool inside = false;
    for (std::size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++) {
        const Eigen::Vector2d &a = ring[i], &b = ring[j];
        if ((a.y() > p.y()) != (b.y() > p.y()) && p.x() < (b.x() - a.x()) * (p.y() - a.y()) / (b.y() - a.y()) + a.x())
            inside = !inside;
    }
    return inside;
}

std::vector<Ring> ring_pieces(Ring ring, double width) {
    constexpr double least_area = 1e-6;
    std::vector<Ring> pieces, open;
    if (!std::ranges::all_of(ring, [](const Eigen::Vector2d& corner) { return corner.allFinite(); })) return pieces;
    if (ring.size() >= 3) width = std::max(width, box_of_ring(ring).sizes().maxCoeff() / most_pieces_across);
    open.push_back(std::move(ring));
    while (!open.empty()) {
        const Ring piece = std::move(open.back());
        open.pop_back();
        if (piece.size() < 3 || !(std::abs(doubled_area(piece)) > least_area)) continue;
        const Eigen::AlignedBox2d box = box_of_ring(piece);
        int axis = 0;
        if (!(box.sizes().maxCoeff(&axis) > width)) {
            pieces.push_back(piece);
            continue;
        }
        for (const double side : {-1.0, 1.0})
            open.push_back(half_of_ring(piece, axis, box.center()[axis], side));
    }
    return pieces;
}

}  // namespace skyloop::inline world
