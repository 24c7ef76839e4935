/// Which satellites stand behind something.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "path_refiner.hpp"

namespace skyloop {

/// Straight lines from the antenna to all satellites, asked of the scene at once.
class SightLines {
public:
    /// A satellite, or an antenna, whose position is no number is neither seen nor sought.
    void look(const UrbanScene& scene, const Eigen::Vector3d& antenna, std::span<const SceneSatellite> satellites);
    [[nodiscard]] bool seen(std::size_t satellite) const { return blocked_[satellite] == 0; }
    /// Those whose paths are to be sought, in the satellites' order.
    void collect_targets(std::span<const SceneSatellite> satellites, bool blocked_only,
                         std::vector<SearchTarget>& targets) const;

private:
    std::vector<SceneRay> rays_;  ///< to those with a position
    std::vector<std::uint32_t> satellite_;
    std::vector<std::uint8_t> answers_;
    std::vector<std::uint8_t> blocked_;  ///< by satellite
};

}  // namespace skyloop
