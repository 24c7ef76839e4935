#include "detail/sight_lines.hpp"

#include <cmath>

namespace skyloop {

void SightLines::look(const UrbanScene& scene, const Eigen::Vector3d& antenna,
                      std::span<const SceneSatellite> satellites) {
    rays_.clear();
    satellite_.clear();
    blocked_.assign(satellites.size(), 1);
    for (std::uint32_t i = 0; i < satellites.size(); ++i) {
        const Eigen::Vector3d way = satellites[i].position - antenna;
        const double length = way.norm();
        if (!(length > 0 && std::isfinite(length))) continue;
        rays_.push_back({antenna, way / length});
        satellite_.push_back(i);
    }
    answers_.resize(rays_.size());
    scene.blocked(rays_, answers_);
    for (std::size_t i = 0; i < rays_.size(); ++i)
        blocked_[satellite_[i]] = answers_[i];
}

void SightLines::collect_targets(std::span<const SceneSatellite> satellites, bool blocked_only,
                                 std::vector<SearchTarget>& targets) const {
    targets.clear();
    for (std::size_t i = 0; i < rays_.size(); ++i) {
        const std::uint32_t satellite = satellite_[i];
        if (blocked_only && seen(satellite)) continue;
        targets.push_back({satellites[satellite].id, satellite, satellites[satellite].position, rays_[i].direction});
    }
}

}  // namespace skyloop
