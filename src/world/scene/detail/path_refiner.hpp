/// From guessed sequences of planes to paths.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "path_tracing.hpp"
#include "plane_sequence.hpp"

namespace skyloop {

/// A satellite whose paths are sought.
struct SearchTarget {
    SatelliteId id;
    std::uint32_t satellite = 0;  ///< its place in the caller's list
    Eigen::Vector3d position;     ///< m, in the scene's frame
    Eigen::Vector3d direction;    ///< unit, from the antenna
};

/// A path that holds at the antenna's place, and whose.
struct FoundPath {
    std::uint32_t target = 0;  ///< place in the list of targets
    PlaneSequence planes;
    UnfoldedPath unfolded;
};

/// Puts paths in their order, by target, reflections and excess, and leaves one of those that are the same.
void order_paths(std::vector<FoundPath>& paths);

/// A path is a fixed point of launching and tracing: the launch direction that a sequence unfolds to meets planes that
/// unfold to the same direction. A guess that meets others is replaced by these, a few times (CITY.md section 2).
class PathRefiner {
public:
    PathRefiner(const UrbanScene& scene, const PathSearchSettings& settings);

    /// A new place and new targets, which must outlive settle(); everything tried is forgotten.
    void begin(const Eigen::Vector3d& antenna, std::span<const SearchTarget> targets);
    /// What need not be tried, known paths among them: sequences by their keys.
    [[nodiscard]] KeySet& tried() { return tried_; }
    /// A guess for one of the targets; nothing happens when it was tried.
    void propose(std::uint32_t target, std::span<const std::uint32_t> planes);
    /// Refines all guesses; appends the paths found, in no particular but always the same order.
    void settle(std::vector<FoundPath>& found);

    /// Guesses tried, and stretches of rays traced for them, since begin().
    [[nodiscard]] std::uint64_t candidates() const { return candidates_; }
    [[nodiscard]] std::uint64_t segments() const { return segments_; }

private:
    struct Guess {
        std::uint32_t target = 0;
        int hops = 0;
        Eigen::Vector3d launch;
    };
    void propose(std::uint32_t target, std::span<const std::uint32_t> planes, int hops);
    void judge(const Guess& guess, const EscapedRay& ray, std::vector<FoundPath>& found);

    const UrbanScene& scene_;
    ReflectionRules rules_;
    int most_hops_;
    double least_cosine_;  ///< of a ray that left to the satellite
    Eigen::Vector3d antenna_ = Eigen::Vector3d::Zero();
    std::span<const SearchTarget> targets_;
    KeySet tried_;
    std::vector<Guess> guesses_, next_guesses_;  ///< guesses_ are those of the rays in front_
    Wavefront front_, next_front_;
    std::uint64_t candidates_ = 0, segments_ = 0;
};

}  // namespace skyloop
