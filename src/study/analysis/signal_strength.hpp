/// Carrier-to-noise-density ratios by elevation, summed up as they are read.
#pragma once

#include <array>
#include <cstddef>

#include "base/core/units.hpp"

namespace skyloop {

/// Count, mean and standard deviation of numbers that are not kept (Welford 1962).
class RunningStatistics {
public:
    void add(double value);
    [[nodiscard]] std::size_t n() const { return n_; }
    [[nodiscard]] double mean() const { return mean_; }
    /// Sample standard deviation (n − 1); 0 for fewer than two values.
    [[nodiscard]] double std() const;

private:
    std::size_t n_ = 0;
    double mean_ = 0, squares_ = 0;
};

/// What is told of one satellite at one time.
struct SignalReport {
    Angle elevation;
    DbHz cn0;
};

/// C/N0 of tracked satellites in bins of ten degrees of elevation, dB-Hz.
class SignalStrengthByElevation {
public:
    static constexpr std::size_t bins = 9;
    static constexpr double bin_width_deg = 10;

    /// Counts one report of one satellite. Elevations outside 0 … 90° and C/N0 of zero or less (not tracked) are left
    /// out.
    void add(const SignalReport& report);
    /// The bin from 10·i to 10·(i + 1) degrees; the last one includes 90°.
    [[nodiscard]] const RunningStatistics& bin(std::size_t i) const { return bins_[i]; }
    [[nodiscard]] bool empty() const;

private:
    std::array<RunningStatistics, bins> bins_;
};

}  // namespace skyloop
