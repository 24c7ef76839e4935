#include "study/analysis/statistics.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

#include "base/geo/local_frame.hpp"
#include "support/oracle_table.hpp"

namespace skyloop {
namespace {

std::vector<double> numbers_of(const std::string& text) {
    std::istringstream in(text);
    std::vector<double> values;
    for (double v = 0; in >> v;)
        values.push_back(v);
    return values;
}

FixSeries offsets(const Geodetic& origin, const std::vector<Eigen::Vector3d>& enu, bool with_truth) {
    const LocalFrame frame(origin);
    FixSeries series;
    series.name = "offsets";
    for (const Eigen::Vector3d& p : enu) {
        FixSample sample{std::nullopt, true, to_geodetic(frame.to_ecef(Position<Enu>(p))), std::nullopt};
        if (with_truth) sample.truth = origin;
        series.samples.push_back(sample);
    }
    return series;
}

const Geodetic odessa = Geodetic::degrees(46.4775, 30.7326, 77);

TEST(Statistics, agree_with_the_comparison_oracle_in_every_row) {
    for (const test::OracleRow& row : test::oracle_rows("comparison_metric.csv")) {
        const auto reference = sample_statistics(numbers_of(row.text("reference_series")));
        const auto candidate = sample_statistics(numbers_of(row.text("candidate_series")));
        ASSERT_TRUE(reference && candidate) << row.id();
        const double tolerance = row.number("tol");
        const auto near = [&](double value, const char* column) {
            EXPECT_NEAR(value, row.number(column), tolerance) << row.id() << " " << column;
        };
        near(reference->mean, "mean_ref");
        near(reference->std, "std_ref");
        near(candidate->mean, "mean_cand");
        near(candidate->std, "std_cand");
        const auto percent = comparison_percent(*candidate, *reference);
        ASSERT_TRUE(percent) << row.id();
        near(percent->difference, "difference_percent");
        EXPECT_NEAR(percent->difference, (percent->mean_part + percent->std_part) / 2, 1e-9);
    }
}

TEST(Statistics, of_a_small_series_are_those_computed_by_hand) {
    const auto s = sample_statistics(std::vector<double>{4, 1, 3, 2});
    ASSERT_TRUE(s);
    EXPECT_EQ(s->n, 4u);
    EXPECT_DOUBLE_EQ(s->mean, 2.5);
    EXPECT_DOUBLE_EQ(s->std, std::sqrt(5.0 / 3.0));
    EXPECT_DOUBLE_EQ(s->rms, std::sqrt(7.5));
    EXPECT_DOUBLE_EQ(s->min, 1);
    EXPECT_DOUBLE_EQ(s->max, 4);
    EXPECT_DOUBLE_EQ(s->median, 2.5);
    EXPECT_DOUBLE_EQ(s->p95, 3.85);
    EXPECT_FALSE(sample_statistics({}));
    EXPECT_EQ(sample_statistics(std::vector<double>{3})->std, 0);
}

TEST(Statistics, errors_are_about_the_truth_when_every_fix_has_one) {
    const FixSeries series = offsets(odessa, {{3, 4, 12}, {-3, -4, 0}}, true);
    const PositionErrors errors = position_errors(series, Geodetic::degrees(0, 0, 0));
    EXPECT_EQ(errors.reference, ReferenceKind::truth);
    EXPECT_FALSE(errors.point);
    ASSERT_EQ(errors.east.size(), 2u);
    EXPECT_NEAR(errors.east[0], 3, 1e-6);
    EXPECT_NEAR(errors.north[0], 4, 1e-6);
    EXPECT_NEAR(errors.up[0], 12, 1e-6);
    EXPECT_NEAR(errors.horizontal[0], 5, 1e-6);
    EXPECT_NEAR(errors.spatial[0], 13, 1e-6);
}

TEST(Statistics, errors_are_about_the_given_point_or_else_the_mean) {
    FixSeries series = offsets(odessa, {{1, 2, 3}, {3, 2, 1}, {99, 99, 99}}, false);
    series.samples[2].has_fix = false;
    const PositionErrors given = position_errors(series, odessa);
    EXPECT_EQ(given.reference, ReferenceKind::given_point);
    ASSERT_EQ(given.east.size(), 2u);
    EXPECT_NEAR(given.east[1], 3, 1e-6);
    const PositionErrors own = position_errors(series);
    EXPECT_EQ(own.reference, ReferenceKind::own_mean);
    ASSERT_TRUE(own.point);
    EXPECT_NEAR(own.east[0], -1, 1e-6);
    EXPECT_NEAR(own.east[1], 1, 1e-6);
    EXPECT_NEAR(own.up[0], 1, 1e-6);
    EXPECT_TRUE(position_errors(FixSeries{}).east.empty());
}

TEST(Statistics, the_own_mean_of_many_equal_fixes_is_where_they_are) {
    const FixSeries series = offsets(odessa, std::vector<Eigen::Vector3d>(200'000, {1, 2, 3}), false);
    const auto errors = sample_statistics(position_errors(series).spatial);
    ASSERT_TRUE(errors);
    EXPECT_LT(errors->max, rounding_dust_m / 100);
}

TEST(Statistics, lagged_products_equal_the_sums_over_pairs) {
    const std::vector<double> values{1, -4, 2, 5, 3, 8, 6};
    const std::vector<double> sums = lagged_products(values, 4);
    ASSERT_EQ(sums.size(), 5u);
    for (std::size_t lag = 0; lag < sums.size(); ++lag) {
        double sum = 0;
        for (std::size_t i = 0; i + lag < values.size(); ++i)
            sum += values[i] * values[i + lag];
        EXPECT_NEAR(sums[lag], sum, 1e-12) << lag;
    }
    EXPECT_EQ(lagged_products(values, 100).size(), values.size());
    EXPECT_TRUE(lagged_products({}, 2).empty());
}

TEST(Statistics, percentage_warns_of_a_signed_mean_near_zero_and_refuses_zero) {
    SampleStatistics reference;
    reference.n = 100;
    reference.mean = -0.2;
    reference.std = 1;
    SampleStatistics candidate = reference;
    candidate.mean = 0.1;
    candidate.std = 1.1;
    const auto near_zero = comparison_percent(candidate, reference);
    ASSERT_TRUE(near_zero);
    EXPECT_TRUE(near_zero->mean_near_zero);
    EXPECT_NEAR(near_zero->mean_part, 150, 1e-9);
    EXPECT_NEAR(near_zero->std_part, 10, 1e-9);
    EXPECT_NEAR(near_zero->difference, 80, 1e-9);
    reference.mean = -2;
    EXPECT_FALSE(comparison_percent(candidate, reference)->mean_near_zero);
    reference.mean = 0;
    EXPECT_FALSE(comparison_percent(candidate, reference));
    reference.mean = 3e-9;  // what rounding leaves of the mean about the own mean
    EXPECT_FALSE(comparison_percent(candidate, reference));
    reference.mean = 1;
    reference.std = 0;
    EXPECT_FALSE(comparison_percent(candidate, reference));
    reference.std = 3e-9;
    EXPECT_FALSE(comparison_percent(candidate, reference));
}

}  // namespace
}  // namespace skyloop
