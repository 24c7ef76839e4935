#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>

#include "detail/path_refiner.hpp"

namespace skyloop::inline world {
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

double least_cosine(const PathSearchSettings& settings) {
    return std::cos(std::clamp(settings.tolerance_deg, 0.0, 180.0) * std::numbers::pi / 180);
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

namespace {

// Two launch directions are the same below this angle, rad.
constexpr double same_launch = 1e-9;
// Paths found twice, by planes that coincide: rad and metres.
constexpr double same_arrival = 1e-8, same_excess = 1e-6;

auto order_of(const FoundPath& path) {
    return std::make_tuple(path.target, path.planes.size(), path.unfolded.excess, path.unfolded.arrival.x(),
                           path.unfolded.arrival.y(), path.unfolded.arrival.z());
}

bool before(const FoundPath& a, const FoundPath& b) {
    const auto left = order_of(a);
    const auto right = order_of(b);
    if (left != right) return left < right;
    return std::lexicographical_compare(a.planes.begin(), a.planes.end(), b.planes.begin(), b.planes.end());
}

bool same_path(const FoundPath& a, const FoundPath& b) {
    return (a.unfolded.arrival - b.unfolded.arrival).squaredNorm() < same_arrival * same_arrival;
}

// Whether one of the paths kept before is the same: they stand in order, so that those alike in excess are the last.
bool known(std::span<const FoundPath> kept, const FoundPath& path) {
    for (auto other = kept.rbegin(); other != kept.rend(); ++other) {
        if (other->target != path.target || other->planes.size() != path.planes.size()) return false;
        if (path.unfolded.excess - other->unfolded.excess > same_excess) return false;
        if (same_path(*other, path)) return true;
    }
    return false;
}

}  // namespace

void order_paths(std::vector<FoundPath>& paths) {
    std::sort(paths.begin(), paths.end(), before);
    std::size_t kept = 0;
    for (std::size_t i = 0; i < paths.size(); ++i) {
        if (known({paths.data(), kept}, paths[i])) continue;
        if (kept != i) paths[kept] = paths[i];
        ++kept;
    }
    paths.resize(kept);
}

PathRefiner::PathRefiner(const UrbanScene& scene, const PathSearchSettings& settings)
    : scene_(scene),
      rules_(reflection_rules(settings)),
      most_hops_(settings.most_hops),
      least_cosine_(least_cosine(settings)) {}

void PathRefiner::begin(const Eigen::Vector3d& antenna, std::span<const SearchTarget> targets) {
    antenna_ = antenna;
    targets_ = targets;
    tried_.clear();
    next_guesses_.clear();
    next_front_.clear();
    candidates_ = segments_ = 0;
}

void PathRefiner::propose(std::uint32_t target, std::span<const std::uint32_t> planes) { propose(target, planes, 0); }

void PathRefiner::propose(std::uint32_t target, std::span<const std::uint32_t> planes, int hops) {
    if (!tried_.insert(sequence_key(targets_[target].id, planes))) return;
    const Eigen::Vector3d launch = unfold(scene_, planes, antenna_, targets_[target].position).arrival;
    next_front_.add(antenna_, launch);
    next_guesses_.push_back({target, hops, launch});
    ++candidates_;
}

void PathRefiner::settle(std::vector<FoundPath>& found) {
    while (!next_guesses_.empty()) {
        guesses_.swap(next_guesses_);
        std::swap(front_, next_front_);
        next_guesses_.clear();
        next_front_.clear();
        segments_ += front_.trace(scene_, rules_, 0);
        for (const EscapedRay& ray : front_.escaped())
            judge(guesses_[ray.ray], ray, found);
    }
}

void PathRefiner::judge(const Guess& guess, const EscapedRay& ray, std::vector<FoundPath>& found) {
    const std::span<const std::uint32_t> met = front_.planes(ray.ray);
    const UnfoldedPath unfolded = unfold(scene_, met, antenna_, targets_[guess.target].position);
    if ((unfolded.arrival - guess.launch).squaredNorm() < same_launch * same_launch)
        found.push_back({guess.target, to_sequence(met), unfolded});
    else if (guess.hops < most_hops_ && ray.direction.dot(unfolded.departure) > least_cosine_)
        propose(guess.target, met, guess.hops + 1);
}

}  // namespace skyloop::inline world
