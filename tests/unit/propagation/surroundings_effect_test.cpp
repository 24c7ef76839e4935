// What surroundings write into what arrives.
#include "world/propagation/surroundings_effect.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "base/geo/local_frame.hpp"
#include "modern_sky.hpp"
#include "world/propagation/surroundings.hpp"

namespace {

using namespace skyloop;

SurroundingsParameters effect_parameters() {
    SurroundingsParameters parameters;
    parameters.everywhere.environment = P681Environment::urban;
    parameters.everywhere.bad_odds = 4;
    parameters.start = test::april_noon;
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
    SurroundingsParameters roofed = effect_parameters();
    roofed.everywhere.bad_odds = 0.001;
    roofed.everywhere.diffuse = Decibels(-60);
    const SurroundingsParameters open = roofed;
    roofed.everywhere.roof = Decibels(6);
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

// An open road of 1 km with surroundings from 200 to 400 m.
SurroundingsParameters road_with(Surroundings kind, double ramp) {
    SurroundingsParameters parameters;
    parameters.start = test::april_noon;
    parameters.stretches = {{channel_of(kind), StretchOfWay{Metres(200), Metres(400)}, ramp}};
    return parameters;
}

// Northwards at 10 m/s, an epoch each metre.
Arrivals driven(SurroundingsEffect& effect, const SkyView& sky, int metres) {
    TruthState truth = test::truth_of(place_north(metres), test::april_noon + std::chrono::milliseconds(100 * metres));
    const LocalFrame frame(truth.geodetic);
    truth.velocity = frame.to_ecef(Velocity<Enu>(0, 10, 0));
    return test::after(effect, sky, truth);
}

TEST(SurroundingsEffect, StretchesActAlongTheirWayAlone) {
    SurroundingsEffect effect(road_with(Surroundings::urban, 20), {}, 9);
    const SkyView sky = test::gps_ring(12, 20);
    double most_before = 0, most_within = 0, largest_step = 0, before = 0;
    for (int metre = 0; metre <= 500; ++metre) {
        const Arrival arrival = driven(effect, sky, metre).satellites[3];
        const double loss = arrival.direct_loss.value();
        (metre < 200 || metre > 401 ? most_before : most_within) =
            std::max(std::abs(loss), metre < 200 || metre > 401 ? most_before : most_within);
        if (metre < 225) largest_step = std::max(largest_step, std::abs(loss - before));
        before = loss;
    }
    EXPECT_EQ(most_before, 0);
    EXPECT_GT(most_within, 5);
    EXPECT_LT(largest_step, 6) << "the ramp lets it come gradually";
}

// Of a tunnel the satellites behind are the last to go, those ahead the first to come back, and the zenith is gone at
// once.
TEST(SurroundingsEffect, ATunnelClosesAndOpensByItsEnds) {
    SurroundingsEffect effect(road_with(Surroundings::tunnel, 0), {}, 9);
    SkyView sky;
    sky.satellites = {test::satellite_at({Constellation::gps, 1}, 0, 10),
                      test::satellite_at({Constellation::gps, 2}, 180, 10),
                      test::satellite_at({Constellation::gps, 3}, 90, 80)};
    std::vector<std::vector<bool>> seen;
    for (int metre = 0; metre <= 500; ++metre) {
        seen.emplace_back();
        for (const Arrival& arrival : driven(effect, sky, metre).satellites)
            seen.back().push_back(arrival.shadowing_loss < Decibels(20));
    }
    using Row = std::vector<bool>;
    EXPECT_EQ(seen[195], (Row{true, true, true}));
    EXPECT_EQ(seen[210], (Row{false, true, false})) << "ten metres in";
    EXPECT_EQ(seen[300], (Row{false, false, false}));
    EXPECT_EQ(seen[390], (Row{true, false, false})) << "ten metres before its end";
    EXPECT_EQ(seen[405], (Row{true, true, true}));
}

// Between walls satellites along the street are in the good state, those across it in the bad one.
TEST(SurroundingsEffect, WallsBlockAcrossTheStreet) {
    SurroundingsParameters parameters;
    parameters.everywhere = channel_of(Surroundings::valley);
    parameters.everywhere.wall = Angle::degrees(60);
    parameters.start = test::april_noon;
    SurroundingsEffect effect(parameters, {}, 9);
    SkyView sky;
    for (int i = 0; i < 4; ++i)
        sky.satellites.push_back(test::satellite_at({Constellation::gps, i + 1}, 90.0 * i, 35));
    std::vector<int> shadowed(4);
    for (int metre = 0; metre < 400; ++metre)
        for (std::size_t i = 0; const Arrival& arrival : driven(effect, sky, metre).satellites)
            shadowed[i++] += arrival.shadowed ? 1 : 0;
    EXPECT_LT(shadowed[0] + shadowed[2], 40) << "north and south, along the way";
    EXPECT_GT(shadowed[1] + shadowed[3], 760);
}

}  // namespace
