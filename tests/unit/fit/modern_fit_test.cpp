#include "campaigns/fit/modern_fit.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "run/scenario/scenario_file.hpp"
#include "support/run_parts.hpp"

namespace skyloop {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

constexpr std::size_t multipath = 2;

FitConditions seven_minutes(std::uint64_t seed = 1) {
    return {Geodetic::degrees(36.970631, -121.904695, 6.7), to_gps_time(1727, 384180.0), Seconds(420), {}, seed};
}

FitReceiver gps_alone() {
    FitReceiver receiver;
    receiver.constellations = {"gps"};
    return receiver;
}

TEST(ModernScenario, IsReadAsItWasMeant) {
    ModernFitSettings settings;
    settings.surroundings = Surroundings::residential;
    settings.weaker = Decibels(3);
    settings.scales = {1, 1.5, 2, 1, 0.25};
    FitReceiver receiver = gps_alone();
    receiver.board = "ublox-6";
    const std::string text = modern_scenario(seven_minutes(), receiver, settings, "# Made by nobody.\n");
    EXPECT_THAT(text, Not(HasSubstr("signal_in_space")));
    const auto scenario = read_scenario(text, "fit.toml");
    ASSERT_TRUE(scenario) << scenario.error().message;
    ModernSettings modern = scenario->model.modern;
    EXPECT_EQ(modern.surroundings, Surroundings::residential);
    EXPECT_EQ(modern.propagation.link.implementation_loss.value(), 5.5);
    EXPECT_EQ(modern.propagation.ionosphere.scale, 1.5);
    EXPECT_EQ(modern.measurement.multipath.scale, 2);
    EXPECT_EQ(modern.propagation.channel.scale, 0.25);
    for (const std::string_view cause : fitted_causes) {
        const auto terms = error_terms(modern);
        EXPECT_TRUE(std::any_of(terms.begin(), terms.end(), [&](const auto& t) { return t.name == cause; })) << cause;
    }
}

// Figures of a hand-made course: a square wave of 1 m and 20 s, east.
TEST(FitFigures, AreThoseOfTheCourse) {
    ModernRun run;
    for (int second = 0; second < 400; ++second)
        run.enu.emplace_back(Eigen::Vector3d(second / 10 % 2 == 0 ? 1 : -1, 0, second % 2 == 0 ? 3 : 1));
    run.enu[7].reset();
    const FitFigures figures = run.figures(true);
    EXPECT_NEAR(figures.horizontal.deviation, 1, 0.01);
    EXPECT_NEAR(*figures.horizontal.correlation[0], -1, 0.01);
    EXPECT_NEAR(*figures.horizontal.correlation[1], 1, 0.01);
    EXPECT_NEAR(figures.vertical.deviation, 1, 0.01);
    EXPECT_NEAR(*figures.vertical.rms, std::sqrt(5.0), 0.01);
    EXPECT_FALSE(run.figures(false).vertical.rms);
    EXPECT_NEAR(size_ratio(figures, enlarged(figures, 3)), 3, 1e-9);
    for (const double distance : figure_distances(figures, figures))
        EXPECT_EQ(distance, 0);
    EXPECT_NEAR(figure_distances(enlarged(figures, 1.1), figures)[0], std::log(1.1) / 0.1, 1e-9);
}

// The receiver is the model with three times its multipath and other random numbers.
TEST(ModernFit, FindsTheCauseThatWasEnlarged) {
    ModernFitSettings real;
    real.scales[multipath] = 3;
    const auto run = run_modern(seven_minutes(77), gps_alone(), real, test::emulator_data());
    ASSERT_TRUE(run) << run.error().message;
    FitTarget target;
    target.placed = true;
    target.figures = run->figures(true);
    target.signals = run->signals;
    target.satellites_used = run->satellites_used;
    const ModernFitRequest request{seven_minutes(), gps_alone(), Surroundings::open_sky};
    const auto fit = fit_modern(request, target, test::emulator_data());
    ASSERT_TRUE(fit) << fit.error().message;
    EXPECT_LT(fit->after.misfit, 0.6 * fit->before.misfit);
    EXPECT_GT(fit->after.settings.scales[multipath], 1.5);
    EXPECT_EQ(fit->after.settings.surroundings, Surroundings::open_sky);
    EXPECT_EQ(fit->after.settings.weaker.value(), 0) << "signals are as strong";
    // What is told of the fit is what its scenario does.
    const auto again = run_modern(seven_minutes(), gps_alone(), fit->after.settings, test::emulator_data());
    ASSERT_TRUE(again);
    EXPECT_EQ(again->errors(true).east, fit->after.runs.front().errors(true).east);
}

TEST(ModernFit, EndsWhereItIsStopped) {
    const std::atomic<bool> stop{true};
    const auto stopped =
        fit_modern({seven_minutes(), gps_alone(), Surroundings::open_sky}, {}, test::emulator_data(), {&stop, {}});
    ASSERT_FALSE(stopped);
    EXPECT_EQ(stopped.error().code, ErrorCode::outside);
}

}  // namespace
}  // namespace skyloop
