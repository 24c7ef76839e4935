#include "campaigns/campaign_report/rank_tests.hpp"

#include <algorithm>
#include <boost/math/special_functions/beta.hpp>
#include <boost/math/special_functions/gamma.hpp>
#include <cmath>
#include <map>
#include <numeric>

namespace skyloop {
namespace {

using RankTestPolicy = boost::math::policies::policy<boost::math::policies::promote_double<false>>;

// Two-sided p-value of Student's t with `freedom` degrees of freedom (Abramowitz and Stegun 26.7.1, 26.5.27).
double student_p_value(double t, double freedom) {
    return boost::math::ibeta(freedom / 2, 0.5, freedom / (freedom + t * t), RankTestPolicy());
}

// P(χ² > h) (Abramowitz and Stegun 26.4.19).
double chi_squared_p_value(double h, double freedom) {
    return boost::math::gamma_q(freedom / 2, std::max(h, 0.0) / 2, RankTestPolicy());
}

struct RankSum {
    double sum = 0;
    std::size_t n = 0;
};

}  // namespace

std::vector<double> average_ranks(std::span<const double> values) {
    std::vector<std::size_t> order(values.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return values[a] < values[b]; });
    std::vector<double> ranks(values.size());
    for (std::size_t first = 0, last = 0; first < order.size(); first = last) {
        while (last < order.size() && values[order[last]] == values[order[first]])
            ++last;
        for (std::size_t i = first; i < last; ++i)
            ranks[order[i]] = static_cast<double>(first + 1 + last) / 2;
    }
    return ranks;
}

std::optional<RankCorrelation> spearman_correlation(std::span<const double> x, std::span<const double> y) {
    if (x.size() != y.size() || x.size() < 3) return std::nullopt;
    const std::vector<double> rank_x = average_ranks(x);
    const std::vector<double> rank_y = average_ranks(y);
    const double mean = static_cast<double>(x.size() + 1) / 2;
    double xx = 0, yy = 0, xy = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
        xx += (rank_x[i] - mean) * (rank_x[i] - mean);
        yy += (rank_y[i] - mean) * (rank_y[i] - mean);
        xy += (rank_x[i] - mean) * (rank_y[i] - mean);
    }
    if (xx == 0 || yy == 0) return std::nullopt;
    RankCorrelation result{std::clamp(xy / std::sqrt(xx * yy), -1.0, 1.0), 0, x.size()};
    const auto freedom = static_cast<double>(x.size() - 2);
    const double rest = 1 - result.rho * result.rho;
    if (rest > 0) result.p_value = student_p_value(result.rho * std::sqrt(freedom / rest), freedom);
    return result;
}

std::optional<GroupTest> kruskal_wallis_test(std::span<const double> values, std::span<const std::size_t> group) {
    if (values.size() != group.size() || values.size() < 3) return std::nullopt;
    const std::vector<double> ranks = average_ranks(values);
    const auto n = static_cast<double>(values.size());
    std::map<std::size_t, RankSum> sums;
    double spread = 0;  // of the ranks about their mean, which ties make smaller
    for (std::size_t i = 0; i < values.size(); ++i) {
        RankSum& of_group = sums[group[i]];
        of_group.sum += ranks[i] - (n + 1) / 2;
        ++of_group.n;
        spread += (ranks[i] - (n + 1) / 2) * (ranks[i] - (n + 1) / 2);
    }
    if (sums.size() < 2 || spread == 0) return std::nullopt;
    double between = 0;
    for (const auto& [number, of_group] : sums)
        between += of_group.sum * of_group.sum / static_cast<double>(of_group.n);
    // The share of the spread that lies between the groups, times n − 1: the corrected H of the paper's section 3.
    GroupTest test{(n - 1) * between / spread, 1, between / spread, sums.size(), values.size()};
    test.p_value = chi_squared_p_value(test.h, static_cast<double>(sums.size() - 1));
    return test;
}

}  // namespace skyloop
