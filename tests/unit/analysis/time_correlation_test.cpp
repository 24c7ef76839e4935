#include "study/analysis/statistics.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "base/core/random.hpp"
#include "study/analysis/comparison.hpp"
#include "support/oracle_table.hpp"

namespace skyloop {
namespace {

// A first-order Gauss-Markov series of unit variance, one value a second, 1/e after `tau` seconds.
std::vector<double> correlated_series(std::size_t n, double tau) {
    RandomStream random(5, "time correlation");
    const double phi = std::exp(-1 / tau);
    std::vector<double> values;
    double v = random.normal();
    for (std::size_t i = 0; i < n; ++i) {
        values.push_back(v);
        v = phi * v + std::sqrt(1 - phi * phi) * random.normal();
    }
    return values;
}

FixTimes every_second(std::size_t n) {
    FixTimes times{{}, 1, true};
    for (std::size_t i = 0; i < n; ++i)
        times.at.push_back(static_cast<double>(i));
    return times;
}

TEST(TimeCorrelation, is_the_mean_product_of_pairs_over_the_variance) {
    const std::vector<double> values{1, 4, 2, 5, 3};  // mean 3, deviations -2 1 -1 2 0
    const TimeCorrelation r(every_second(5), values);
    ASSERT_TRUE(r.at_lag(1));
    EXPECT_DOUBLE_EQ(r.at_lag(1)->value, (-2.0 - 1 - 2 + 0) / 4 / 2);
    EXPECT_EQ(r.at_lag(1)->pairs, 4u);
    EXPECT_DOUBLE_EQ(r.at_lag(2)->value, (2.0 + 2 + 0) / 3 / 2);
    EXPECT_FALSE(r.at_lag(4));    // one pair of five values
    EXPECT_FALSE(r.at_lag(0.5));  // a value with itself
    const TimeCorrelation constant(every_second(3), std::vector<double>{0.1, 0.1, 0.1});
    EXPECT_FALSE(constant.at_lag(1) || constant.time_to_1_e());
    EXPECT_FALSE(TimeCorrelation({}, {}).at_lag(1));
    EXPECT_FALSE(TimeCorrelation({}, {}).time_to_1_e());
}

TEST(TimeCorrelation, pairs_by_time_across_gaps_and_in_any_order) {
    FixTimes times{{0, 1, 2, 10, 11.2, 12}, 1, true};
    std::vector<double> values{1, -1, 2, -2, 1, -1};
    const TimeCorrelation r(times, values);
    EXPECT_TRUE(r.has_gaps());
    EXPECT_EQ(r.at_lag(1)->pairs, 4u);
    EXPECT_NEAR(r.at_lag(1)->value, (-1.0 - 2 - 2 - 1) / 4 / 2, 1e-12);
    EXPECT_EQ(r.at_lag(10)->pairs, 3u);
    EXPECT_NEAR(r.at_lag(10)->value, (-2.0 - 1 - 2) / 3 / 2, 1e-12);
    std::swap(times.at[0], times.at[4]);
    std::swap(values[0], values[4]);
    EXPECT_NEAR(TimeCorrelation(times, values).at_lag(10)->value, r.at_lag(10)->value, 1e-12);
}

TEST(TimeCorrelation, gaps_do_not_change_what_is_found) {
    constexpr std::size_t n = 60000;
    const std::vector<double> values = correlated_series(n, 20);
    FixTimes times{{}, 1, true};
    std::vector<double> kept;
    for (std::size_t i = 0; i < n; ++i)
        if (i % 100 < 60) {  // 40 s are missing of every 100
            times.at.push_back(static_cast<double>(i));
            kept.push_back(values[i]);
        }
    const TimeCorrelation holes(times, kept);
    const TimeCorrelation whole(every_second(n), values);
    EXPECT_FALSE(whole.has_gaps());
    EXPECT_NEAR(holes.at_lag(10)->value, std::exp(-0.5), 0.05);
    EXPECT_NEAR(whole.at_lag(10)->value, std::exp(-0.5), 0.05);
    ASSERT_TRUE(holes.time_to_1_e() && whole.time_to_1_e());
    EXPECT_NEAR(*holes.time_to_1_e(), 20, 2);
    EXPECT_NEAR(*whole.time_to_1_e(), 20, 3);
    // Differences of neighbours: std of sqrt(2 (1 - phi)), over sqrt 2.
    EXPECT_NEAR(*holes.epoch_noise(), std::sqrt(1 - std::exp(-1.0 / 20)), 0.01);
}

// The biased one, from the means over pairs, a lag after another: of `rows` with `n` values.
TEST(TimeCorrelation, time_to_1_e_is_that_of_the_biased_estimator) {
    for (const bool gaps : {false, true}) {
        FixTimes times{{}, 0.5, true};
        std::vector<double> values;
        const std::vector<double> all = correlated_series(500, 30);
        for (std::size_t i = 0; i < all.size(); ++i) {
            if (gaps && (i % 50 < 4 || i == 123)) continue;
            times.at.push_back(0.5 * static_cast<double>(i));
            values.push_back(all[i]);
        }
        const TimeCorrelation r(times, values);
        EXPECT_EQ(r.has_gaps(), gaps);
        const auto time = r.time_to_1_e();
        ASSERT_TRUE(time);
        const double below = 0.5 * std::floor(*time / 0.5), above = below + 0.5;
        const double rows = times.at.back() / 0.5 - times.at.front() / 0.5 + 1;
        const auto biased = [&](double lag) { return lag > 0 ? r.at_lag(lag)->value * (1 - lag / 0.5 / rows) : 1; };
        const double before = biased(below), after = biased(above);
        EXPECT_NEAR(before + (after - before) * (*time - below) / 0.5, 1 / std::numbers::e, 1e-9) << gaps;
    }
}

TEST(TimeCorrelation, white_noise_is_below_1_e_within_a_step) {
    const TimeCorrelation white(every_second(5000), correlated_series(5000, 1e-3));
    ASSERT_TRUE(white.time_to_1_e());
    EXPECT_NEAR(*white.time_to_1_e(), 1 - 1 / std::numbers::e, 0.05);
}

// A straight drift, and what one missing row of it, its middle, may change.
TEST(TimeCorrelation, of_a_drift_keeps_within_its_bounds_and_hardly_feels_a_missing_row) {
    constexpr std::size_t n = 1001;
    FixTimes times = every_second(n);
    std::vector<double> values = times.at;
    const TimeCorrelation whole(times, values);
    times.at.erase(times.at.begin() + n / 2);
    values.erase(values.begin() + n / 2);
    const TimeCorrelation holed(times, values);
    EXPECT_TRUE(holed.has_gaps() && !whole.has_gaps());
    ASSERT_TRUE(whole.time_to_1_e() && holed.time_to_1_e());
    EXPECT_NEAR(*whole.time_to_1_e(), 217.7, 0.5);
    EXPECT_NEAR(*holed.time_to_1_e(), *whole.time_to_1_e(), 0.5);
    for (const double lag : {1.0, 300.0, 600.0, 740.0}) {
        // The biased one of many values is 1 - 3 u + 2 u^3, which 1 - u divides.
        const double u = lag / n;
        EXPECT_NEAR(whole.at_lag(lag)->value, std::max(-1.0, 1 - 2 * u - 2 * u * u), 0.01) << lag;
        EXPECT_NEAR(holed.at_lag(lag)->value, whole.at_lag(lag)->value, 0.01) << lag;
    }
}

// The two pairs of neighbours that there are hold all of the variance.
TEST(TimeCorrelation, is_never_beyond_one) {
    const FixTimes times{{0, 1, 3, 5, 7, 9, 11, 12}, 1, true};
    const TimeCorrelation r(times, std::vector<double>{1, 1, 0, 0, 0, 0, -1, -1});
    ASSERT_TRUE(r.at_lag(1));
    EXPECT_EQ(r.at_lag(1)->value, 1);
}

// Minutes of records, months apart: what lies between takes no memory.
TEST(TimeCorrelation, long_pauses_are_bearable) {
    const std::vector<double> values = correlated_series(60 * 200, 5);
    FixTimes times{{}, 1, true};
    for (std::size_t i = 0; i < values.size(); ++i)
        times.at.push_back(static_cast<double>(i % 60) + 1e7 * static_cast<double>(i / 60));
    const auto time = TimeCorrelation(times, values).time_to_1_e();
    ASSERT_TRUE(time);
    EXPECT_NEAR(*time, 5, 1);
}

TEST(TimeCorrelation, times_are_stamps_or_counted_samples) {
    FixSeries series;
    for (int i = 0; i < 4; ++i) {
        FixSample sample;
        sample.has_fix = i != 1;
        sample.time = to_gps_time(2000, 5.0 + 0.5 * i + (i == 3 ? 10 : 0));
        series.samples.push_back(sample);
    }
    EXPECT_EQ(fix_times(series).at, (std::vector<double>{0, 2, 3}));
    EXPECT_FALSE(fix_times(series).in_seconds);
    series.interval = Seconds(0.5);
    EXPECT_EQ(fix_times(series).at, (std::vector<double>{0, 1, 11.5}));
    EXPECT_TRUE(fix_times(series).in_seconds);
    series.samples[0].time.reset();
    EXPECT_EQ(fix_times(series).at, (std::vector<double>{0, 1, 1.5}));
}

// MEASURED.md, "Time correlation of the position error": the 2 Hz series over its whole length, lags in seconds. The
// printed values have two digits and an estimator that the document does not name; ours agrees within 0.01.
TEST(TimeCorrelation, of_a_real_lea6_is_the_measured_one) {
    SKYLOOP_REQUIRE_SHARED(folder, "receivers/aptos_20130214_lea6");
    auto series = read_fix_series(folder / "2013.02.14-024312_ublox1_geodetic.dlm");
    ASSERT_TRUE(series) << series.error().message;
    series->interval = Seconds(0.5);
    const auto statistics = series_statistics(*series);
    ASSERT_TRUE(statistics) << statistics.error().message;
    const std::array east{1.00, 0.97, 0.69, 0.14, -0.08};
    const std::array up{1.00, 0.97, 0.64, -0.03, 0.14};
    for (std::size_t i = 0; i < east.size(); ++i) {
        EXPECT_NEAR(statistics->of(ErrorQuantity::east).lagged[i]->value, east[i], 0.01) << correlation_lags[i];
        EXPECT_NEAR(statistics->of(ErrorQuantity::up).lagged[i]->value, up[i], 0.01) << correlation_lags[i];
    }
}

}  // namespace
}  // namespace skyloop
