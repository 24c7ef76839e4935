#include "campaigns/fit/baseline_fit.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>

#include "run/scenario/scenario_file.hpp"
#include "support/run_parts.hpp"

namespace skyloop {
namespace {

using ::testing::HasSubstr;

FitConditions half_an_hour() {
    return {Geodetic::degrees(36.970631, -121.904695, 6.7), to_gps_time(1727, 384180.0), Seconds(1800)};
}

BaselineRun run_with(const BaselineFractions& fractions, std::uint64_t seed = 1) {
    FitConditions conditions = half_an_hour();
    conditions.seed = seed;
    auto run = run_baseline(conditions, fractions, test::emulator_data());
    if (!run) throw std::runtime_error(run.error().message);
    return std::move(*run);
}

SampleStatistics figures_of(const std::vector<double>& errors) { return sample_statistics(errors).value(); }

double difference_of(const BaselineRun& run, const BaselineFractions& fractions, const SampleStatistics& real) {
    return comparison_percent(figures_of(run.horizontal_with(fractions)), real)->difference;
}

TEST(BaselineRun, tells_the_errors_with_other_fractions_as_a_run_with_them_has_them) {
    const BaselineRun calibrated = run_with(BaselineFractions::calibrated());
    ASSERT_EQ(calibrated.errors.horizontal.size(), 1800u);
    for (const BaselineFractions& other : {BaselineFractions{1, 1}, {0.2, 0.9}, {0, 2}, {3, 0}}) {
        const std::vector<double> run = run_with(other).errors.horizontal, told = calibrated.horizontal_with(other);
        for (std::size_t i = 0; i < run.size(); ++i)
            ASSERT_NEAR(told[i], run[i], 1e-6) << i;
    }
}

TEST(BaselineRun, says_why_there_is_none) {
    FitConditions conditions = half_an_hour();
    conditions.navigation = {std::filesystem::path(SKYLOOP_SOURCE_DIR) / "no" / "such.nav"};
    const auto absent = run_baseline(conditions, BaselineFractions::strict(), test::emulator_data());
    ASSERT_FALSE(absent);
    EXPECT_THAT(absent.error().message, HasSubstr("such.nav"));
    const std::atomic<bool> stop{true};
    const auto stopped = run_baseline(half_an_hour(), BaselineFractions::strict(), test::emulator_data(), {&stop, {}});
    ASSERT_FALSE(stopped);
    EXPECT_EQ(stopped.error().code, ErrorCode::outside);
}

TEST(BaselineRun, calls_back_after_each_epoch) {
    FitConditions conditions = half_an_hour();
    conditions.length = Seconds(20);
    int epochs = 0;
    ASSERT_TRUE(
        run_baseline(conditions, BaselineFractions::strict(), test::emulator_data(), {nullptr, [&] { ++epochs; }}));
    EXPECT_EQ(epochs, 20);
}

TEST(BaselineScenario, is_read_as_it_was_meant) {
    FitConditions conditions = half_an_hour();
    conditions.navigation = {"day.nav"};
    conditions.length = Seconds(1799.5);
    conditions.seed = 7;
    const std::string text = baseline_scenario(conditions, {0.812345678, 0.000123}, "# Made by nobody.\n");
    EXPECT_TRUE(text.starts_with("# Made by nobody.\n[run]\n"));
    const auto scenario = read_scenario(text, "elsewhere/fit.toml");
    ASSERT_TRUE(scenario) << scenario.error().message;
    EXPECT_EQ(scenario->run.start, conditions.start);
    EXPECT_EQ(scenario->run.duration->value(), 1800);
    EXPECT_EQ(scenario->run.seed, 7u);
    EXPECT_EQ(scenario->model.sensor_model, ErrorModelKind::baseline);
    EXPECT_EQ(scenario->model.baseline.iono_fraction, 0.812346);
    EXPECT_EQ(scenario->model.baseline.tropo_fraction, 0.000123);
    ASSERT_EQ(scenario->sky.navigation.size(), 1u);
    EXPECT_EQ(scenario->sky.navigation[0], std::filesystem::absolute("day.nav"));
    EXPECT_NEAR(std::get<FixedSettings>(scenario->trajectory).at.latitude.deg(), 36.970631, 1e-9);
}

// A receiver that is the model itself, with other fractions.
TEST(BaselineFit, finds_fractions_that_make_the_same_error) {
    const BaselineRun run = run_with(BaselineFractions::calibrated());
    for (const BaselineFractions& wanted : {BaselineFractions{0.9, 0.3}, {1.5, 0}, {0.05, 0.6}}) {
        const SampleStatistics real = figures_of(run.horizontal_with(wanted));
        const BaselineFit fit = fit_fractions(run, real);
        EXPECT_LT(fit.difference, 0.02);
        EXPECT_NEAR(fit.difference, difference_of(run, fit.fractions, real), 1e-9);
        EXPECT_FALSE(fit.at_limit);
    }
}

// As a receiver's that errs now a little and now a lot: no proportion makes its mean and deviation both.
TEST(BaselineFit, finds_nothing_that_a_search_by_hand_beats) {
    const BaselineRun run = run_with(BaselineFractions::calibrated());
    for (const auto& [mean, deviation] : {std::pair(2.79, 1.67), {2.8, 1.2}, {1.0, 1.5}, {30.0, 15.0}}) {
        SampleStatistics real;
        real.n = 3600, real.mean = mean, real.std = deviation;
        const BaselineFit fit = fit_fractions(run, real);
        for (double iono = 0; iono <= largest_fraction; iono += 0.25)
            for (double tropo = 0; tropo <= largest_fraction; tropo += 0.25)
                ASSERT_GT(difference_of(run, {iono, tropo}, real), fit.difference - 0.02) << iono << " " << tropo;
    }
}

TEST(BaselineFit, says_where_the_fractions_end) {
    const BaselineRun run = run_with(BaselineFractions::calibrated());
    SampleStatistics real;
    real.n = 3600, real.mean = 2000, real.std = 1000;
    const BaselineFit fit = fit_fractions(run, real);
    EXPECT_TRUE(fit.at_limit);
    EXPECT_EQ(std::max(fit.fractions.iono, fit.fractions.tropo), largest_fraction);
    EXPECT_LE(std::min(fit.fractions.iono, fit.fractions.tropo), largest_fraction);
    EXPECT_GT(fit.difference, 50);
}

// The proportion of 90° has a cosine that is not quite 0.
TEST(BaselineFit, leaves_out_what_is_no_part) {
    const BaselineRun run = run_with(BaselineFractions::calibrated());
    const BaselineFit fit = fit_fractions(run, figures_of(run.horizontal_with({0, 1})));
    EXPECT_NEAR(fit.fractions.tropo, 1, 1e-3);
    EXPECT_LT(fit.fractions.iono, 1e-3);
    SampleStatistics spread;  // further apart than the troposphere alone makes it
    spread.n = 3600, spread.mean = 2, spread.std = 3;
    const BaselineFit wide = fit_fractions(run, spread);
    EXPECT_TRUE(wide.fractions.iono == 0 || wide.fractions.iono > 1e-6) << wide.fractions.iono;
}

// Millimetres, as of carrier phases.
TEST(BaselineFit, fits_small_errors_too) {
    const BaselineRun run = run_with(BaselineFractions::calibrated());
    const SampleStatistics real = figures_of(run.horizontal_with({0.0009, 0.0002}));
    EXPECT_LT(fit_fractions(run, real).difference, 0.02);
}

TEST(BaselineFit, is_the_same_every_time) {
    const BaselineRun one = run_with(BaselineFractions::calibrated()), two = run_with(BaselineFractions::calibrated());
    EXPECT_EQ(one.errors.horizontal, two.errors.horizontal);
    SampleStatistics real;
    real.n = 3600, real.mean = 2.5, real.std = 1.3;
    EXPECT_EQ(fit_fractions(one, real).fractions.iono, fit_fractions(two, real).fractions.iono);
    EXPECT_NE(one.errors.horizontal, run_with(BaselineFractions::calibrated(), 2).errors.horizontal);
}

}  // namespace
}  // namespace skyloop
