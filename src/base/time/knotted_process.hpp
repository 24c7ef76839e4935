/// Errors that wander smoothly: random processes drawn at fixed instants, with a smooth curve between them.
#pragma once

#include <array>
#include <cstdint>

#include "base/core/random.hpp"
#include "base/core/units.hpp"
#include "base/time/gps_time.hpp"

namespace skyloop::inline base {

/// A random process that is drawn at knots, whole multiples of a spacing in GPS time, and runs through them on a cubic
/// (Catmull and Rom 1974). It has a rate, and its path depends neither on how often it is looked at nor, but for the
/// start of a block of knots, on when it was first: each knot has random numbers of its own, and the first look, and
/// one after a long absence, begins at the start of its block.
///
/// State: the four knots around the present instant.
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
    /// From the next knot on it forgets itself at another rate, with the same σ.
    void set_correlation_time(Seconds time);
    /// Derivative at the time of the last at(), per second.
    [[nodiscard]] double rate() const { return rate_; }

private:
    void draw(std::int64_t steps, std::int64_t knot);
    void start(std::int64_t knot);
    void move_to(std::int64_t knot);

    GaussMarkovParameters parameters_;
    Nanoseconds spacing_;
    IndexedNormals normals_;
    bool walk_ = false, started_ = false;
    GaussMarkovStep step_;  // over one spacing
    std::int64_t knot_ = 0;
    double newest_ = 0;  // value at knot_ + 2
    std::array<double, 4> values_{};
    double rate_ = 0;
};

}  // namespace skyloop::inline base
