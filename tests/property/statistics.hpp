/// What the properties of random series are judged by.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

namespace skyloop::test {

inline double mean(const std::vector<double>& series) {
    double sum = 0;
    for (const double value : series)
        sum += value;
    return sum / static_cast<double>(series.size());
}

/// Root mean square about zero.
inline double rms(const std::vector<double>& series) {
    double sum = 0;
    for (const double value : series)
        sum += value * value;
    return std::sqrt(sum / static_cast<double>(series.size()));
}

/// Correlation of the series with itself one step later.
inline double lag_one_autocorrelation(const std::vector<double>& series) {
    const double centre = mean(series);
    double products = 0, squares = 0;
    for (std::size_t i = 0; i < series.size(); ++i) {
        squares += (series[i] - centre) * (series[i] - centre);
        if (i > 0) products += (series[i] - centre) * (series[i - 1] - centre);
    }
    return products / squares;
}

inline double standard_normal_distribution(double x) { return 0.5 * std::erfc(-x / std::sqrt(2.0)); }

/// Probability that independent numbers of distribution function `distribution` differ from it at least as much as
/// `series` does: the Kolmogorov-Smirnov test with Stephens' correction for finite length (Press et al., Numerical
/// Recipes, 14.3).
template <class Distribution>
double kolmogorov_smirnov_p(std::vector<double> series, Distribution distribution) {
    std::sort(series.begin(), series.end());
    const auto n = static_cast<double>(series.size());
    double distance = 0;
    for (std::size_t i = 0; i < series.size(); ++i) {
        const double expected = distribution(series[i]);
        distance =
            std::max({distance, expected - static_cast<double>(i) / n, static_cast<double>(i + 1) / n - expected});
    }
    const double lambda = (std::sqrt(n) + 0.12 + 0.11 / std::sqrt(n)) * distance;
    double p = 0;
    for (int j = 1; j <= 100; ++j)
        p += (j % 2 == 1 ? 2 : -2) * std::exp(-2.0 * j * j * lambda * lambda);
    return std::clamp(p, 0.0, 1.0);
}

}  // namespace skyloop::test
