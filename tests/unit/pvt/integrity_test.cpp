#include "receiver/pvt/integrity.hpp"

#include <gtest/gtest.h>

#include "base/core/random.hpp"
#include "synthetic_sky.hpp"

namespace skyloop {
namespace {

using test::sample_time;

std::vector<RangeEquation> perfect_equations(const NavigationSource& sky, const test::TrueReceiver& receiver) {
    const Observations observations = test::measure(sky, receiver);
    BroadcastTransmitters transmitters(sky);
    std::vector<RangeEquation> equations;
    for (const Observation& o : observations.signals)
        equations.push_back({o.satellite,
                             *transmitters.at(o.satellite, o.signal, observations.receive_time, *o.pseudorange),
                             *o.pseudorange, o.carrier, Metres(0), false});
    return equations;
}

TEST(ChiSquare, HasTheThresholdsOfTables) {
    EXPECT_NEAR(chi_square_threshold(1, 0.05), 3.841459, 1e-6);
    EXPECT_NEAR(chi_square_threshold(5, 0.01), 15.086272, 1e-6);
    EXPECT_NEAR(chi_square_threshold(10, 0.001), 29.588298, 1e-6);
    EXPECT_NEAR(chi_square_threshold(30, 0.5), 29.336032, 1e-6);
    // Two degrees: exp(−x/2).
    EXPECT_NEAR(chi_square_threshold(2, 1e-5), -2 * std::log(1e-5), 1e-8);
    EXPECT_NEAR(chi_square_threshold(2, std::exp(-3.0)), 6, 1e-13);
    // One degree: erfc(√(x/2)).
    EXPECT_NEAR(chi_square_threshold(1, std::erfc(0.5)), 0.5, 1e-14);
}

TEST(IntegrityMonitor, ExcludesFaultsOneByOne) {
    const auto sky = test::synthetic_sky(sample_time, test::four_systems);
    const auto receiver = test::receiver_at(Geodetic::degrees(46, 30, 80), sample_time);
    IntegrityMonitor monitor({});
    for (const std::size_t fault : {0U, 5U, 11U}) {
        auto equations = perfect_equations(sky, receiver);
        equations[fault].pseudorange += Metres(100);
        const auto one = monitor.solve(equations, {.time = sample_time});
        ASSERT_TRUE(one);
        ASSERT_EQ(one->excluded.size(), 1U);
        EXPECT_EQ(one->excluded[0], equations[fault].satellite);
        EXPECT_TRUE(one->test.consistent);
        EXPECT_FALSE(one->solution.ranges[fault].used);
        EXPECT_LT((one->solution.position.vector() - receiver.position).norm(), 1e-6);
        EXPECT_NEAR(one->solution.ranges[fault].residual.value(), 100, 1e-4);
    }
    auto equations = perfect_equations(sky, receiver);
    equations[1].pseudorange += Metres(100);
    equations[8].pseudorange -= Metres(150);
    equations[12].pseudorange += Metres(300);
    equations[15].pseudorange += Metres(250);
    auto copy = equations;
    const auto three = monitor.solve(equations, {.time = sample_time});
    ASSERT_TRUE(three);
    EXPECT_EQ(three->excluded.size(), 3U) << "the most that is allowed";
    EXPECT_FALSE(three->test.consistent);
    IntegrityMonitor off({.enabled = false});
    const auto all = off.solve(copy, {.time = sample_time});
    ASSERT_TRUE(all);
    EXPECT_TRUE(all->excluded.empty());
    EXPECT_GT((all->solution.position.vector() - receiver.position).norm(), 1);
}

TEST(IntegrityMonitor, LetsNoisePass) {
    const auto sky = test::synthetic_sky(sample_time, test::four_systems);
    const auto receiver = test::receiver_at(Geodetic::degrees(46, 30, 80), sample_time);
    const auto perfect = perfect_equations(sky, receiver);
    const auto clean = solve_single_point(perfect, {.time = sample_time});
    ASSERT_TRUE(clean);
    RandomStream noise(1, "integrity");
    IntegrityMonitor strict({.enabled = true, .false_alarm = 0.01, .most_exclusions = 0});
    IntegrityMonitor usual({});
    int alarms = 0;
    int exclusions = 0;
    constexpr int runs = 3000;
    for (int run = 0; run < runs; ++run) {
        auto equations = perfect;
        for (std::size_t i = 0; i < equations.size(); ++i)
            equations[i].pseudorange += Metres(std::sqrt(clean->ranges[i].variance) * noise.normal());
        SinglePointSetup setup{.time = sample_time};
        setup.start = clean->position;
        alarms += strict.solve(equations, setup)->test.consistent ? 0 : 1;
        exclusions += static_cast<int>(usual.solve(equations, setup)->excluded.size());
    }
    EXPECT_NEAR(alarms, 30, 20);
    EXPECT_LE(exclusions, 1);
}

TEST(IntegrityMonitor, TellsButDoesNotGuessWithOneRedundantRange) {
    const auto sky = test::synthetic_sky(sample_time, {Constellation::gps});
    const auto receiver = test::receiver_at(Geodetic::degrees(46, 30, 80), sample_time);
    auto equations = perfect_equations(sky, receiver);
    ASSERT_GE(equations.size(), 5U);
    equations.resize(5);
    equations[2].pseudorange += Metres(5000);
    IntegrityMonitor monitor({});
    const auto checked = monitor.solve(equations, {.time = sample_time});
    ASSERT_TRUE(checked);
    EXPECT_TRUE(checked->excluded.empty());
    EXPECT_FALSE(checked->test.consistent);
}

}  // namespace
}  // namespace skyloop
