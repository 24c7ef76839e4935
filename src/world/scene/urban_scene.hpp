/// A city in which rays are traced.
/// Directions into a scene's sky.
/// Buildings and woods whose heights count from the ground, on the ground of a terrain model.
#pragma once

#include <Eigen/Core>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/core/result.hpp"
#include "base/core/units.hpp"
#include "base/geo/local_frame.hpp"
#include "world/scene/city_model.hpp"

namespace skyloop::inline world {

/// All facets that lie within a millimetre of one plane, of one kind and material: points x with normal·x = offset.
struct ScenePlane {
    Eigen::Vector3d normal;  ///< unit
    double offset = 0;       ///< m
    SurfaceKind kind = SurfaceKind::wall;
    std::uint8_t material = 0;  ///< index of UrbanScene::materials()
};

/// A half-line in the scene's frame; `direction` is a unit vector. A ray with a coordinate that is no number, or
/// farther off than 1e9 m, meets nothing.
struct SceneRay {
    Eigen::Vector3d origin;
    Eigen::Vector3d direction;
};

/// What a ray meets first.
struct SceneHit {
    static constexpr std::uint32_t nothing = ~0U;
    std::uint32_t triangle = nothing;
    std::uint32_t plane = nothing;
    double distance = 0;  ///< along the ray to the plane, m, in double precision
    [[nodiscard]] bool any() const { return triangle != nothing; }
};

/// How a scene is made.
struct SceneSettings {
    double merge_tolerance = 1e-3;  ///< of facets into planes, m
    /// A scene that would take more memory is refused, bytes; 0: no limit.
    std::size_t memory_limit = 0;
};

/// What a scene holds.
struct SceneStatistics {
    std::size_t triangles = 0, planes = 0;
    std::array<std::size_t, 3> triangles_of_kind{};  ///< by SurfaceKind
    std::size_t degenerate = 0;                      ///< triangles without area, left out
    std::size_t not_finite = 0;                      ///< triangles with a corner that is no number, left out
    Eigen::Vector3d lowest, highest;                 ///< of the box around it, m; trees lower it where alone
    double sloped_share = 0;   ///< of the wall area that stands more than 0.1° from the vertical, 0 … 1
    std::size_t memory = 0;    ///< of the tree, the planes and the tables, bytes
    double build_seconds = 0;  ///< on the steady clock, for messages alone
};

/// Immutable; receivers and threads share one. The only user of Embree (3.13 or 4).
class UrbanScene {
public:
    /// Builds the tree and merges coplanar facets. Triangles without area or with a corner that is no number are left
    /// out and counted. Fails with `input` when neither a triangle is left nor a tree, and when it would take more
    /// memory than allowed, with the estimate.
    static Result<std::shared_ptr<const UrbanScene>> build(const CityModel& city, const SceneSettings& settings = {});
    /// Bytes that a scene of so many triangles takes while it is built, within a third.
    static std::size_t estimated_memory(std::size_t triangles);

    UrbanScene(const UrbanScene&) = delete;
    UrbanScene& operator=(const UrbanScene&) = delete;
    ~UrbanScene();

    /// The frame of all coordinates: east, north, up at the city's origin.
    [[nodiscard]] const LocalFrame& frame() const;
    [[nodiscard]] std::span<const ScenePlane> planes() const;
    [[nodiscard]] const std::vector<std::string>& materials() const;
    [[nodiscard]] const std::vector<FoliageVolume>& foliage() const;
    /// Metres of a ray, within `length` metres of its origin, that lie in its crowns of trees; in several at once
    /// counts once.
    [[nodiscard]] double length_in_foliage(const SceneRay& ray,
                                           double length = std::numeric_limits<double>::infinity()) const;
    [[nodiscard]] const SceneStatistics& statistics() const;
    /// Corners of a triangle as built, m; triangles are numbered as kept.
    [[nodiscard]] std::array<Eigen::Vector3d, 3> triangle(std::uint32_t index) const;
    [[nodiscard]] std::uint32_t plane_of(std::uint32_t triangle) const;

    /// True when something stands in the way, within `length` metres.
    [[nodiscard]] bool blocked(const SceneRay& ray, double length = 1e9) const;
    /// The same for many rays: 16 at a time.
    void blocked(std::span<const SceneRay> rays, std::span<std::uint8_t> answers) const;
    /// What a ray meets first; false grazing hits, whose distance differs from that to the plane, do not count.
    [[nodiscard]] SceneHit first_hit(const SceneRay& ray) const;
    /// The same for many rays, 16 at a time. @param coherent neighbours in the list start and point alike
    void first_hits(std::span<const SceneRay> rays, std::span<SceneHit> hits, bool coherent) const;
    /// Height of the highest surface above or below a place, m; nothing where there is none.
    [[nodiscard]] std::optional<double> top_at(double east, double north) const;
    /// Height of the highest ground there, m.
    [[nodiscard]] std::optional<double> ground_at(double east, double north) const;
    /// The ground there; without any the lowest corner of what stands nearest and within 50 m of that, m.
    [[nodiscard]] double foot_at(double east, double north) const;
    /// The place itself, but 5 mm above a surface on which it lies or that is up to 5 cm above it: heights are rounded,
    /// and rays that begin in a facet meet it.
    [[nodiscard]] Eigen::Vector3d above_surface(const Eigen::Vector3d& place) const;

private:
    struct Parts;
    explicit UrbanScene(std::unique_ptr<Parts> parts);
    std::unique_ptr<Parts> parts_;
};

/// True where no part of the sky is seen: inside a building or below the ground. Places under an arch and at the foot
/// of a light well are not.
bool sees_no_sky(const UrbanScene& scene, const Eigen::Vector3d& place);

/// Metres of a ray, within `length` metres of its origin, that lie in crowns of trees, in several at once counts
/// once; looks at every one of them.
double foliage_length(std::span<const FoliageVolume> foliage, const SceneRay& ray,
                      double length = std::numeric_limits<double>::infinity());

/// A unit vector in east, north and up. @param azimuth from north to east
inline Eigen::Vector3d direction_towards(Angle azimuth, Angle elevation) {
    const double horizontal = std::cos(elevation.rad());
    return {horizontal * std::sin(azimuth.rad()), horizontal * std::cos(azimuth.rad()), std::sin(elevation.rad())};
}

/// Moves them up or down: a building to the lowest ground below its corners, woods, in pieces of at most 60 m, to the
/// mean of theirs. Both are in one frame. @returns how many stand beyond the terrain and stay as they were
std::size_t stand_on_terrain(CityModel& city, const UrbanScene& terrain);

}  // namespace skyloop::inline world
