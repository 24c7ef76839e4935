/// The even rhythm behind the uneven arrivals of a source without a clock.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>

#include "base/core/units.hpp"
#include "motion/trajectory/truth_sample.hpp"

namespace skyloop {

/// How long the vehicle took from one statement to the next, by the way and the velocities that it tells itself;
/// nothing where it tells no velocity or hardly moves.
std::optional<Nanoseconds> own_step(const TruthSample& before, const TruthSample& now);

/// Says when statements would have come, had each of them been under way for the same time (FEEDS.md 3.2).
///
/// The first arrivals are laid on an even grid: of all counts of lost statements the likeliest one, for a delay that
/// scatters over less than a period must not pass for a loss. From then on a loop of second order, critically damped,
/// follows them. Where statements tell their own steps, these count what was lost.
///
/// State: the last arrivals, and the rhythm.
class ArrivalRhythm {
public:
    /// Statements come in the order of their arrival. @param step own_step() since the one before
    /// @return when it would have come, ns of the same clock
    std::int64_t evened(std::int64_t received_ns, std::optional<Nanoseconds> step = std::nullopt);
    /// Between two statements; zero while it is not known.
    [[nodiscard]] double period_ns() const { return period_ns_; }

private:
    struct Arrival {
        std::int64_t received_ns = 0;
        double own_ns = 0;  // since the one before; zero: it does not tell
    };
    // Arrivals over their numbers on the grid.
    struct Grid {
        double period_ns = 0, at_last_ns = 0;  // the latter less the last arrival
    };

    std::int64_t begin(Arrival arrival);
    void learn();
    std::optional<Grid> told_grid();
    [[nodiscard]] std::optional<Grid> likeliest_grid() const;
    [[nodiscard]] double periods_since(const Arrival& arrival) const;

    std::deque<Arrival> arrivals_;
    std::int64_t evened_ns_ = 0;  // of the last of them
    double period_ns_ = 0;
    double lost_part_ = 0;      // of statements, those that came after lost ones
    double own_period_ns_ = 0;  // by the vehicle's own steps: differs where the source is not at real time
};

}  // namespace skyloop
