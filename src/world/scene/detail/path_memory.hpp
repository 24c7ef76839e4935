/// Sequences of planes that were paths a moment ago.
#pragma once

#include <vector>

#include "base/time/gps_time.hpp"
#include "path_refiner.hpp"

namespace skyloop {

/// A path that is lost behind an edge is likely to come back: it is kept dormant for a while and tried again each
/// epoch, which costs a microsecond.
class PathMemory {
public:
    explicit PathMemory(double seconds) : seconds_(seconds) {}

    /// A path found for an instant.
    void add(const SatelliteSequence& path, GpsTime when);
    /// Forgets what is older than remembered, or from the future.
    void forget_old(GpsTime now);
    /// Proposes all that belongs to a target.
    void propose_to(PathRefiner& refiner, std::span<const SearchTarget> targets);
    /// Paths that hold now; those of before that do not stay dormant.
    void update(std::span<const FoundPath> paths, std::span<const SearchTarget> targets, GpsTime now);
    /// Marks all that is remembered, so that a search need not try it.
    void mark(KeySet& tried) const;
    [[nodiscard]] std::size_t size() const { return entries_.size(); }

private:
    struct Entry {
        SatelliteSequence path;
        std::uint64_t key = 0;
        GpsTime last;  ///< when it was a path
    };
    double seconds_;
    std::vector<Entry> entries_, next_;
    KeySet keys_;
    std::vector<std::pair<SatelliteId, std::uint32_t>> places_;  ///< of targets, by satellite
};

}  // namespace skyloop
