#include "world/scene/urban_scene.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "detail/foliage_tree.hpp"
#include "detail/plane_merge.hpp"
#include "detail/triangle_tree.hpp"

namespace skyloop::inline world {

namespace {

/// No city is larger, and single precision squares it safely, m.
constexpr double largest_coordinate = 1e8;
/// A triangle less high has no area to speak of, and no normal, m.
constexpr double least_triangle_height = 1e-6;

bool is_place(const Eigen::Vector3d& corner) {
    // Written so that what is no number fails.
    return std::ranges::all_of(corner, [](double value) { return std::abs(value) <= largest_coordinate; });
}

/// What is left of the triangles, and what is counted on the way.
struct KeptTriangles {
    std::vector<CityTriangle> triangles;
    SceneStatistics statistics;
    double wall_area = 0, sloped_area = 0;

    void look_at(const CityTriangle& triangle, const std::array<Eigen::Vector3d, 3>& corners) {
        if (!std::ranges::all_of(corners, is_place)) {
            ++statistics.not_finite;
            return;
        }
        const auto& [a, b, c] = corners;
        const Eigen::Vector3d area = (b - a).cross(c - a);
        const double longest =
            std::sqrt(std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()}));
        if (!(area.norm() > least_triangle_height * longest)) {
            ++statistics.degenerate;
            return;
        }
        keep(triangle, corners, area);
    }

private:
    void keep(const CityTriangle& triangle, const std::array<Eigen::Vector3d, 3>& corners,
              const Eigen::Vector3d& area) {
        constexpr double sine_of_slope = 1.745e-3;  // 0.1°
        triangles.push_back(triangle);
        ++statistics.triangles_of_kind[static_cast<std::size_t>(triangle.kind)];
        for (const Eigen::Vector3d& corner : corners) {
            statistics.lowest = statistics.lowest.cwiseMin(corner);
            statistics.highest = statistics.highest.cwiseMax(corner);
        }
        if (triangle.kind != SurfaceKind::wall) return;
        wall_area += area.norm();
        if (std::abs(area.z()) > sine_of_slope * area.norm()) sloped_area += area.norm();
    }
};

Result<KeptTriangles> kept_triangles(const CityModel& city) {
    KeptTriangles kept;
    kept.statistics.lowest.setConstant(std::numeric_limits<double>::infinity());
    kept.statistics.highest.setConstant(-std::numeric_limits<double>::infinity());
    kept.triangles.reserve(city.triangles.size());
    for (std::size_t i = 0; i < city.triangles.size(); ++i) {
        const CityTriangle& triangle = city.triangles[i];
        std::array<Eigen::Vector3d, 3> corners;
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t corner = triangle.corners[k];
            if (corner >= city.vertices.size())
                return fail(ErrorCode::input, fmt::format("triangle {} of the city has a corner {}, but there are {}",
                                                          i, corner, city.vertices.size()));
            corners[k] = city.vertices[corner];
        }
        if (triangle.material >= city.materials.size())
            return fail(ErrorCode::input, fmt::format("triangle {} of the city is of material {}, but there are {}", i,
                                                      triangle.material, city.materials.size()));
        kept.look_at(triangle, corners);
    }
    kept.statistics.triangles = kept.triangles.size();
    kept.statistics.sloped_share = kept.wall_area > 0 ? kept.sloped_area / kept.wall_area : 0;
    return kept;
}

/// The foot of a scene is that of what is built there: woods far off, where the Earth falls away, do not lower it.
SceneStatistics with_trees(SceneStatistics counts, const FoliageTree& trees) {
    const double foot = counts.lowest.z();
    counts.lowest = counts.lowest.cwiseMin(trees.lowest());
    counts.highest = counts.highest.cwiseMax(trees.highest());
    if (std::isfinite(foot)) counts.lowest.z() = foot;
    return counts;
}

/// How far a line segment passes from the origin of a plane.
double distance_of_segment(const Eigen::Vector2d& from, const Eigen::Vector2d& to) {
    const Eigen::Vector2d edge = to - from;
    const double square = edge.squaredNorm();
    const double share = square > 0 ? std::clamp(-from.dot(edge) / square, 0.0, 1.0) : 0.0;
    return (from + share * edge).norm();
}

/// True when a ray's line passes a triangle in double precision, give or take what single precision may move either.
bool passes(const SceneRay& ray, const std::array<Eigen::Vector3d, 3>& corners) {
    // Seen along the ray, which then is the origin.
    const Eigen::Vector3d right = ray.direction.unitOrthogonal(), down = ray.direction.cross(right);
    std::array<Eigen::Vector2d, 3> seen;
    double size = ray.origin.cwiseAbs().maxCoeff();
    for (std::size_t i = 0; i < 3; ++i) {
        const Eigen::Vector3d from_ray = corners[i] - ray.origin;
        seen[i] = {right.dot(from_ray), down.dot(from_ray)};
        size = std::max(size, corners[i].cwiseAbs().maxCoeff());
    }
    const auto turn = [](const Eigen::Vector2d& a, const Eigen::Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); };
    const auto [least, most] = std::minmax({turn(seen[0], seen[1]), turn(seen[1], seen[2]), turn(seen[2], seen[0])});
    if (least > 0 || most < 0) return true;
    const double slack = 1e-3 + 4 * size * static_cast<double>(std::numeric_limits<float>::epsilon());
    return std::min({distance_of_segment(seen[0], seen[1]), distance_of_segment(seen[1], seen[2]),
                     distance_of_segment(seen[2], seen[0])}) <= slack;
}

}  // namespace

struct UrbanScene::Parts {
    explicit Parts(const CityModel& city)
        : frame(city.origin), materials(city.materials), foliage(city.foliage), vertices(city.vertices) {}

    LocalFrame frame;
    std::vector<std::string> materials;
    FoliageTree foliage;
    std::vector<Eigen::Vector3d> vertices;
    std::vector<CityTriangle> triangles;
    MergedPlanes merged;
    SceneStatistics statistics;
    std::unique_ptr<TriangleTree> tree;

    [[nodiscard]] std::size_t table_memory() const {
        return vertices.capacity() * sizeof(Eigen::Vector3d) + triangles.capacity() * sizeof(CityTriangle) +
               merged.planes.capacity() * sizeof(ScenePlane) + merged.plane_of.capacity() * sizeof(std::uint32_t);
    }

    [[nodiscard]] std::array<Eigen::Vector3d, 3> corners(std::uint32_t index) const {
        const auto& [a, b, c] = triangles[index].corners;
        return {vertices[a], vertices[b], vertices[c]};
    }

    /// Makes an exact hit of what the tree found, and searches on behind a false one.
    [[nodiscard]] SceneHit settled(const SceneRay& ray, TreeHit found) const;
    [[nodiscard]] std::optional<double> exact_distance(const SceneRay& ray, const TreeHit& found) const;
};

/// Distance to the merged plane; nothing for a false hit of a triangle that is seen edge-on.
std::optional<double> UrbanScene::Parts::exact_distance(const SceneRay& ray, const TreeHit& found) const {
    const ScenePlane& plane = merged.planes[merged.plane_of[found.triangle]];
    const auto rough = static_cast<double>(found.distance);
    const double exact = (plane.offset - plane.normal.dot(ray.origin)) / plane.normal.dot(ray.direction);
    if (std::abs(exact - rough) <= 1e-2 + 1e-3 * rough) return std::max(exact, 0.0);
    // At so small an angle a millimetre aside is far along the ray. Where the triangle is, bounds the answer.
    const auto around = corners(found.triangle);
    if (!passes(ray, around)) return std::nullopt;
    const auto along = [&ray](const Eigen::Vector3d& corner) { return ray.direction.dot(corner - ray.origin); };
    const auto [first, last] = std::minmax({along(around[0]), along(around[1]), along(around[2])});
    return std::max(std::clamp(std::isfinite(exact) ? exact : rough, first, last), 0.0);
}

SceneHit UrbanScene::Parts::settled(const SceneRay& ray, TreeHit found) const {
    constexpr int most_false_hits = 64;
    for (int i = 0; i < most_false_hits && found.triangle != SceneHit::nothing; ++i) {
        if (const auto distance = exact_distance(ray, found))
            return {found.triangle, merged.plane_of[found.triangle], *distance};
        found = tree->nearest(ray, std::nextafter(found.distance, std::numeric_limits<float>::infinity()));
    }
    return {};
}

UrbanScene::UrbanScene(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}
UrbanScene::~UrbanScene() = default;

Result<std::shared_ptr<const UrbanScene>> UrbanScene::build(const CityModel& city, const SceneSettings& settings) {
    const auto begun = std::chrono::steady_clock::now();
    const std::size_t estimate = estimated_memory(city.triangles.size());
    if (settings.memory_limit > 0 && estimate > settings.memory_limit)
        return fail(ErrorCode::input, fmt::format("a city of {} triangles takes about {} MB of memory, more than the "
                                                  "{} MB allowed",
                                                  city.triangles.size(), (estimate + 999'999) / 1'000'000,
                                                  settings.memory_limit / 1'000'000));
    auto kept = kept_triangles(city);
    if (!kept) return fail(kept.error());
    auto parts = std::make_unique<Parts>(city);
    SceneStatistics& counts = kept->statistics;
    counts = with_trees(counts, parts->foliage);
    if (!(counts.lowest.x() <= counts.highest.x()))
        return fail(ErrorCode::input,
                    fmt::format("the city has no tree and no triangle to build on: {} given, {} without area, "
                                "{} with a corner that is no number or farther than 100,000 km",
                                city.triangles.size(), counts.degenerate, counts.not_finite));
    parts->triangles = std::move(kept->triangles);
    parts->statistics = counts;
    parts->merged = merge_planes(parts->vertices, parts->triangles, settings.merge_tolerance);
    auto tree = TriangleTree::build(parts->vertices, parts->triangles);
    if (!tree) return fail(tree.error());
    parts->tree = std::move(*tree);
    parts->statistics.planes = parts->merged.planes.size();
    parts->statistics.memory = parts->table_memory() + parts->tree->memory();
    parts->statistics.build_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
    return std::shared_ptr<const UrbanScene>(new UrbanScene(std::move(parts)));
}

std::size_t UrbanScene::estimated_memory(std::size_t triangles) {
    // Growth of the process at most while it builds, Embree 3.13.5, bytes a triangle: at 10^4, 10^5 and 10^6 triangles
    // plain houses 478, 243, 239; houses with windows 476, 232, 211; every triangle with corners of its own 522, 281,
    // 263. About 99 … 106 of them are Embree's tree, which takes 132 … 152 while it grows.
    constexpr std::size_t of_embree_itself = 3'000'000;
    return of_embree_itself + 235 * triangles;
}

const LocalFrame& UrbanScene::frame() const { return parts_->frame; }
std::span<const ScenePlane> UrbanScene::planes() const { return parts_->merged.planes; }
const std::vector<std::string>& UrbanScene::materials() const { return parts_->materials; }
const std::vector<FoliageVolume>& UrbanScene::foliage() const { return parts_->foliage.volumes(); }
double UrbanScene::length_in_foliage(const SceneRay& ray, double length) const {
    return parts_->foliage.length(ray, length);
}
const SceneStatistics& UrbanScene::statistics() const { return parts_->statistics; }
std::array<Eigen::Vector3d, 3> UrbanScene::triangle(std::uint32_t index) const { return parts_->corners(index); }
std::uint32_t UrbanScene::plane_of(std::uint32_t triangle) const { return parts_->merged.plane_of[triangle]; }

bool UrbanScene::blocked(const SceneRay& ray, double length) const {
    // Embree takes a negative length for the answer.
    return length > 0 && parts_->tree->occluded(ray, static_cast<float>(std::min(length, 1e9)));
}

void UrbanScene::blocked(std::span<const SceneRay> rays, std::span<std::uint8_t> answers) const {
    for (std::size_t i = 0; i < rays.size(); i += TriangleTree::width) {
        const std::size_t count = std::min(TriangleTree::width, rays.size() - i);
        parts_->tree->occluded(rays.subspan(i, count), answers.subspan(i, count));
    }
}

SceneHit UrbanScene::first_hit(const SceneRay& ray) const { return parts_->settled(ray, parts_->tree->nearest(ray)); }

void UrbanScene::first_hits(std::span<const SceneRay> rays, std::span<SceneHit> hits, bool coherent) const {
    for (std::size_t i = 0; i < rays.size(); i += TriangleTree::width) {
        const std::size_t count = std::min(TriangleTree::width, rays.size() - i);
        const auto found = parts_->tree->nearest(rays.subspan(i, count), coherent);
        for (std::size_t lane = 0; lane < count; ++lane)
            hits[i + lane] = parts_->settled(rays[i + lane], found[lane]);
    }
}

namespace {

/// A ray straight down from above everything.
SceneRay plumb_line(const SceneStatistics& statistics, double east, double north) {
    return {{east, north, statistics.highest.z() + 1}, {0, 0, -1}};
}

}  // namespace

std::optional<double> UrbanScene::top_at(double east, double north) const {
    const SceneRay ray = plumb_line(parts_->statistics, east, north);
    const SceneHit hit = first_hit(ray);
    if (!hit.any()) return std::nullopt;
    return ray.origin.z() - hit.distance;
}

double UrbanScene::foot_at(double east, double north) const {
    if (const auto ground = ground_at(east, north)) return *ground;
    constexpr double around_m = 50;
    const Eigen::Vector2d place(east, north);
    std::vector<std::pair<double, double>> boxes;  // how far off, how low
    boxes.reserve(parts_->triangles.size());
    double nearest = std::numeric_limits<double>::infinity();
    for (std::uint32_t i = 0; i < parts_->triangles.size(); ++i) {
        const auto [a, b, c] = parts_->corners(i);
        const Eigen::Vector3d low = a.cwiseMin(b).cwiseMin(c), high = a.cwiseMax(b).cwiseMax(c);
        const Eigen::Vector2d away = (low.head<2>() - place).cwiseMax(place - high.head<2>()).cwiseMax(0);
        boxes.emplace_back(away.norm(), low.z());
        nearest = std::min(nearest, away.norm());
    }
    for (const FoliageVolume& trees : foliage())
        for (const Eigen::Vector2d& corner : trees.ring) {
            boxes.emplace_back((corner - place).norm(), trees.ground.value_or(trees.base));
            nearest = std::min(nearest, boxes.back().first);
        }
    double lowest = parts_->statistics.highest.z();
    for (const auto& [distance, low] : boxes)
        if (distance <= nearest + around_m) lowest = std::min(lowest, low);
    return lowest;
}

Eigen::Vector3d UrbanScene::above_surface(const Eigen::Vector3d& place) const {
    constexpr double reach_m = 0.05, clearance_m = 0.005;
    const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
    const SceneHit hit = first_hit({place + reach_m * up, -up});
    if (!hit.any() || hit.distance >= reach_m + clearance_m) return place;
    return place + (reach_m - hit.distance + clearance_m) * up;
}

std::optional<double> UrbanScene::ground_at(double east, double north) const {
    const SceneRay ray = plumb_line(parts_->statistics, east, north);
    TreeHit found = parts_->tree->nearest(ray);
    while (found.triangle != SceneHit::nothing) {
        if (parts_->triangles[found.triangle].kind == SurfaceKind::ground)
            if (const auto distance = parts_->exact_distance(ray, found)) return ray.origin.z() - *distance;
        found = parts_->tree->nearest(ray, std::nextafter(found.distance, std::numeric_limits<float>::infinity()));
    }
    return std::nullopt;
}

bool sees_no_sky(const UrbanScene& scene, const Eigen::Vector3d& place) {
    if (!scene.blocked({place, Eigen::Vector3d::UnitZ()})) return false;
    constexpr int around = 24, lowest = 5, step = 10;  // azimuths; elevations in degrees
    std::vector<SceneRay> rays;
    for (int degrees = lowest; degrees < 90; degrees += step)
        for (int k = 0; k < around; ++k)
            rays.push_back({place, direction_towards(Angle::degrees(360.0 / around * k), Angle::degrees(degrees))});
    std::vector<std::uint8_t> answers(rays.size());
    scene.blocked(rays, answers);
    return std::ranges::all_of(answers, [](std::uint8_t blocked) { return blocked != 0; });
}

}  // namespace skyloop::inline world
