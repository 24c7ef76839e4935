/// Rays that go from wall to wall, many at a time.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "world/scene/path_finder.hpp"
#include "world/scene/scene_path.hpp"
#include "world/scene/urban_scene.hpp"

namespace skyloop {

/// What reflects, and how often.
struct ReflectionRules {
    std::array<bool, 3> reflects{};  ///< by SurfaceKind
    int most_reflections = skyloop::most_reflections;
};
ReflectionRules reflection_rules(const PathSearchSettings& settings);

/// A ray that left the city after at least one reflection.
struct EscapedRay {
    std::uint32_t ray = 0;      ///< the number that Wavefront::add gave it
    Eigen::Vector3d direction;  ///< in which it left
};

/// Follows rays all together, one reflection a round; the list of those still under way is kept dense, so that packets
/// stay full. The scene's tree decides what is hit, planes in double precision where and how it goes on.
class Wavefront {
public:
    void clear();
    /// @returns the ray's number, counted from 0
    std::uint32_t add(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction);
    /// Follows all rays until they leave, end at what does not reflect, or have reflected too often.
    ///
    /// @param coherent_rounds rounds in which neighbours still go alike
    /// @returns stretches of rays that were traced
    std::size_t trace(const UrbanScene& scene, const ReflectionRules& rules, int coherent_rounds);
    /// By number of reflections, then by ray.
    [[nodiscard]] std::span<const EscapedRay> escaped() const { return escaped_; }
    /// Planes that a ray met.
    [[nodiscard]] std::span<const std::uint32_t> planes(std::uint32_t ray) const;

private:
    /// Moves one ray on to what it hit; false when it ends there.
    bool reflect(std::size_t at, const ScenePlane& plane, const SceneHit& hit, int most);

    std::vector<SceneRay> rays_;         ///< under way
    std::vector<std::uint32_t> number_;  ///< theirs
    std::vector<SceneHit> hits_;
    std::vector<std::uint32_t> planes_;  ///< most_reflections for each ray
    std::vector<std::uint8_t> met_;      ///< how many of them
    std::vector<EscapedRay> escaped_;
};

}  // namespace skyloop
