#include <algorithm>
#include <cmath>

#include "detail/crown_stretches.hpp"

namespace skyloop {

namespace {

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

/// Even-odd rule.
bool is_inside(std::span<const Eigen::Vector2d> ring, const Eigen::Vector2d& place) {
    bool inside = false;
    for (std::size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++) {
        const Eigen::Vector2d &a = ring[i], &b = ring[j];
        if ((a.y() > place.y()) == (b.y() > place.y())) continue;
        if (place.x() < (b.x() - a.x()) * (place.y() - a.y()) / (b.y() - a.y()) + a.x()) inside = !inside;
    }
    return inside;
}

/// Where along a ray its shadow on the ground crosses a ring, rising, of those between `first` and `last`.
std::vector<double> crossings(const FoliageVolume& volume, const SceneRay& ray, double first, double last) {
    const Eigen::Vector2d origin = ray.origin.head<2>(), direction = ray.direction.head<2>();
    std::vector<double> found;
    for (std::size_t i = 0, j = volume.ring.size() - 1; i < volume.ring.size(); j = i++) {
        const Eigen::Vector2d edge = volume.ring[i] - volume.ring[j], from = volume.ring[j] - origin;
        const double turn = cross(direction, edge);
        if (turn == 0) continue;
        const double along = cross(from, edge) / turn, share = cross(from, direction) / turn;
        if (share >= 0 && share <= 1 && along > first && along < last) found.push_back(along);
    }
    std::ranges::sort(found);
    return found;
}

}  // namespace

// Between two neighbouring crossings all points are inside the prism or none; which, the middle tells, so that a ray
// through a corner counts as it should.
void CrownStretches::add(const FoliageVolume& volume) {
    if (volume.ring.size() < 3 || !(volume.top > volume.base)) return;
    double first = 0, last = length_;
    const double up = ray_.direction.z();
    if (up != 0) {
        const double base = (volume.base - ray_.origin.z()) / up, top = (volume.top - ray_.origin.z()) / up;
        first = std::max(first, std::min(base, top));
        last = std::min(last, std::max(base, top));
    } else if (ray_.origin.z() < volume.base || ray_.origin.z() > volume.top) {
        return;
    }
    if (!(last > first)) return;
    std::vector<double> ends = crossings(volume, ray_, first, last);
    if (std::isfinite(last)) ends.push_back(last);
    for (double begin = first; const double end : ends) {
        const Eigen::Vector3d middle = ray_.origin + (begin + end) / 2 * ray_.direction;
        if (is_inside(volume.ring, middle.head<2>())) stretches_.push_back({begin, end});
        begin = end;
    }
}

double CrownStretches::metres() {
    std::ranges::sort(stretches_);
    double sum = 0, covered = 0;
    for (const auto& [begin, end] : stretches_) {
        sum += std::max(0.0, end - std::max(begin, covered));
        covered = std::max(covered, end);
    }
    return sum;
}

double foliage_length(std::span<const FoliageVolume> foliage, const SceneRay& ray, double length) {
    CrownStretches crowns(ray, length);
    for (const FoliageVolume& volume : foliage)
        crowns.add(volume);
    return crowns.metres();
}

}  // namespace skyloop
