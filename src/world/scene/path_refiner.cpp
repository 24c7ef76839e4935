#include "detail/path_refiner.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>

namespace skyloop {
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
      least_cosine_(std::cos(std::clamp(settings.tolerance_deg, 0.0, 180.0) * std::numbers::pi / 180)) {}

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

}  // namespace skyloop
