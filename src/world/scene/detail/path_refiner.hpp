/// From guessed sequences of planes to paths.
/// Which planes a ray met, and sets of such sequences.
/// Rays that go from wall to wall, many at a time.
#pragma once

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "base/core/std_additions.hpp"
#include "world/gnss/satellite.hpp"
#include "world/scene/path_finder.hpp"
#include "world/scene/scene_path.hpp"
#include "world/scene/urban_scene.hpp"

namespace skyloop::inline world {

/// Planes from the antenna to the satellite.
using PlaneSequence = InplaceVector<std::uint32_t, most_reflections>;

inline std::span<const std::uint32_t> planes_of(const PlaneSequence& sequence) {
    return {sequence.begin(), sequence.size()};
}

inline PlaneSequence to_sequence(std::span<const std::uint32_t> planes) {
    PlaneSequence sequence;
    for (const std::uint32_t plane : planes)
        sequence.push_back(plane);
    return sequence;
}

/// A sequence that is to be tried, or was found, for a satellite.
struct SatelliteSequence {
    SatelliteId id;
    PlaneSequence planes;
};

/// 64 well-mixed bits of a satellite and a sequence, never 0. Two of a million different ones are equal once in 10⁷
/// runs; a path would then be overlooked for an epoch.
inline std::uint64_t sequence_key(SatelliteId id, std::span<const std::uint32_t> planes) {
    constexpr std::uint64_t golden = 0x9E3779B97F4A7C15;
    std::uint64_t key = golden * (static_cast<std::uint64_t>(id.constellation) * 4096 +
                                  static_cast<std::uint64_t>(static_cast<std::uint32_t>(id.number)) + 1);
    for (const std::uint32_t plane : planes) {
        key = (key ^ (plane + 1ULL)) * 0xFF51AFD7ED558CCD;
        key ^= key >> 32;
    }
    return key | 1;
}

/// A set of keys in one flat table: quick to clear and to copy, no allocation once it has grown.
class KeySet {
public:
    KeySet() : table_(1024, 0) {}
    void clear() {
        if (size_ > 0) std::fill(table_.begin(), table_.end(), 0);
        size_ = 0;
    }
    /// @returns true when the key is new
    bool insert(std::uint64_t key) {
        if (2 * (size_ + 1) > table_.size()) grow();
        std::uint64_t& place = table_[slot(key)];
        if (place == key) return false;
        place = key;
        ++size_;
        return true;
    }

private:
    [[nodiscard]] std::size_t slot(std::uint64_t key) const {
        const std::size_t mask = table_.size() - 1;
        std::size_t at = (key >> 20) & mask;
        while (table_[at] != 0 && table_[at] != key)
            at = (at + 1) & mask;
        return at;
    }
    void grow() {
        std::vector<std::uint64_t> old(table_.size() * 2, 0);
        old.swap(table_);
        for (const std::uint64_t key : old)
            if (key != 0) table_[slot(key)] = key;
    }

    std::vector<std::uint64_t> table_;
    std::size_t size_ = 0;
};

/// What reflects, and how often.
struct ReflectionRules {
    std::array<bool, 3> reflects{};  ///< by SurfaceKind
    int most_reflections = skyloop::most_reflections;
};
ReflectionRules reflection_rules(const PathSearchSettings& settings);
/// Cosine of the tolerance of an escaped ray to a satellite.
double least_cosine(const PathSearchSettings& settings);

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

}  // namespace skyloop::inline world
