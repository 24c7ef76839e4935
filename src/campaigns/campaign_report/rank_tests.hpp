/// What one number tells of another, by ranks alone: units and shapes of distributions do not matter.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace skyloop {

/// The rank of each value among all, 1 … n; equal values share the mean of their ranks.
std::vector<double> average_ranks(std::span<const double> values);

/// Whether two series rise and fall together.
struct RankCorrelation {
    double rho = 0;      ///< −1 … 1
    double p_value = 1;  ///< how often series without a relation are as far from 0, 0 … 1
    std::size_t n = 0;
};

/// Spearman's rank correlation of pairs (C. Spearman, 1904), ties by average ranks, its p-value by Student's
/// distribution with n − 2 degrees of freedom (M. G. Kendall, "Rank Correlation Methods", section 5.14), which is rough
/// below ten pairs. Nothing for fewer than three pairs, series of different lengths or one that is constant.
std::optional<RankCorrelation> spearman_correlation(std::span<const double> x, std::span<const double> y);

/// Whether some group of values lies higher than another.
struct GroupTest {
    double h = 0;         ///< Kruskal and Wallis's statistic, corrected for ties
    double p_value = 1;   ///< how often groups of one law differ as much, 0 … 1
    double strength = 0;  ///< ε² = H / (n − 1): 0 none, 1 all of the differences of rank are between groups
    std::size_t groups = 0, n = 0;
};

/// The test of W. H. Kruskal and W. A. Wallis ("Use of ranks in one-criterion variance analysis", JASA 47, 1952), its
/// p-value by χ² with one degree of freedom fewer than groups. `group` gives the number of each value's group; groups
/// without a value do not count. Nothing for fewer than two groups, three values or where all values are equal.
std::optional<GroupTest> kruskal_wallis_test(std::span<const double> values, std::span<const std::size_t> group);

}  // namespace skyloop
