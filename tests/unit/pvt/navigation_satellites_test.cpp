// Which satellites a navigation engine takes, and when it knows enough of them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "plain_navigation.hpp"

namespace skyloop {
namespace {

using test::antenna;
using test::error_of;
using test::later;
using test::measure;
using test::plain;
using test::receiver_at;
using test::sample_time;
using test::SyntheticSky;
using test::TrueReceiver;

TEST(NavigationEngine, UsesWhatIsStrongEnoughWithAHysteresis) {
    const SyntheticSky sky = test::synthetic_sky(sample_time, test::four_systems);
    const TrueReceiver receiver = receiver_at(antenna, sample_time);
    NavigationParameters parameters = plain(FilterKind::none);
    parameters.use = {.from = DbHz(30), .within = Decibels(12), .hysteresis = Decibels(3), .after = Seconds(5)};
    NavigationEngine engine(parameters, {&sky});
    const auto uses_first_at = [&](double second, double cn0) {
        Observations observations = measure(sky, later(receiver, second));
        for (Observation& o : observations.signals)
            o.cn0 = DbHz(45);
        observations.signals[0].cn0 = DbHz(cn0);
        const Fix fix = engine.solve(observations, {});
        return std::any_of(fix.satellites.begin(), fix.satellites.end(), [&](const SatelliteStatus& s) {
            return s.used && s.id == observations.signals[0].satellite;
        });
    };
    EXPECT_FALSE(uses_first_at(0, 32)) << "13 dB below the fourth strongest";
    EXPECT_FALSE(uses_first_at(3, 34)) << "tracked for three seconds alone";
    EXPECT_TRUE(uses_first_at(6, 34));
    EXPECT_TRUE(uses_first_at(7, 31)) << "within the hysteresis";
    EXPECT_FALSE(uses_first_at(8, 29));
    EXPECT_FALSE(uses_first_at(9, 31));
    EXPECT_TRUE(uses_first_at(10, 33));
}

TEST(NavigationEngine, TakesTheStrongestWhereItHasNoTimeForAll) {
    const SyntheticSky sky = test::synthetic_sky(sample_time, test::four_systems);
    const TrueReceiver receiver = receiver_at(antenna, sample_time);
    Observations observations = measure(sky, receiver);
    ASSERT_GT(observations.signals.size(), 12U);
    int step = 0;
    for (Observation& o : observations.signals)
        o.cn0 = DbHz(35 + (7 * step++) % 13);
    ReceiverSettings settings;
    settings.most_satellites = 9;
    NavigationEngine engine(plain(FilterKind::none), {&sky});
    const Fix fix = engine.solve(observations, settings);
    EXPECT_LT(error_of(fix, receiver), 1e-5);
    EXPECT_EQ(fix.satellites_used(), 9);
    DbHz weakest_used(99), strongest_unused(0);
    for (const SatelliteStatus& s : fix.satellites) {
        if (!s.cn0) continue;
        if (s.used)
            weakest_used = std::min(weakest_used, *s.cn0);
        else
            strongest_unused = std::max(strongest_unused, *s.cn0);
    }
    EXPECT_GT(strongest_unused, DbHz(0)) << "the others stay tracked";
    EXPECT_GE(weakest_used, strongest_unused);
    settings.most_satellites = 0;
    EXPECT_EQ(static_cast<std::size_t>(engine.solve(observations, settings).satellites_used()),
              observations.signals.size());
}

TEST(NavigationEngine, LeavesSbasOutWhereItsRangesAreNotWanted) {
    const SyntheticSky sky = test::synthetic_sky(sample_time, {Constellation::gps, Constellation::sbas});
    const Observations observations = measure(sky, receiver_at(antenna, sample_time));
    for (const bool ranging : {true, false}) {
        ReceiverSettings settings;
        settings.sbas_ranging = ranging;
        NavigationEngine engine(plain(FilterKind::none), {&sky});
        const Fix fix = engine.solve(observations, settings);
        EXPECT_EQ(fix.type, FixType::fix_3d);
        EXPECT_EQ(std::any_of(fix.satellites.begin(), fix.satellites.end(),
                              [](const auto& s) { return s.id.constellation == Constellation::sbas && s.used; }),
                  ranging);
    }
}

TEST(NavigationEngine, TakesTheStrongestOfThoseThatItCanUse) {
    const SyntheticSky sky = test::synthetic_sky(sample_time, test::four_systems);
    Observations observations = measure(sky, receiver_at(antenna, sample_time));
    ReceiverSettings settings;
    settings.elevation_mask = Angle::degrees(30);
    NavigationEngine engine(plain(FilterKind::none), {&sky});
    const Fix all = engine.solve(observations, settings);
    constexpr int most = 8;  // so that of no system one alone is taken, which gives nothing
    ASSERT_GT(all.satellites_used(), most);
    ASSERT_GT(std::ssize(observations.signals), all.satellites_used());
    for (Observation& o : observations.signals)
        for (const SatelliteStatus& s : all.satellites)
            if (s.id == o.satellite) o.cn0 = DbHz(s.used ? 40 : 50);
    settings.most_satellites = most;
    EXPECT_EQ(engine.solve(observations, settings).satellites_used(), most);
}

TEST(NavigationEngine, ReportsSatellitesUsedAndUnusedAscending) {
    SyntheticSky sky = test::synthetic_sky(sample_time, test::four_systems);
    const TrueReceiver receiver = receiver_at(antenna, sample_time);
    test::MeasureOptions horizon;
    horizon.mask = Angle::degrees(0.01);
    const Observations all = measure(sky, receiver, horizon);
    Observations observations = all;
    const SatelliteId dropped = observations.signals[2].satellite;
    observations.signals.erase(observations.signals.begin() + 2);
    const SatelliteId weak = observations.signals[4].satellite;
    observations.signals[4].cn0 = DbHz(20);
    const SatelliteId faulty = observations.signals[6].satellite;
    *observations.signals[6].pseudorange += Metres(200);
    ReceiverSettings settings;
    settings.minimum_cn0 = DbHz(25);
    NavigationEngine engine(plain(FilterKind::smoothed), {&sky});
    const Fix fix = engine.solve(observations, settings);
    EXPECT_LT(error_of(fix, receiver), 2e-6);
    ASSERT_EQ(fix.satellites.size(), all.signals.size());
    const LocalFrame frame(antenna);
    for (std::size_t i = 0; i < fix.satellites.size(); ++i) {
        const SatelliteStatus& s = fix.satellites[i];
        EXPECT_EQ(s.id, all.signals[i].satellite);
        const LookAngles look = frame.look_angles(
            Position<Ecef>(test::true_range(*sky.ephemeris(s.id, sample_time), receiver, 0).satellite));
        EXPECT_NEAR(s.elevation.deg(), look.elevation.deg(), 1e-3);
        EXPECT_NEAR(s.azimuth.deg(), look.azimuth.deg(), 1e-2);
        EXPECT_TRUE(s.has_ephemeris && s.healthy);
        EXPECT_EQ(s.cn0.has_value(), s.id != dropped);
        const bool low = s.elevation < settings.elevation_mask;
        EXPECT_EQ(s.used, s.id != dropped && s.id != weak && s.id != faulty && !low) << to_string(s.id);
        if (s.id == faulty) {
            EXPECT_NEAR(s.residual->value(), 200, 1e-3);
        }
        if (s.used) {
            EXPECT_NEAR(s.residual->value(), 0, 1e-6);
        }
    }
}

TEST(NavigationEngine, HearsTheSatellitesBeforeItUsesThem) {
    const SyntheticSky sky = test::synthetic_sky(sample_time, {Constellation::gps, Constellation::galileo});
    for (const StartKind start : {StartKind::hot, StartKind::warm, StartKind::cold}) {
        NavigationEngine engine(plain(FilterKind::smoothed), {&sky});
        ReceiverSettings settings;
        settings.start = start;
        int first_fix = -1;
        for (int s = 0; s < 40 && first_fix < 0; ++s) {
            const TrueReceiver now = later(receiver_at(antenna, sample_time), s);
            Observations observations = measure(sky, now);
            if (s < 5) observations.signals.clear();
            const Fix fix = engine.solve(observations, settings);
            if (fix.type != FixType::none) {
                first_fix = s;
                EXPECT_LT(error_of(fix, now), 2e-6);
            } else if (s >= 5) {
                ASSERT_EQ(fix.satellites.size(), observations.signals.size());
                EXPECT_FALSE(fix.satellites[0].has_ephemeris);
                EXPECT_TRUE(fix.satellites[0].cn0);
                EXPECT_FALSE(fix.satellites[0].used);
            }
        }
        EXPECT_EQ(first_fix, start == StartKind::hot ? 5 : 26);
    }
}

TEST(NavigationEngine, LooksUpTheSkyOverItsLastPlaceUnlessItStartsCold) {
    const SyntheticSky sky = test::synthetic_sky(sample_time, {Constellation::gps});
    const TrueReceiver now = receiver_at(antenna, sample_time);
    NavigationKnowledge knowledge{&sky};
    knowledge.last_place = Position<Ecef>(now.position);
    for (const StartKind start : {StartKind::warm, StartKind::cold}) {
        NavigationEngine engine(plain(FilterKind::smoothed), knowledge);
        ReceiverSettings settings;
        settings.start = start;
        const Fix fix = engine.solve(measure(sky, now), settings);
        EXPECT_EQ(fix.type, FixType::none) << "the records are still to come";
        ASSERT_FALSE(fix.satellites.empty());
        for (const SatelliteStatus& s : fix.satellites) {
            if (!s.cn0) continue;
            EXPECT_EQ(s.elevation > Angle(), start == StartKind::warm) << to_string(s.id);
        }
    }
}

TEST(NavigationEngine, ForgetsAtARestartAndNotAtAHotOne) {
    const SyntheticSky sky = test::synthetic_sky(sample_time, test::four_systems);
    NavigationEngine engine(plain(FilterKind::smoothed), {&sky});
    ReceiverSettings settings;
    const auto fix_at = [&](int s) {
        return engine.solve(measure(sky, later(receiver_at(antenna, sample_time), s)), settings);
    };
    EXPECT_EQ(fix_at(0).type, FixType::fix_3d);
    settings.restarts = 1;
    EXPECT_EQ(fix_at(1).type, FixType::fix_3d);
    settings.restarts = 2;
    settings.start = StartKind::cold;
    for (int s = 2; s < 23; ++s)
        EXPECT_EQ(fix_at(s).type, FixType::none) << s;
    EXPECT_EQ(fix_at(23).type, FixType::fix_3d);
    // No almanac yet: nothing is known of what is not tracked.
    for (const SatelliteStatus& s : fix_at(24).satellites)
        EXPECT_TRUE(s.cn0);
}

TEST(NavigationEngine, KnowsAfterARestartNoMoreThanItHadReceived) {
    const SyntheticSky sky = test::synthetic_sky(sample_time, test::four_systems);
    for (const StartKind later_start : {StartKind::hot, StartKind::warm}) {
        NavigationEngine engine(plain(FilterKind::smoothed), {&sky});
        ReceiverSettings settings;
        settings.start = StartKind::cold;
        const auto fix_at = [&](int s) {
            Observations observations = measure(sky, later(receiver_at(antenna, sample_time), s));
            if (s < 3) observations.signals.clear();
            return engine.solve(observations, settings);
        };
        for (int s = 0; s < 3; ++s)
            EXPECT_EQ(fix_at(s).type, FixType::none);
        settings.start = later_start;
        settings.restarts = 1;
        for (int s = 3; s < 24; ++s)
            EXPECT_EQ(fix_at(s).type, FixType::none) << s;
        EXPECT_EQ(fix_at(24).type, FixType::fix_3d);
        settings.start = StartKind::hot;
        settings.restarts = 2;
        EXPECT_EQ(fix_at(25).type, FixType::fix_3d) << "it has received them since";
    }
}

TEST(NavigationEngine, CannotReadTheDataOfWeakSignals) {
    const SyntheticSky sky = test::synthetic_sky(sample_time, test::four_systems);
    NavigationEngine engine(plain(FilterKind::smoothed), {&sky});
    ReceiverSettings settings;
    settings.start = StartKind::cold;
    for (int s = 0; s < 60; ++s) {
        Observations observations = measure(sky, later(receiver_at(antenna, sample_time), s));
        for (Observation& o : observations.signals)
            o.cn0 = DbHz(22);
        EXPECT_EQ(engine.solve(observations, settings).type, FixType::none);
    }
}

}  // namespace
}  // namespace skyloop
