/// Errors that wander smoothly: random processes drawn at fixed instants, with a smooth curve between them.
/// What an effect keeps for each satellite that it has met.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "base/core/random.hpp"
#include "base/core/units.hpp"
#include "base/time/gps_time.hpp"
#include "world/gnss/satellite.hpp"

namespace skyloop::inline world {

/// States by satellite, in a sorted vector: few, and looked up at every epoch.
template <class State>
class PerSatellite {
public:
    /// The state of a satellite. @param make makes it, from the satellite, when it is met for the first time
    template <class Make>
    State& of(SatelliteId satellite, Make&& make) {
        const auto at =
            std::lower_bound(states_.begin(), states_.end(), satellite,
                             [](const std::pair<SatelliteId, State>& s, SatelliteId id) { return s.first < id; });
        if (at != states_.end() && at->first == satellite) return at->second;
        return states_.emplace(at, satellite, make(satellite))->second;
    }

private:
    std::vector<std::pair<SatelliteId, State>> states_;
};

/// A random process that is drawn at knots, whole multiples of a spacing in GPS time, and runs through them on a cubic
/// (Catmull and Rom 1974). It has a rate, and its path does not depend on how often it is looked at.
///
/// State: the four knots around the present instant and a stream of random numbers.
class KnottedProcess {
public:
    /// A first-order Gauss-Markov process from its stationary distribution (MODELS.md 7.15).
    /// @param spacing at most; for correlation times below ten of it a whole part, so that a tenth of the time is not
    /// exceeded: the cubic leaves out what lies between the knots
    KnottedProcess(GaussMarkovParameters parameters, Nanoseconds spacing, RandomStream stream);
    /// A random walk that starts from 0. @param per_root_second 1 σ after one second
    static KnottedProcess walk(double per_root_second, Nanoseconds spacing, RandomStream stream);

    /// Moves to `time`, not earlier than before, and returns the value there.
    double at(GpsTime time);
    /// Derivative at the time of the last at(), per second.
    [[nodiscard]] double rate() const { return rate_; }

private:
    void draw(std::int64_t steps);
    void move_to(std::int64_t knot);

    GaussMarkovParameters parameters_;
    Nanoseconds spacing_;
    RandomStream stream_;
    bool walk_ = false, started_ = false;
    GaussMarkovStep step_;  // over one spacing
    std::int64_t knot_ = 0;
    double newest_ = 0;  // value at knot_ + 2
    std::array<double, 4> values_{};
    double rate_ = 0;
};

}  // namespace skyloop::inline world
