// What surroundings write into what arrives.
#include "world/propagation/surroundings_effect.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "modern_sky.hpp"

namespace {

using namespace skyloop;

ChannelParameters effect_parameters() {
    ChannelParameters parameters;
    parameters.environment = P681Environment::urban;
    parameters.bad_odds = 4;
    return parameters;
}

Geodetic place_north(double metres) {
    Geodetic place = test::odessa_place;
    place.latitude = place.latitude + Angle::radians(metres / 6371000);
    return place;
}

Arrivals surrounded(SurroundingsEffect& effect, const SkyView& sky, double metres, std::chrono::milliseconds after) {
    return test::after(effect, sky, test::truth_of(place_north(metres), test::april_noon + after));
}

TEST(SurroundingsEffect, IsTheSameAtTenHertzAsAtOneAndWithOtherSatellites) {
    SurroundingsEffect once(effect_parameters(), {}, 9), often(effect_parameters(), {}, 9);
    SkyView all = test::gps_ring(8, 30), alone = all;
    alone.satellites.resize(1);
    for (int tenth = 0; tenth <= 50; ++tenth) {
        const auto after = std::chrono::milliseconds(100 * tenth);
        const Arrival of_all = surrounded(often, all, tenth, after).satellites[0];
        if (tenth % 10 != 0) continue;
        const Arrival lonely = surrounded(once, alone, tenth, after).satellites[0];
        EXPECT_EQ(of_all.shadowing_loss, lonely.shadowing_loss);
        EXPECT_EQ(of_all.excess_path, lonely.excess_path);
        ASSERT_EQ(of_all.echoes.size(), lonely.echoes.size());
        for (std::size_t i = 0; i < lonely.echoes.size(); ++i)
            EXPECT_EQ(of_all.echoes[i].amplitude, lonely.echoes[i].amplitude);
    }
}

// Without the direct ray an echo is tracked: it is late, and it keeps its delay over metres.
TEST(SurroundingsEffect, TracksAnEchoThatOutdoesTheDirectRay) {
    SurroundingsEffect effect(effect_parameters(), {}, 9);
    const SkyView sky = test::gps_ring(12, 15);
    int late = 0, weak_in_sight = 0, pairs = 0, held = 0;
    double before = 0;
    for (int metre = 0; metre < 400; ++metre) {
        const Arrivals arrivals = surrounded(effect, sky, metre, std::chrono::milliseconds(0));
        for (const Arrival& arrival : arrivals.satellites) {
            EXPECT_EQ(arrival.line_of_sight, arrival.excess_path == Metres(0));
            EXPECT_GE(arrival.excess_path, Metres(0));
            EXPECT_GE(arrival.paths, 1);
            late += arrival.line_of_sight ? 0 : 1;
            weak_in_sight += arrival.line_of_sight && arrival.shadowing_loss > Decibels(8) ? 1 : 0;
        }
        const double excess = arrivals.satellites[0].excess_path.value();
        if (before > 0 && excess > 0) {
            ++pairs;
            held += std::abs(excess - before) < 8 ? 1 : 0;
        }
        before = excess;
    }
    EXPECT_GT(pairs, 50);
    EXPECT_GT(held, 0.8 * pairs) << "but where another echo becomes the strongest";
    EXPECT_GT(late, 400);
    EXPECT_GT(weak_in_sight, 100) << "not every weak satellite is late";
}

TEST(SurroundingsEffect, LeavesAloneWhatASceneDescribes) {
    SurroundingsEffect effect(effect_parameters(), {}, 9);
    const SkyView sky = test::gps_ring(3, 15);
    Arrivals arrivals = free_space(sky);
    for (Arrival& arrival : arrivals.satellites)
        arrival.echoes_known = true;
    effect.apply(arrivals, sky, test::truth_of(test::odessa_place, test::april_noon));
    for (const Arrival& arrival : arrivals.satellites) {
        EXPECT_EQ(arrival.shadowing_loss, Decibels(0));
        EXPECT_TRUE(arrival.echoes.empty());
    }
}

TEST(SurroundingsEffect, SwitchedOffLeavesNothing) {
    ErrorTerm off;
    off.enabled = false;
    SurroundingsEffect effect(effect_parameters(), off, 9);
    for (const Arrival& arrival : surrounded(effect, test::gps_ring(8, 15), 0, {}).satellites) {
        EXPECT_EQ(arrival.shadowing_loss, Decibels(0));
        EXPECT_TRUE(arrival.line_of_sight);
        EXPECT_TRUE(arrival.echoes.empty());
    }
}

// A car's roof takes its decibels towards the zenith, and none from low satellites.
TEST(SurroundingsEffect, ARoofWeakensHighSatellites) {
    ChannelParameters roofed = effect_parameters(), open = effect_parameters();
    open.bad_odds = roofed.bad_odds = 0.001;
    open.diffuse = roofed.diffuse = Decibels(-60);
    roofed.roof = Decibels(6);
    SurroundingsEffect with(roofed, {}, 9), without(open, {}, 9);
    const auto extra = [&](double elevation) {
        const SkyView sky = test::gps_ring(1, elevation);
        return (surrounded(with, sky, 0, {}).satellites[0].shadowing_loss -
                surrounded(without, sky, 0, {}).satellites[0].shadowing_loss)
            .value();
    };
    EXPECT_NEAR(extra(89.9), 6, 0.1);
    EXPECT_NEAR(extra(20), 0, 1e-9);
    EXPECT_GT(extra(60), 2);
}

}  // namespace
