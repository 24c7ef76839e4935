/// The one place that knows Embree: a tree over triangles, in single precision.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "base/core/result.hpp"
#include "world/scene/urban_scene.hpp"

namespace skyloop::inline world {

/// What a ray meets first, and how far off in single precision.
struct TreeHit {
    std::uint32_t triangle = SceneHit::nothing;
    float distance = 0;
};

/// Immutable once built; queries may come from many threads at once.
class TriangleTree {
public:
    /// Rays in a packet.
    static constexpr std::size_t width = 16;

    /// Built by one thread, so that the same triangles make the same tree. Fails with `outside` when Embree does, or
    /// when there is not enough memory.
    static Result<std::unique_ptr<TriangleTree>> build(std::span<const Eigen::Vector3d> vertices,
                                                       std::span<const CityTriangle> triangles);
    ~TriangleTree();
    TriangleTree(const TriangleTree&) = delete;
    TriangleTree& operator=(const TriangleTree&) = delete;

    [[nodiscard]] bool occluded(const SceneRay& ray, float length) const;
    /// @param rays at most `width`
    void occluded(std::span<const SceneRay> rays, std::span<std::uint8_t> answers) const;
    /// @param from where along the ray the search begins, m
    [[nodiscard]] TreeHit nearest(const SceneRay& ray, float from = 0) const;
    /// @param rays at most `width`
    [[nodiscard]] std::array<TreeHit, width> nearest(std::span<const SceneRay> rays, bool coherent) const;

    /// What Embree holds now, bytes.
    [[nodiscard]] std::size_t memory() const;

private:
    struct Parts;
    explicit TriangleTree(std::unique_ptr<Parts> parts);
    std::unique_ptr<Parts> parts_;
};

}  // namespace skyloop::inline world
