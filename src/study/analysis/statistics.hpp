/// Statistics of position errors: moments, radial errors, lagged products and the article's comparison figure.
/// How far two distributions are apart.
/// How errors hang together in time, gaps in the record included.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/core/result.hpp"
#include "base/geo/geodetic.hpp"
#include "study/analysis/fix_series.hpp"

namespace skyloop::inline study {

/// Distances between the distributions of two series, 0 (alike) … 1 (no value in common).
struct DistributionDistance {
    /// Half the sum of |share of A − share of B| over common bins. Of two finite samples of one law it is not zero:
    /// with n values and k filled bins each about √(k/(π·n)).
    double total_variation = 0;
    double bin_width = 0;  ///< of those bins, unit of the series; 0 where all values are equal
    std::size_t bins = 0;
    /// The largest difference of the empirical distribution functions (Kolmogorov–Smirnov).
    double kolmogorov_smirnov = 0;
};

/// Both distances of `a` and `b`, nothing when one is empty. The bins are those of Freedman and Diaconis (1981) for
/// both series together, as wide as the smaller one needs: 2·IQR·n^(−1/3), 2 to 500 of them; values far outside
/// (beyond ten interquartile ranges of the quartiles) share the bins at the ends.
std::optional<DistributionDistance> distribution_distance(std::span<const double> a, std::span<const double> b);

/// Figures of one series of numbers, in the unit of the series.
struct SampleStatistics {
    std::size_t n = 0;
    double mean = 0;
    double std = 0;  ///< sample standard deviation (n − 1); 0 for a single value
    double rms = 0;  ///< about zero
    double min = 0;
    double max = 0;
    double median = 0;  ///< of a horizontal radial error: the CEP
    double p95 = 0;     ///< 95 % of the values are not larger; linear between order statistics
};

/// Statistics of `values`; nothing for an empty series.
std::optional<SampleStatistics> sample_statistics(std::span<const double> values);

/// The quantile of `share` (0 … 1) of ascending values, linear between order statistics, as spreadsheets and numpy do.
/// Asks for at least one value.
double sorted_quantile(std::span<const double> sorted, double share);

/// What errors are measured from.
enum class ReferenceKind {
    truth,        ///< the true position of each sample, from the file itself
    given_point,  ///< one point that the user gave
    own_mean,     ///< the mean position of the series: biases do not show
};

/// Position errors of a series, one entry for each sample with a fix; metres in the local frame of the reference.
struct PositionErrors {
    ReferenceKind reference = ReferenceKind::own_mean;
    std::optional<Geodetic> point;  ///< of the reference; nothing with `truth`
    std::vector<double> east, north, up;
    std::vector<double> horizontal;  ///< radial, √(E² + N²)
    std::vector<double> spatial;     ///< radial, √(E² + N² + U²)
};

/// The errors of all fixes of `series`: about its truth where every fix has one, else about `point` when given, else
/// about the mean of the series itself.
PositionErrors position_errors(const FixSeries& series, const std::optional<Geodetic>& point = std::nullopt);

/// For each lag of 0 … max_lag, as far as there are values, the sum of the products of all values so many places apart.
std::vector<double> lagged_products(std::span<const double> values, std::size_t max_lag);

/// How far a candidate's error statistics are from a reference's (MODELS.md section 4, D-17):
/// D = 50 % · (|mean_c − mean_r| / |mean_r| + |std_c − std_r| / std_r).
struct ComparisonPercent {
    double difference = 0;        ///< D, percent
    double mean_part = 0;         ///< relative difference of the means, percent
    double std_part = 0;          ///< relative difference of the standard deviations, percent
    bool mean_near_zero = false;  ///< |mean_r| < std_r / 4: the relative difference of the means says nothing

    /// The article's agreement, 100 − D, percent; nothing where D is above 100: less than no agreement does not exist.
    [[nodiscard]] std::optional<double> agreement() const;
    /// "difference 31.5 %, agreement 68.5 %"; without an agreement "difference 314.2 %".
    [[nodiscard]] std::string text() const;
};

/// Mean and standard deviation of errors that are smaller are what rounding has left of zero, metres: in double
/// precision a coordinate on the Earth is known to a nanometre.
inline constexpr double rounding_dust_m = 1e-6;

/// Of errors in metres. Nothing when the reference's mean or standard deviation is zero, rounding_dust_m included, or
/// the candidate is empty.
std::optional<ComparisonPercent> comparison_percent(const SampleStatistics& candidate,
                                                    const SampleStatistics& reference);

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

}  // namespace skyloop::inline study
