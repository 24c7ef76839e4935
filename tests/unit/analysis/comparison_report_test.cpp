// What a comparison tells beside moments: signal strengths, satellites, distances, correlation; as text and as JSON.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "base/core/random.hpp"
#include "base/geo/local_frame.hpp"
#include "study/analysis/comparison.hpp"
#include "support/oracle_table.hpp"

namespace skyloop {
namespace {

using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using ::testing::Not;

// White errors of `sigma` metres about a known truth, once a second, with satellites.
FixSeries reported_series(const std::string& name, std::size_t n, double sigma, bool timed) {
    RandomStream random(11, name);
    const Geodetic place = Geodetic::degrees(46.4775, 30.7326, 77);
    const LocalFrame frame(place);
    FixSeries series;
    series.name = name;
    series.dated = timed;
    if (timed) series.interval = Seconds(1);
    for (std::size_t i = 0; i < n; ++i) {
        const Eigen::Vector3d enu(sigma * random.normal(), sigma * random.normal(), sigma * random.normal());
        FixSample sample{std::nullopt, true, to_geodetic(frame.to_ecef(Position<Enu>(enu))), place};
        if (timed) sample.time = to_gps_time(2000, static_cast<double>(i));
        sample.satellites_used = 8 + static_cast<int>(i % 2);
        sample.signals.push_back({Angle::degrees(35), DbHz(timed ? 40 : 43)});
        series.samples.push_back(sample);
    }
    return series;
}

TEST(ComparisonReport, statistics_hold_satellites_noise_and_correlation) {
    const auto s = series_statistics(reported_series("timed", 20000, 2, true));
    ASSERT_TRUE(s) << s.error().message;
    ASSERT_TRUE(s->satellites_used);
    EXPECT_DOUBLE_EQ(s->satellites_used->mean, 8.5);
    EXPECT_NEAR(s->satellites_used->std, 0.5, 1e-3);
    EXPECT_EQ(s->signal_strength.bin(3).n(), 20000u);
    // White noise: each epoch's noise is the whole of it, and no lag is correlated.
    EXPECT_NEAR(*s->of(ErrorQuantity::east).epoch_noise, s->of(ErrorQuantity::east).figures.std, 0.1);
    for (std::size_t i = 0; i < 4; ++i)
        EXPECT_NEAR(s->of(ErrorQuantity::up).lagged[i]->value, 0, 0.1) << i;
    // CEP and R95 of a circular normal law: 1.1774 and 2.4477 sigma.
    EXPECT_NEAR(s->cep(), 1.1774 * 2, 0.1);
    EXPECT_NEAR(s->r95(), 2.4477 * 2, 0.1);
}

TEST(ComparisonReport, text_has_a_table_of_each) {
    const auto c = compare(reported_series("sim", 2000, 2, true), reported_series("real", 1500, 3, false));
    ASSERT_TRUE(c) << c.error().message;
    const std::string text = comparison_text(*c);
    EXPECT_THAT(text, ContainsRegex("satellites used +mean \\+- std +8\\.5 \\+- 0\\.5 +8\\.5 \\+- 0\\.5 +0\\.0 %"));
    EXPECT_THAT(text, ContainsRegex("autocorrelation +at lag +1 +10 +60 +300 +900"));
    EXPECT_THAT(text, ContainsRegex("east +A, s +-?0\\.0"));
    EXPECT_THAT(text, HasSubstr("B, samples"));
    EXPECT_THAT(text, ContainsRegex("30 to 40 deg +40\\.0 \\+- 0\\.0 +2000 +43\\.0 \\+- 0\\.0 +1500 +-3\\.0"));
    EXPECT_THAT(text, ContainsRegex("total variation +Kolmogorov-Smirnov"));
    EXPECT_THAT(text, ContainsRegex("epoch to epoch +2\\.[0-9]+ m"));
    EXPECT_THAT(text, Not(HasSubstr("nan")));
    FixSeries bare = reported_series("bare", 100, 1, false);
    for (FixSample& sample : bare.samples) {
        sample.signals.clear();
        sample.satellites_used.reset();
    }
    const std::string without = comparison_text(*compare(bare, bare));
    EXPECT_THAT(without, Not(HasSubstr("C/N0")));
    EXPECT_THAT(without, Not(HasSubstr("satellites used")));
}

TEST(ComparisonReport, json_has_the_documented_keys) {
    const auto c = compare(reported_series("sim", 400, 2, true), reported_series("real", 500, 3, false));
    ASSERT_TRUE(c) << c.error().message;
    const auto json = nlohmann::json::parse(comparison_json(*c));
    EXPECT_DOUBLE_EQ(json.at("a").at("satellites_used").at("mean"), 8.5);
    EXPECT_EQ(json.at("a").at("cn0_by_elevation").at(0).at("from_deg"), 30);
    EXPECT_EQ(json.at("b").at("cn0_by_elevation").at(0).at("mean_dbhz"), 43);
    EXPECT_EQ(json.at("a").at("cep_m"), json.at("a").at("errors").at("horizontal").at("median_m"));
    EXPECT_EQ(json.at("a").at("r95_m"), json.at("a").at("errors").at("horizontal").at("p95_m"));
    const auto& lags = json.at("a").at("errors").at("east").at("autocorrelation");
    EXPECT_EQ(lags.size(), correlation_lags.size());
    EXPECT_EQ(lags.at(2).at("lag_s"), 60);
    EXPECT_EQ(lags.at(2).at("pairs"), 340);
    EXPECT_TRUE(lags.at(4).at("value").is_null());
    EXPECT_EQ(json.at("b").at("errors").at("east").at("autocorrelation").at(0).at("lag_samples"), 1);
    EXPECT_GT(json.at("a").at("errors").at("up").at("epoch_noise_m"), 1.8);
    const auto& distance = json.at("distribution_distance").at("3d");
    EXPECT_GT(distance.at("total_variation"), 0.2);
    EXPECT_GT(distance.at("kolmogorov_smirnov"), 0.2);
    EXPECT_GT(distance.at("bin_width_m"), 0);
}

TEST(ComparisonReport, without_truth_errors_are_about_the_own_mean) {
    const FixSeries series = reported_series("sim", 100, 2, true);
    EXPECT_EQ(series_statistics(series)->reference, ReferenceKind::truth);
    const auto own = series_statistics(without_truth(series));
    EXPECT_EQ(own->reference, ReferenceKind::own_mean);
    EXPECT_NEAR(own->of(ErrorQuantity::east).figures.mean, 0, 1e-6);
}

// MEASURED.md: own fixes of a garden M8P and of an F9T, standard deviations about the own mean, satellites, and the
// M8P's autocorrelation of north.
TEST(ComparisonReport, of_real_ubx_logs_gives_the_measured_figures) {
    SKYLOOP_REQUIRE_SHARED(folder, "receivers");
    const auto garden = read_fix_series(folder / "galway_20181015_m8p_static/base-20181015-1654.ubx.gz");
    const auto f9t = read_fix_series(folder / "bend_f9t/F9T-L2-5min.ubx.gz");
    ASSERT_TRUE(garden && f9t);
    const auto c = compare(*garden, *f9t);
    ASSERT_TRUE(c) << c.error().message;
    EXPECT_NEAR(c->a.of(ErrorQuantity::east).figures.std, 0.70, 0.006);
    EXPECT_NEAR(c->a.of(ErrorQuantity::north).figures.std, 2.35, 0.006);
    EXPECT_NEAR(c->a.of(ErrorQuantity::up).figures.std, 3.15, 0.006);
    EXPECT_NEAR(c->a.satellites_used->mean, 14.7, 0.06);
    EXPECT_NEAR(c->a.satellites_used->std, 0.8, 0.06);
    const std::array north{1.00, 1.00, 0.95, 0.70, 0.06};
    for (std::size_t i = 0; i < north.size(); ++i)
        EXPECT_NEAR(c->a.of(ErrorQuantity::north).lagged[i]->value, north[i], 0.006) << correlation_lags[i];
    EXPECT_NEAR(c->b.of(ErrorQuantity::east).figures.std, 0.20, 0.006);
    EXPECT_NEAR(c->b.of(ErrorQuantity::north).figures.std, 0.24, 0.006);
    EXPECT_NEAR(c->b.of(ErrorQuantity::up).figures.std, 0.60, 0.006);
    EXPECT_NEAR(c->b.satellites_used->mean, 25.4, 0.06);
}

// MEASURED.md: 552 fixes of 582 s behind an attenuator, cold start included; it prints 1.34 1.31 2.37 m.
TEST(ComparisonReport, of_a_real_cold_start_gives_the_measured_figures) {
    SKYLOOP_REQUIRE_SHARED(log, "receivers/besancon_20250425_ublox/16dBatt_no_interference_coldstart.ubx.gz");
    const auto series = read_fix_series(log);
    ASSERT_TRUE(series) << series.error().message;
    EXPECT_EQ(series->samples.size(), 582u);
    const auto s = series_statistics(*series);
    ASSERT_TRUE(s) << s.error().message;
    EXPECT_EQ(s->fixes, 552u);
    EXPECT_NEAR(s->of(ErrorQuantity::east).figures.std, 1.34, 0.01);
    EXPECT_NEAR(s->of(ErrorQuantity::north).figures.std, 1.31, 0.01);
    EXPECT_NEAR(s->of(ErrorQuantity::up).figures.std, 2.37, 0.01);
    EXPECT_NEAR(s->satellites_used->mean, 18.1, 0.06);
    EXPECT_NEAR(s->signal_strength.bin(2).mean(), 40.0, 0.06);
}

}  // namespace
}  // namespace skyloop
