/// How errors hang together in time, gaps in the record included.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "study/analysis/fix_series.hpp"

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
///
/// At a lag that is asked for, the mean product of its pairs counts. The time of 1/e is that of the biased estimator of
/// time series (Box and Jenkins, Time Series Analysis, 2.1), which the few pairs of long lags do not lead astray: the
/// sum of the products of all pairs at a lag over the sum of all squares. Where rows are missing the sum is scaled to
/// that of the whole record: by the pairs that it would have over those that there are, and by the share of its rows
/// that there are.
class TimeCorrelation {
public:
    /// @param values one for each of `times.at`
    TimeCorrelation(const FixTimes& times, std::span<const double> values);

    /// The mean product of all pairs whose difference in time is `lag` within half a step, over the variance; at most 1
    /// either way, which the ends of a drift exceed. Nothing when the lag is shorter than half a step, fewer than a
    /// quarter of the values have a partner, or the values are constant.
    [[nodiscard]] std::optional<LaggedCorrelation> at_lag(double lag) const;

    /// True where neighbours in time are not one step apart within half a step.
    [[nodiscard]] bool has_gaps() const;

    /// The lag at which the correlation first falls to 1/e, interpolated, in the unit of the times; nothing when it
    /// does not within half as many steps as there are values, or fewer where the gaps are many and long. Neighbours
    /// one step apart within half a step count as one step apart; lags with too few pairs for at_lag() are passed over.
    [[nodiscard]] std::optional<double> time_to_1_e() const;

    /// The standard deviation of the differences of neighbours one step apart, over √2: the error of an epoch that its
    /// neighbour does not share. Nothing for fewer than two such differences.
    [[nodiscard]] std::optional<double> epoch_noise() const;

private:
    struct Point {
        double time = 0, value = 0;
    };
    [[nodiscard]] std::size_t steps_before(std::size_t i) const;
    [[nodiscard]] std::size_t places(std::size_t longest_lag) const;
    [[nodiscard]] std::size_t longest_lag() const;
    [[nodiscard]] std::vector<LaggedCorrelation> at_whole_steps() const;
    [[nodiscard]] bool enough(std::size_t pairs) const;
    [[nodiscard]] double biased(double products, std::size_t pairs, double lag_steps, double rows) const;

    std::vector<Point> points_;  // ascending in time
    double step_ = 1;
    double squares_ = 0;  // their sum; 0: the values are constant
};

}  // namespace skyloop
