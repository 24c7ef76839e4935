#include "world/city/footprint.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "detail/ear_clipper.hpp"

namespace skyloop::inline world {

std::vector<Eigen::Vector2d> convex_hull(std::vector<Eigen::Vector2d> points) {
    const auto before = [](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
        return a.x() != b.x() ? a.x() < b.x() : a.y() < b.y();
    };
    std::erase_if(points, [](const Eigen::Vector2d& p) { return !p.allFinite(); });  // they have no order
    std::sort(points.begin(), points.end(), before);
    std::vector<Eigen::Vector2d> hull;
    for (int half = 0; half < 2; ++half) {
        const std::size_t start = hull.size();
        for (const Eigen::Vector2d& p : points) {
            while (hull.size() >= start + 2) {
                const Eigen::Vector2d u = hull.back() - hull[hull.size() - 2], v = p - hull.back();
                if (u.x() * v.y() - u.y() * v.x() > 0) break;
                hull.pop_back();
            }
            hull.push_back(p);
        }
        if (!hull.empty()) hull.pop_back();
        std::reverse(points.begin(), points.end());
    }
    return hull;
}

double hull_area(const std::vector<Eigen::Vector2d>& ring) { return std::abs(doubled_area(ring)) / 2; }

Eigen::Vector3d area_vector(const std::vector<Eigen::Vector3d>& ring) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (std::size_t i = 1; i + 1 < ring.size(); ++i)
        sum += (ring[i] - ring[0]).cross(ring[i + 1] - ring[0]);
    return sum;
}

namespace {

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

/// Corners up to which a ring is searched for crossings of its edges; what is drawn by hand has fewer.
constexpr std::size_t most_untangled = 256;

double side_of(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& p) {
    const Eigen::Vector2d u = b - a, v = p - a;
    return u.x() * v.y() - u.y() * v.x();
}

/// Where two edges cross inside of both.
std::optional<Eigen::Vector2d> crossing(const std::array<Eigen::Vector2d, 2>& e,
                                        const std::array<Eigen::Vector2d, 2>& f) {
    const double from = side_of(f[0], f[1], e[0]), to = side_of(f[0], f[1], e[1]);
    if (!(from * to < 0 && side_of(e[0], e[1], f[0]) * side_of(e[0], e[1], f[1]) < 0)) return std::nullopt;
    return e[0] + (e[1] - e[0]) * (from / (from - to));
}

/// Cuts a ring in two at the first crossing of its edges. @returns what is cut off; empty without a crossing
std::vector<Eigen::Vector2d> cut_at_crossing(std::vector<Eigen::Vector2d>& ring) {
    const auto edge = [&](std::size_t i) { return std::array{ring[i], ring[(i + 1) % ring.size()]}; };
    for (std::size_t i = 0; i + 2 < ring.size(); ++i)
        for (std::size_t j = i + 2; j < ring.size(); ++j) {
            const auto place = crossing(edge(i), edge(j));
            if (!place) continue;
            const auto first = ring.begin() + static_cast<std::ptrdiff_t>(i) + 1,
                       last = ring.begin() + static_cast<std::ptrdiff_t>(j) + 1;
            std::vector<Eigen::Vector2d> loop(first, last);
            loop.push_back(*place);
            *first = *place;
            ring.erase(first + 1, last);
            return loop;
        }
    return {};
}

/// A footprint whose outer ring crosses itself, as a bow-tie does, in loops that do not; others as they are.
std::vector<Footprint> untangled(const Footprint& footprint) {
    std::vector<Footprint> whole{footprint};
    if (footprint.outer.size() > most_untangled) return whole;
    for (std::size_t i = 0; i < whole.size() && whole.size() < most_untangled; ++i)
        for (auto loop = cut_at_crossing(whole[i].outer); !loop.empty() && whole.size() < most_untangled;
             loop = cut_at_crossing(whole[i].outer))
            whole.push_back({std::move(loop), footprint.holes});
    return whole;
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

bool add_prism(CityModel& city, const Footprint& footprint, std::pair<double, double> heights, std::uint8_t material) {
    const auto roof = EarClipper(footprint).triangles();
    if (roof.empty()) return false;
    add_walls(city, footprint.outer, heights, material);
    for (const auto& hole : footprint.holes)
        add_walls(city, hole, heights, material);
    std::vector<Eigen::Vector3d> points;
    for (const Eigen::Vector2d& point : footprint.outer)
        points.emplace_back(point.x(), point.y(), heights.second);
    for (const auto& hole : footprint.holes)
        for (const Eigen::Vector2d& point : hole)
            points.emplace_back(point.x(), point.y(), heights.second);
    add_indexed(city, points, roof, {{}, SurfaceKind::roof, material});
    return true;
}

}  // namespace

std::vector<std::array<std::uint32_t, 3>> triangulated(const Footprint& footprint) {
    return EarClipper(footprint).triangles();
}

bool add_extruded(CityModel& city, const Footprint& footprint, double base, double top, std::uint8_t material) {
    if (!(std::isfinite(base) && std::isfinite(top) && base < top) || !all_finite({footprint.outer})) return false;
    if (!all_finite(footprint.holes)) return false;
    bool added = false;
    for (const Footprint& part : untangled(footprint))
        added = add_prism(city, part, {base, top}, material) || added;
    return added;
}

bool add_polygon(CityModel& city, const std::vector<std::vector<Eigen::Vector3d>>& rings, SurfaceKind kind,
                 std::uint8_t material) {
    if (rings.empty() || rings.front().size() < 3) return false;
    for (const auto& ring : rings)
        for (const Eigen::Vector3d& point : ring)
            if (!point.allFinite()) return false;
    const Eigen::Vector3d normal = area_vector(rings.front());
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

}  // namespace skyloop::inline world
