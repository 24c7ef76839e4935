/// How errors hang together in time, gaps in the record included.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "skyloop/analysis/fix_series.hpp"

namespace skyloop {

/// When the fixes of a series were made.
struct FixTimes {
    std::vector<double> at;  ///< one for each fix, from the first sample: seconds, or samples without an interval
    double step = 1;         ///< between samples, in the same unit
    bool in_seconds = false;
};

/// From the time stamps where every fix has one, else by counting samples with the interval of the series.
FixTimes fix_times(const FixSeries& series);

/// The lags that a comparison tells, in the unit of FixTimes.
inline constexpr std::array correlation_lags{1.0, 10.0, 60.0, 300.0, 900.0};

/// The autocorrelation at one lag.
struct LaggedCorrelation {
    double value = 0;
    std::size_t pairs = 0;
};

/// The times and errors of one series, ready for any lag. Values are taken about their mean.
class TimeCorrelation {
public:
    /// @param values one for each of `times.at`
    TimeCorrelation(const FixTimes& times, std::span<const double> values);

    /// The mean product of all pairs whose difference in time is `lag` within half a step, over the variance. Nothing
    /// when the lag is shorter than half a step, fewer than a quarter of the values have a partner, or the values are
    /// constant.
    [[nodiscard]] std::optional<LaggedCorrelation> at_lag(double lag) const;

    /// True where neighbours in time are not one step apart within half a step.
    [[nodiscard]] bool has_gaps() const;

    /// The lag at which the correlation first falls to 1/e, interpolated; nothing when it does not within half of the
    /// series. Lags are tried in steps that grow to a 32nd of the lag.
    [[nodiscard]] std::optional<double> time_to_1_e() const;

    /// The standard deviation of the differences of neighbours one step apart, over √2: the error of an epoch that its
    /// neighbour does not share. Nothing for fewer than two such differences.
    [[nodiscard]] std::optional<double> epoch_noise() const;

private:
    struct Point {
        double time = 0, value = 0;
    };
    std::vector<Point> points_;  // ascending in time
    double step_ = 1;
    double variance_ = 0;  // divisor n
};

}  // namespace skyloop
