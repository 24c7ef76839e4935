// Flights beyond the limits of receivers: who keeps its fix, and who loses it where.
#include <gtest/gtest.h>

#include "support/run_parts.hpp"

namespace skyloop {
namespace {

// What a receiver told of a flight.
struct FlightReport {
    double highest_with_fix = 0, fastest_with_fix = 0, highest = 0, fastest = 0;
    bool lost = false;  // after it had one
    bool has_fix_at_end = false;
};

FlightReport report_of(std::string_view flight, std::string_view receiver, double seconds, double step,
                       std::string_view board = "ublox-f9p") {
    const Scenario scenario = test::emulator_scenario(
        "[run]\nstart = 2024-03-05T12:00:00Z\n[model]\nname = \"ideal\"\n[trajectory]\nat = [28.5, -80.6, 3]\n" +
        std::string(flight) + "\n[[receiver]]\nboard = \"" + std::string(board) + "\"\n" + std::string(receiver));
    auto run = test::memory_run(scenario);
    FlightReport report;
    const std::atomic<bool> stop = false;
    bool had_fix = false;
    for (double t = step; t <= seconds; t += step) {
        run.emulator->run_until(advanced(run.start, Seconds(t)), stop);
        const firmware::NavigationState& state = run.emulator->receiver().state();
        const TruthState truth = run.emulator->simulation().truth_at(state.epoch.fix.time);
        const double height = truth.geodetic.height.above_ellipsoid.value(), speed = truth.velocity.vector().norm();
        // What goes on by the last velocity is no fix of its own.
        const bool fix = state.fix_ok && state.epoch.fix.type == FixType::fix_3d;
        report.highest = std::max(report.highest, height);
        report.fastest = std::max(report.fastest, speed);
        report.lost |= had_fix && !fix;
        had_fix |= fix;
        if (fix) report.highest_with_fix = std::max(report.highest_with_fix, height);
        if (fix) report.fastest_with_fix = std::max(report.fastest_with_fix, speed);
        report.has_fix_at_end = fix;
    }
    return report;
}

constexpr std::string_view balloon = "kind = \"balloon\"\npreset = \"balloon_32km\"";
constexpr std::string_view rocket = "kind = \"rocket\"\npreset = \"rocket_30km_M3\"";

TEST(ExportLimits, ABalloonKeepsItsFixWithAModelThatFlies) {
    const FlightReport report = report_of(balloon, "rate_hz = 0.1\ndynamic_model = \"airborne-1g\"", 9000, 10);
    EXPECT_GT(report.highest, 31900);
    EXPECT_GT(report.highest_with_fix, 31900);
    EXPECT_FALSE(report.lost);
    EXPECT_TRUE(report.has_fix_at_end);
}

TEST(ExportLimits, ABalloonLosesItWithTheUsualModelAndWithTwoRules) {
    const FlightReport portable = report_of(balloon, "rate_hz = 0.1", 9000, 10);
    EXPECT_TRUE(portable.lost);
    EXPECT_NEAR(portable.highest_with_fix, 12000, 200);
    EXPECT_TRUE(portable.has_fix_at_end) << "down again";
    const FlightReport two_rules =
        report_of(balloon, "rate_hz = 0.1\ndynamic_model = \"airborne-1g\"\nexport_limits = \"or\"", 6000, 10);
    EXPECT_NEAR(two_rules.highest_with_fix, 18288, 200);
    const FlightReport one_rule =
        report_of(balloon, "rate_hz = 0.1\ndynamic_model = \"airborne-1g\"\nexport_limits = \"and\"", 6400, 10);
    EXPECT_FALSE(one_rule.lost) << "high, and never fast";
}

TEST(ExportLimits, AnotherMakersBoardIsNotHeldToTheDynamicModelsOfUblox) {
    const FlightReport report = report_of(balloon, "rate_hz = 0.1", 6400, 10, "septentrio-sbf");
    EXPECT_GT(report.highest_with_fix, 31900);
    EXPECT_FALSE(report.lost);
    const FlightReport fast = report_of(rocket, "", 1500, 1, "septentrio-sbf");
    EXPECT_LT(fast.fastest_with_fix, 500) << "no more than any other";
}

TEST(ExportLimits, ARocketAtMachThreeLosesIt) {
    const FlightReport report = report_of(rocket, "dynamic_model = \"airborne-4g\"", 1500, 1);
    EXPECT_GT(report.fastest, 1020);
    EXPECT_TRUE(report.lost);
    EXPECT_LT(report.fastest_with_fix, 500);
    EXPECT_TRUE(report.has_fix_at_end);
    const FlightReport low =
        report_of("kind = \"rocket\"\npreset = \"rocket_1km\"", "dynamic_model = \"airborne-4g\"", 120, 1);
    EXPECT_FALSE(low.lost);
}

// The board reckons for 3 s where a fix is lost; one that limits withhold is not lost. A balloon that leaves 12 km.
TEST(ExportLimits, NothingIsReckonedBeyondThem) {
    for (const std::string model : {"ideal", "modern"}) {
        const Scenario scenario =
            test::emulator_scenario("[run]\nstart = 2024-03-05T12:00:00Z\n[model]\nname = \"" + model +
                                    "\"\n[trajectory]\nat = [28.5, -80.6, 11800]\n" + std::string(balloon) +
                                    "\n[[receiver]]\nboard = \"ublox-f9p\"\n");
        auto run = test::memory_run(scenario);
        const std::atomic<bool> stop = false;
        bool was_ok = false, was_beyond = false;
        for (int t = 1; t <= 120; ++t) {
            run.emulator->run_until(advanced(run.start, Seconds(t)), stop);
            const firmware::NavigationState& state = run.emulator->receiver().state();
            const TruthState truth = run.emulator->simulation().truth_at(state.epoch.fix.time);
            const bool beyond = truth.geodetic.height.above_ellipsoid > Metres(12'060);
            was_ok |= state.fix_ok;
            was_beyond |= beyond;
            EXPECT_FALSE(beyond && state.fix_ok) << model << " " << t;
            EXPECT_NE(state.epoch.fix.type, FixType::dead_reckoning) << model << " " << t;
        }
        EXPECT_TRUE(was_ok && was_beyond) << model;
    }
}

}  // namespace
}  // namespace skyloop
