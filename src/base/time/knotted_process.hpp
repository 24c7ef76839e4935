/// Errors that wander smoothly: random processes drawn at fixed instants, with a smooth curve between them.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "base/core/random.hpp"
#include "base/core/units.hpp"
#include "base/time/gps_time.hpp"

namespace skyloop::inline base {

/// A first-order Gauss-Markov process (MODELS.md 7.15) that is drawn at knots, whole multiples of a spacing in GPS
/// time, and runs through them on a cubic (Catmull and Rom 1974). It has a rate, and it is a function of GPS time: to
/// the bit the same whenever it is first looked at, however often, and in whatever run. For each knot has a random
/// number of its own, and knots that lie 40 correlation times or more apart are independent; between two such ones the
/// middle is drawn from what a Gauss-Markov process has between two known values (Lévy's construction of the Brownian
/// motion), and so on.
///
/// State: the four knots around the present instant, and the halves that led to the last one.
class KnottedProcess {
public:
    /// In its stationary distribution.
    /// @param spacing at most; for correlation times below ten of it a whole part, so that a tenth of the time is not
    /// exceeded: the cubic leaves out what lies between the knots
    KnottedProcess(GaussMarkovParameters parameters, Nanoseconds spacing, RandomStream stream);

    /// Moves to `time`, not earlier than before, and returns the value there.
    double at(GpsTime time);
    /// From the next knot on it forgets itself at another rate, with the same σ: what it is then depends on its past.
    void set_correlation_time(Seconds time);
    /// Derivative at the time of the last at(), per second.
    [[nodiscard]] double rate() const { return rate_; }

private:
    // Two knots and what the process is there.
    struct Span {
        std::int64_t from = 0, knots = 0;
        double first = 0, last = 0;
        [[nodiscard]] bool holds(std::int64_t knot) const { return knot >= from && knot - from < knots; }
    };
    double at_knot(std::int64_t knot);
    [[nodiscard]] double between(const Span& span) const;
    void draw(std::int64_t knot);
    void start(std::int64_t knot);
    void move_to(std::int64_t knot);

    GaussMarkovParameters parameters_;
    Nanoseconds spacing_;
    IndexedNormals normals_;
    bool retuned_ = false, started_ = false;
    GaussMarkovStep step_;     // over one spacing, of one that is retuned
    std::vector<Span> spans_;  // each a half of the one before
    std::int64_t knot_ = 0;
    std::array<double, 4> values_{};
    double rate_ = 0;
};

}  // namespace skyloop::inline base
