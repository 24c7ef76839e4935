#include <algorithm>
#include <cmath>

#include "skyloop/scene/urban_scene.hpp"

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

/// Metres of a ray inside one prism, of its first `within`. Between two neighbouring crossings all points are inside or
/// none; which, the middle tells, so that a ray through a corner counts as it should.
double length_inside(const FoliageVolume& volume, const SceneRay& ray, double within) {
    if (volume.ring.size() < 3 || !(volume.top > volume.base)) return 0;
    double first = 0, last = within;
    const double up = ray.direction.z();
    if (up != 0) {
        const double base = (volume.base - ray.origin.z()) / up, top = (volume.top - ray.origin.z()) / up;
        first = std::max(first, std::min(base, top));
        last = std::min(last, std::max(base, top));
    } else if (ray.origin.z() < volume.base || ray.origin.z() > volume.top) {
        return 0;
    }
    if (!(last > first)) return 0;
    std::vector<double> ends = crossings(volume, ray, first, last);
    if (std::isfinite(last)) ends.push_back(last);
    double length = 0;
    for (double begin = first; const double end : ends) {
        const Eigen::Vector3d middle = ray.origin + (begin + end) / 2 * ray.direction;
        if (is_inside(volume.ring, middle.head<2>())) length += end - begin;
        begin = end;
    }
    return length;
}

}  // namespace

double foliage_length(std::span<const FoliageVolume> foliage, const SceneRay& ray, double length) {
    double inside = 0;
    for (const FoliageVolume& volume : foliage)
        inside += length_inside(volume, ray, length);
    return inside;
}

}  // namespace skyloop
