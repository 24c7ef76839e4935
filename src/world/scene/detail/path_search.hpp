/// One search for paths that are not known yet.
/// Which satellites stand behind something.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "path_refiner.hpp"
#include "ray_lattice.hpp"
#include "search_crew.hpp"

namespace skyloop::inline world {

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

/// A lattice of rays around the antenna; those that leave the city near a satellite propose the planes that they met,
/// which are refined to paths. What it finds depends on what it was asked alone, not on the crew that helps.
class PathSearch {
public:
    /// What to search: filled in before run().
    struct Request {
        Eigen::Vector3d antenna = Eigen::Vector3d::Zero();
        std::vector<SceneSatellite> satellites;
        std::uint64_t number = 0;  ///< of the search: turns the lattice
        bool still = false;        ///< the place is known well: few rays will do
    };
    /// What it took.
    struct Effort {
        std::uint64_t rays = 0, segments = 0, candidates = 0;
    };

    PathSearch(const UrbanScene& scene, const PathSearchSettings& settings, std::size_t workers);
    Request& request() { return request_; }
    /// Sequences that need not be tried, by their keys.
    KeySet& known() { return known_; }
    void run(SearchCrew& crew);
    [[nodiscard]] std::span<const SatelliteSequence> found() const { return found_; }
    [[nodiscard]] const Effort& effort() const { return effort_; }

private:
    /// Rays that are sent where paths may begin, and a few everywhere when walls slope.
    struct Lattices {
        RayLattice banded;
        std::optional<RayLattice> everywhere;
    };
    struct Proposal {
        std::uint32_t target = 0;
        PlaneSequence planes;
    };
    struct ChunkResult {
        std::vector<Proposal> proposals;
        std::uint64_t segments = 0;
    };
    struct Scratch {
        Wavefront front;
        KeySet proposed;
    };
    Lattices lattices(int rays, bool slopes) const;
    void aim();
    void trace_chunk(std::size_t chunk, std::size_t worker);

    const UrbanScene& scene_;
    const PathSearchSettings settings_;
    const ReflectionRules rules_;
    const bool level_surfaces_;  ///< reflect
    const double least_cosine_;
    Lattices moving_, still_;
    Request request_;
    KeySet known_;
    SightLines sight_;
    std::vector<SearchTarget> targets_;
    std::vector<ElevationBand> bands_;
    std::vector<Eigen::Vector3d> directions_;
    std::vector<Scratch> scratch_;  ///< by worker
    std::vector<ChunkResult> chunks_;
    PathRefiner refiner_;
    std::vector<FoundPath> paths_;
    std::vector<SatelliteSequence> found_;
    Effort effort_;
};

}  // namespace skyloop::inline world
