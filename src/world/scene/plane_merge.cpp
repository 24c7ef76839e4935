#include "detail/plane_merge.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace skyloop::inline world {

namespace {

constexpr double tile_size = 64;          ///< m
constexpr double normal_cell = 0.05;      ///< of each component
constexpr double least_tolerance = 1e-9;  ///< m; less is below what double precision tells of a city
constexpr double most_doubt = 0.005;      ///< of a normal that is sought; a facet of 0.5 m and a millimetre

/// A table of planes by a hashed key: several may have one key.
class PlaneTable {
public:
    explicit PlaneTable(std::size_t expected) {
        std::size_t size = 64;
        while (size < 2 * expected)
            size *= 2;
        slots_.resize(size);
    }

    /// The first plane of this key that `wanted` accepts, or `nothing`.
    template <class Wanted>
    std::uint32_t find(std::uint64_t key, const Wanted& wanted) const {
        const auto short_key = static_cast<std::uint32_t>(key);
        for (std::size_t at = slot(key); slots_[at].plane != SceneHit::nothing; at = (at + 1) & (slots_.size() - 1))
            if (slots_[at].key == short_key && wanted(slots_[at].plane)) return slots_[at].plane;
        return SceneHit::nothing;
    }

    void add(std::uint64_t key, std::uint32_t plane) {
        if (2 * ++count_ > slots_.size()) grow();
        insert({static_cast<std::uint32_t>(key), plane}, slot(key));
    }

private:
    struct Slot {
        std::uint32_t key = 0;
        std::uint32_t plane = SceneHit::nothing;
    };

    [[nodiscard]] std::size_t slot(std::uint64_t key) const {
        return static_cast<std::uint32_t>(key) & (slots_.size() - 1);
    }
    void insert(const Slot& entry, std::size_t at) {
        while (slots_[at].plane != SceneHit::nothing)
            at = (at + 1) & (slots_.size() - 1);
        slots_[at] = entry;
    }
    void grow() {
        std::vector<Slot> old(2 * slots_.size());
        old.swap(slots_);
        for (const Slot& entry : old)
            if (entry.plane != SceneHit::nothing) insert(entry, slot(entry.key));
    }

    std::vector<Slot> slots_;
    std::size_t count_ = 0;
};

/// A triangle as the merge sees it.
struct Facet {
    std::array<Eigen::Vector3d, 3> corners;
    Eigen::Vector3d normal;     ///< unit, either sense
    Eigen::Vector3d centre;     ///< of the corners
    double height = 0;          ///< the least of the three, m
    std::uint32_t surface = 0;  ///< kind and material
};

std::uint32_t surface_of(SurfaceKind kind, std::uint8_t material) {
    return static_cast<std::uint32_t>(kind) << 8U | material;
}

std::array<Eigen::Vector3d, 3> corners_of(std::span<const Eigen::Vector3d> vertices, const CityTriangle& triangle) {
    return {vertices[triangle.corners[0]], vertices[triangle.corners[1]], vertices[triangle.corners[2]]};
}

/// Twice the area times the normal.
Eigen::Vector3d area_vector(const std::array<Eigen::Vector3d, 3>& corners) {
    return (corners[1] - corners[0]).cross(corners[2] - corners[0]);
}

Facet facet_of(std::span<const Eigen::Vector3d> vertices, const CityTriangle& triangle) {
    Facet facet;
    facet.corners = corners_of(vertices, triangle);
    const auto& [a, b, c] = facet.corners;
    const Eigen::Vector3d area = area_vector(facet.corners);
    const double twice = area.norm();
    facet.normal = area / twice;
    facet.centre = (a + b + c) / 3;
    facet.height = twice / std::sqrt(std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()}));
    facet.surface = surface_of(triangle.kind, triangle.material);
    return facet;
}

bool lies_in(const Facet& facet, const Eigen::Vector3d& normal, double offset, double tolerance) {
    return std::ranges::all_of(facet.corners, [&](const Eigen::Vector3d& corner) {
        return std::abs(normal.dot(corner) - offset) <= tolerance;
    });
}

double mean_offset(const Facet& facet, const Eigen::Vector3d& normal) {
    return (normal.dot(facet.corners[0]) + normal.dot(facet.corners[1]) + normal.dot(facet.corners[2])) / 3;
}

/// The plane through a facet; a wall that is vertical but for rounding is made exactly so, because paths of exactly
/// vertical walls keep their elevation.
ScenePlane plane_through(const Facet& facet, double tolerance) {
    constexpr double nearly_vertical = 1e-4;
    ScenePlane plane{facet.normal, mean_offset(facet, facet.normal), static_cast<SurfaceKind>(facet.surface >> 8U),
                     static_cast<std::uint8_t>(facet.surface & 0xffU)};
    if (plane.normal.z() != 0 && std::abs(plane.normal.z()) < nearly_vertical) {
        const Eigen::Vector3d upright = Eigen::Vector3d(plane.normal.x(), plane.normal.y(), 0).normalized();
        const double offset = mean_offset(facet, upright);
        if (lies_in(facet, upright, offset, tolerance)) {
            plane.normal = upright;
            plane.offset = offset;
        }
    }
    return plane;
}

/// Whole cells from `low` to `high`.
struct CellRange {
    std::int64_t low, high;
    CellRange(double value, double doubt, double cell)
        : low(static_cast<std::int64_t>(std::floor((value - doubt) / cell))),
          high(static_cast<std::int64_t>(std::floor((value + doubt) / cell))) {}
};

std::uint64_t mixed(std::uint64_t hash, std::int64_t value) {
    hash = (hash ^ static_cast<std::uint64_t>(value)) * 0xff51afd7ed558ccdULL;
    return hash ^ hash >> 32U;
}

/// Where a facet is sought: in one sense of its normal, about a place near it.
struct Sought {
    Eigen::Vector3d normal;
    double normal_doubt = 0;
    double offset = 0, offset_doubt = 0, offset_cell = 1;  ///< m
    std::uint64_t salt = 0;                                ///< of kind, material and tile

    /// Calls `visit(key)` for all cells until it returns true.
    template <class Visit>
    bool any_key(const Visit& visit) const {
        const CellRange x(normal.x(), normal_doubt, normal_cell), y(normal.y(), normal_doubt, normal_cell),
            z(normal.z(), normal_doubt, normal_cell), d(offset, offset_doubt, offset_cell);
        for (std::int64_t i = x.low; i <= x.high; ++i)
            for (std::int64_t j = y.low; j <= y.high; ++j)
                for (std::int64_t k = z.low; k <= z.high; ++k)
                    for (std::int64_t l = d.low; l <= d.high; ++l)
                        if (visit(mixed(mixed(mixed(mixed(salt, i), j), k), l))) return true;
        return false;
    }
    [[nodiscard]] std::uint64_t own_key() const {
        Sought exactly = *this;
        exactly.normal_doubt = exactly.offset_doubt = 0;
        std::uint64_t own = 0;
        exactly.any_key([&own](std::uint64_t key) { return own = key, true; });
        return own;
    }
};

/// A plane has two normals; the one on this side of a direction that no street runs at right angles to is taken.
double side_of(const Eigen::Vector3d& normal) { return normal.dot(Eigen::Vector3d(0.6180, 0.7549, 0.2191)); }

Eigen::Vector3d on_one_side(const Eigen::Vector3d& normal) { return side_of(normal) < 0 ? -normal : normal; }

class PlaneMerge {
public:
    PlaneMerge(std::size_t triangles, double tolerance)
        : tolerance_(std::max(tolerance, least_tolerance)), tiles_(triangles / 2), everywhere_(triangles / 4) {}

    [[nodiscard]] bool fits(const Facet& facet, std::uint32_t index) const {
        const ScenePlane& plane = planes_[index];
        return surface_of(plane.kind, plane.material) == facet.surface &&
               std::abs(plane.normal.dot(facet.normal)) > 1 - 1e-5 &&
               lies_in(facet, plane.normal, plane.offset, tolerance_);
    }

    std::uint32_t plane_of(const Facet& facet) {
        const Eigen::Vector3d tile(std::floor(facet.centre.x() / tile_size), std::floor(facet.centre.y() / tile_size),
                                   std::floor(facet.centre.z() / tile_size));
        const Eigen::Vector3d middle = (tile.array() + 0.5) * tile_size;
        std::uint64_t salt = mixed(0x9e3779b97f4a7c15ULL, facet.surface);
        const std::uint64_t whole = salt;
        for (const double number : tile)
            salt = mixed(salt, static_cast<std::int64_t>(number));

        const Sought here = in_tile(facet, middle, salt);
        std::uint32_t found = find(tiles_, here, facet);
        if (found != SceneHit::nothing) return found;
        const Sought there = far_away(facet, whole);
        found = find(everywhere_, there, facet);
        if (found == SceneHit::nothing) {
            found = static_cast<std::uint32_t>(planes_.size());
            planes_.push_back(plane_through(facet, tolerance_));
            everywhere_.add(there.own_key(), found);
        }
        tiles_.add(here.own_key(), found);
        return found;
    }

    std::vector<ScenePlane> take() && { return std::move(planes_); }

private:
    /// A facet within the tolerance of a plane may be turned against it by twice the tolerance over its height, and
    /// so be off by that angle times the distance from where offsets are counted, the middle of its tile.
    [[nodiscard]] Sought in_tile(const Facet& facet, const Eigen::Vector3d& middle, std::uint64_t salt) const {
        const double doubt = std::min(most_doubt, 2.5 * tolerance_ / facet.height);
        const Eigen::Vector3d arm = facet.centre - middle;
        const Eigen::Vector3d normal = on_one_side(facet.normal);
        return {normal, doubt, normal.dot(arm), tolerance_ + doubt * arm.norm(), 0.25, salt};
    }
    /// New in its tile; elsewhere there may be a facet of the same plane, if both are drawn well enough to tell at
    /// such a distance. Offsets are exact then, and cells as small as keeps thousands of level roofs apart.
    [[nodiscard]] Sought far_away(const Facet& facet, std::uint64_t salt) const {
        const Eigen::Vector3d normal = on_one_side(facet.normal);
        return {normal, 1e-6, normal.dot(facet.centre), tolerance_, 4 * tolerance_, salt};
    }

    [[nodiscard]] std::uint32_t find(const PlaneTable& table, Sought sought, const Facet& facet) const {
        std::uint32_t found = SceneHit::nothing;
        const auto wanted = [&](std::uint32_t plane) { return fits(facet, plane); };
        const auto look = [&](std::uint64_t key) { return (found = table.find(key, wanted)) != SceneHit::nothing; };
        if (!sought.any_key(look) && side_of(sought.normal) < 2 * sought.normal_doubt) {
            sought.normal = -sought.normal;
            sought.offset = -sought.offset;
            sought.any_key(look);
        }
        return found;
    }

    double tolerance_;
    std::vector<ScenePlane> planes_;
    PlaneTable tiles_, everywhere_;
};

/// Triangles by falling area, those within a factor of two in their own order: a facet's plane is known the better the
/// larger it is.
std::vector<std::uint32_t> largest_first(std::span<const Eigen::Vector3d> vertices,
                                         std::span<const CityTriangle> triangles) {
    constexpr int lowest = -64, highest = 64;
    std::vector<std::uint8_t> classes(triangles.size());
    std::array<std::size_t, highest - lowest + 2> starts{};
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        const int exponent = std::ilogb(area_vector(corners_of(vertices, triangles[i])).squaredNorm()) / 2;
        classes[i] = static_cast<std::uint8_t>(highest - std::clamp(exponent, lowest, highest));
        ++starts[classes[i] + 1U];
    }
    std::partial_sum(starts.begin(), starts.end(), starts.begin());
    std::vector<std::uint32_t> order(triangles.size());
    for (std::size_t i = 0; i < triangles.size(); ++i)
        order[starts[classes[i]]++] = static_cast<std::uint32_t>(i);
    return order;
}

/// Numbers planes in the order in which triangles name them.
void renumber(MergedPlanes& merged) {
    std::vector<std::uint32_t> number(merged.planes.size(), SceneHit::nothing);
    std::vector<ScenePlane> planes;
    planes.reserve(merged.planes.size());
    for (std::uint32_t& plane : merged.plane_of) {
        if (number[plane] == SceneHit::nothing) {
            number[plane] = static_cast<std::uint32_t>(planes.size());
            planes.push_back(merged.planes[plane]);
        }
        plane = number[plane];
    }
    merged.planes = std::move(planes);
}

}  // namespace

MergedPlanes merge_planes(std::span<const Eigen::Vector3d> vertices, std::span<const CityTriangle> triangles,
                          double tolerance) {
    PlaneMerge merge(triangles.size(), tolerance);
    MergedPlanes merged;
    std::vector<std::uint32_t>& plane_of = merged.plane_of;
    plane_of.resize(triangles.size(), SceneHit::nothing);
    for (const std::uint32_t index : largest_first(vertices, triangles)) {
        const Facet facet = facet_of(vertices, triangles[index]);
        // Mostly the next triangle of the same polygon has been here already.
        const auto neighbour = [&](std::uint32_t other) {
            return other < plane_of.size() && plane_of[other] != SceneHit::nothing &&
                   merge.fits(facet, plane_of[other]);
        };
        plane_of[index] = neighbour(index - 1)   ? plane_of[index - 1]
                          : neighbour(index + 1) ? plane_of[index + 1]
                                                 : merge.plane_of(facet);
    }
    merged.planes = std::move(merge).take();
    renumber(merged);
    return merged;
}

}  // namespace skyloop::inline world
