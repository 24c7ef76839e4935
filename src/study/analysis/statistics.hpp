/// Statistics of position errors: moments, radial errors, lagged products and the article's comparison figure.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "base/core/result.hpp"
#include "base/geo/geodetic.hpp"
#include "study/analysis/fix_series.hpp"

namespace skyloop {

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
    double difference = 0;        ///< D, percent; the article's agreement is 100 − D
    double mean_part = 0;         ///< relative difference of the means, percent
    double std_part = 0;          ///< relative difference of the standard deviations, percent
    bool mean_near_zero = false;  ///< |mean_r| < std_r / 4: the relative difference of the means says nothing
};

/// Mean and standard deviation of errors that are smaller are what rounding has left of zero, metres: in double
/// precision a coordinate on the Earth is known to a nanometre.
inline constexpr double rounding_dust_m = 1e-6;

/// Of errors in metres. Nothing when the reference's mean or standard deviation is zero, rounding_dust_m included, or
/// the candidate is empty.
std::optional<ComparisonPercent> comparison_percent(const SampleStatistics& candidate,
                                                    const SampleStatistics& reference);

}  // namespace skyloop
