/// How far two distributions are apart.
#pragma once

#include <cstddef>
#include <optional>
#include <span>

namespace skyloop {

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

}  // namespace skyloop
