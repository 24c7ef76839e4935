#include "detail/path_tracing.hpp"

#include <algorithm>
#include <cmath>

namespace skyloop {
namespace {

constexpr std::size_t planes_per_ray = most_reflections;
// A ray goes on a little in front of the wall that it met, lest it meets it again: 2 mm, and far from the origin four
// steps of the tree's single-precision coordinates (2⁻²³ of their size).
constexpr double least_clearance = 2e-3;
constexpr double relative_clearance = 4.0 / 8388608.0;
// Below this sine a ray runs along the wall.
constexpr double grazing = 1e-9;

}  // namespace

ReflectionRules reflection_rules(const PathSearchSettings& settings) {
    ReflectionRules rules;
    rules.reflects[static_cast<std::size_t>(SurfaceKind::wall)] = settings.walls_reflect;
    rules.reflects[static_cast<std::size_t>(SurfaceKind::roof)] = settings.roofs_reflect;
    rules.reflects[static_cast<std::size_t>(SurfaceKind::ground)] = settings.ground_reflects;
    rules.most_reflections = std::clamp(settings.most_reflections, 1, most_reflections);
    return rules;
}

void Wavefront::clear() {
    rays_.clear();
    number_.clear();
    met_.clear();
    escaped_.clear();
}

std::uint32_t Wavefront::add(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) {
    const auto number = static_cast<std::uint32_t>(met_.size());
    rays_.push_back({origin, direction});
    number_.push_back(number);
    met_.push_back(0);
    return number;
}

std::span<const std::uint32_t> Wavefront::planes(std::uint32_t ray) const {
    return {planes_.data() + ray * planes_per_ray, met_[ray]};
}

std::size_t Wavefront::trace(const UrbanScene& scene, const ReflectionRules& rules, int coherent_rounds) {
    const std::span<const ScenePlane> planes = scene.planes();
    if (planes_.size() < met_.size() * planes_per_ray) planes_.resize(met_.size() * planes_per_ray);
    if (hits_.size() < rays_.size()) hits_.resize(rays_.size());
    std::size_t stretches = 0;
    for (int round = 0; !rays_.empty(); ++round) {
        const std::size_t count = rays_.size();
        stretches += count;
        const std::span<SceneHit> hits(hits_.data(), count);
        scene.first_hits(rays_, hits, round < coherent_rounds);
        std::size_t left = 0;
        for (std::size_t i = 0; i < count; ++i) {
            if (!hits[i].any()) {
                if (round > 0) escaped_.push_back({number_[i], rays_[i].direction});
                continue;
            }
            const ScenePlane& plane = planes[hits[i].plane];
            if (!rules.reflects[static_cast<std::size_t>(plane.kind)]) continue;
            if (!reflect(i, plane, hits[i], rules.most_reflections)) continue;
            if (left != i) {
                rays_[left] = rays_[i];
                number_[left] = number_[i];
            }
            ++left;
        }
        rays_.resize(left);
        number_.resize(left);
    }
    return stretches;
}

bool Wavefront::reflect(std::size_t at, const ScenePlane& plane, const SceneHit& hit, int most) {
    const std::uint32_t number = number_[at];
    SceneRay& ray = rays_[at];
    const double towards = plane.normal.dot(ray.direction);
    if (met_[number] >= most || std::abs(towards) < grazing || !(hit.distance > -least_clearance)) return false;
    planes_[number * planes_per_ray + met_[number]++] = hit.plane;
    ray.origin += ray.direction * hit.distance;
    const double clearance = std::max(least_clearance, relative_clearance * ray.origin.cwiseAbs().maxCoeff());
    ray.origin += plane.normal * (towards > 0 ? -clearance : clearance);
    ray.direction -= plane.normal * (2 * towards);
    return true;
}

}  // namespace skyloop
