#include "receiver/pvt/navigation_engine.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "base/core/random.hpp"
#include "plain_navigation.hpp"
#include "receiver/pvt/corrections.hpp"
#include "support/flat_geoid.hpp"

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

TEST(NavigationEngine, FindsAPerfectReceiverWithAndWithoutAFilter) {
    const SyntheticSky sky = test::synthetic_sky(sample_time, test::four_systems);
    for (const FilterKind filter : {FilterKind::none, FilterKind::smoothed})
        for (const double speed : {0.0, 60.0}) {
            NavigationEngine engine(plain(filter), {&sky});
            TrueReceiver receiver = receiver_at(antenna, sample_time - std::chrono::seconds(10));
            receiver.velocity = LocalFrame(antenna).to_ecef(Velocity<Enu>(0.6 * speed, -0.8 * speed, 0)).vector();
            for (int s = 0; s < 20; ++s) {
                const TrueReceiver now = later(receiver, s);
                const Fix fix = engine.solve(measure(sky, now), {});
                EXPECT_EQ(fix.type, FixType::fix_3d);
                EXPECT_EQ(fix.time, now.time);
                // An angle of one unit in the last place is 1e-9 m.
                EXPECT_LT(error_of(fix, now), 2e-6) << s << ' ' << speed;
                EXPECT_NEAR(fix.clock_bias.value(), now.clock_bias_m, 2e-6);
                EXPECT_NEAR(fix.clock_drift.value(), 42, 1e-6);
                const Eigen::Vector3d enu =
                    LocalFrame(to_geodetic(Position<Ecef>(now.position))).to_enu(Velocity<Ecef>(now.velocity)).vector();
                EXPECT_NEAR(fix.velocity.east, enu.x(), 2e-6);
                EXPECT_NEAR(fix.velocity.north, enu.y(), 2e-6);
                EXPECT_NEAR(fix.velocity.down, -enu.z(), 2e-6);
                EXPECT_NEAR(fix.speed.value(), std::hypot(enu.x(), enu.y()), 2e-6);
                if (speed > 0) {
                    EXPECT_NEAR(fix.course.rad(), std::atan2(enu.x(), enu.y()), 1e-6);
                }
            }
        }
}

TEST(NavigationEngine, KnowsNoVelocityWithoutDopplers) {
    const SyntheticSky sky = test::synthetic_sky(sample_time, test::four_systems);
    NavigationEngine engine(plain(FilterKind::none), {&sky});
    EXPECT_FALSE(engine.velocity_known());
    for (const bool told : {true, false, true}) {
        Observations observations = measure(sky, receiver_at(antenna, sample_time));
        if (!told)
            for (Observation& o : observations.signals)
                o.doppler.reset();
        const Fix fix = engine.solve(observations, {});
        EXPECT_EQ(fix.type, FixType::fix_3d);
        EXPECT_EQ(engine.velocity_known(), told);
        EXPECT_EQ(fix.speed_accuracy >= MetresPerSecond(20), !told) << "nothing was measured";
        if (!told) {
            EXPECT_NEAR(fix.course_accuracy.deg(), 180, 1e-9);
        }
    }
}

TEST(NavigationEngine, IsExactAtThePolesTheDateLineAndTheEndOfTheWeek) {
    const GpsTime sunday = to_gps_time(2300, 0.0);
    const SyntheticSky sky = test::synthetic_sky(sunday, test::four_systems);
    for (const Geodetic& place : {Geodetic::degrees(90, 0, 100), Geodetic::degrees(-90, 0, 2800),
                                  Geodetic::degrees(10, 180, 5), Geodetic::degrees(-45, -179.99999, 300)}) {
        NavigationEngine engine(plain(FilterKind::smoothed), {&sky});
        for (int s = -3; s <= 3; ++s) {
            const TrueReceiver receiver = receiver_at(place, sunday + std::chrono::seconds(s));
            const Fix fix = engine.solve(measure(sky, receiver), {});
            EXPECT_EQ(fix.type, FixType::fix_3d);
            EXPECT_LT(error_of(fix, receiver), 2e-6);
            EXPECT_EQ(fix.time, receiver.time);
        }
    }
}

TEST(NavigationEngine, TakesTheIonosphereOutWithTwoCarriers) {
    const SyntheticSky sky = test::synthetic_sky(sample_time, test::four_systems);
    NavigationParameters parameters = plain(FilterKind::none);
    parameters.corrections.ionosphere_free = true;
    NavigationEngine engine(parameters, {&sky});
    const TrueReceiver receiver = receiver_at(antenna, sample_time);
    test::MeasureOptions options;
    options.all_signals = true;
    const Observations observations =
        measure(sky, receiver, options, [](const SatelliteId& id, const SkyDirection& d, Hertz carrier) {
            return ionosphere_delay_at(Metres((3 + id.number % 5) / std::sin(d.elevation.rad())), carrier).value();
        });
    ReceiverSettings settings;
    const Fix fix = engine.solve(observations, settings);
    EXPECT_LT(error_of(fix, receiver), 1e-5);
    NavigationEngine single(plain(FilterKind::none), {&sky});
    EXPECT_GT(error_of(single.solve(observations, settings), receiver), 0.5);
}

// All signals, behind an ionosphere that delays L1 by 20 m at the zenith.
Observations measured_behind_20_m(const SyntheticSky& sky, const TrueReceiver& receiver) {
    test::MeasureOptions options;
    options.all_signals = true;
    return measure(sky, receiver, options, [](const SatelliteId&, const SkyDirection& d, Hertz carrier) {
        return ionosphere_delay_at(Metres(20 / std::sin(d.elevation.rad())), carrier).value();
    });
}

// E5a comes before E5b. I/NAV tells no delay of it, and so it was sent without one.
TEST(NavigationEngine, CombinesTheFirstOtherCarrier) {
    const SyntheticSky sky = test::synthetic_sky(sample_time, {Constellation::galileo});
    NavigationParameters parameters = plain(FilterKind::none);
    parameters.corrections.ionosphere_free = true;
    const TrueReceiver receiver = receiver_at(antenna, sample_time);
    Observations observations = measured_behind_20_m(sky, receiver);
    std::sort(observations.signals.begin(), observations.signals.end(), [](const Observation& a, const Observation& b) {
        return std::tie(a.satellite, a.signal) < std::tie(b.satellite, b.signal);
    });
    ASSERT_EQ(observations.signals[1].signal, Signal::l5);
    ASSERT_EQ(observations.signals[2].signal, Signal::e5b);
    const Fix fix = NavigationEngine(parameters, {&sky}).solve(observations, {});
    EXPECT_LT(error_of(fix, receiver), 1e-4);
    EXPECT_EQ(static_cast<std::size_t>(fix.satellites_used()), observations.signals.size() / 3);
}

// As a board of L1 and L5 measures. No record tells a delay of L5 and, in I/NAV, E5a.
TEST(NavigationEngine, TakesTheIonosphereOutWithL5) {
    using enum Constellation;
    const SyntheticSky sky = test::synthetic_sky(sample_time, {gps, galileo});
    const TrueReceiver receiver = receiver_at(antenna, sample_time);
    Observations observations = measured_behind_20_m(sky, receiver);
    std::erase_if(observations.signals, [](const Observation& o) {
        return o.signal != Signal::l5 && o.signal != first_signal(o.satellite.constellation);
    });
    NavigationParameters parameters = plain(FilterKind::none);
    parameters.corrections.ionosphere_free = true;
    const Fix fix = NavigationEngine(parameters, {&sky}).solve(observations, {});
    EXPECT_LT(error_of(fix, receiver), 1e-4);
    for (const Constellation system : {gps, galileo})
        EXPECT_TRUE(std::any_of(fix.satellites.begin(), fix.satellites.end(), [&](const SatelliteStatus& s) {
            return s.used && s.id.constellation == system;
        })) << constellation_name(system);
    parameters.corrections.ionosphere_free = false;
    EXPECT_GT(error_of(NavigationEngine(parameters, {&sky}).solve(observations, {}), receiver), 0.5);
}

// The model knows a tenth of what there is, and some satellites have one signal.
TEST(NavigationEngine, LeavesOutWhatTheIonosphereTouchesWhereEnoughIsFreeOfIt) {
    const SyntheticSky sky = test::synthetic_sky(sample_time, test::four_systems);
    NavigationParameters parameters = plain(FilterKind::none);
    parameters.corrections.ionosphere_free = true;
    const TrueReceiver receiver = receiver_at(antenna, sample_time);
    Observations observations = measured_behind_20_m(sky, receiver);
    const auto keep_second_signals_of = [&](Constellation system) {
        std::erase_if(observations.signals, [&](const Observation& o) {
            return o.satellite.constellation != system && o.signal != first_signal(o.satellite.constellation);
        });
    };
    keep_second_signals_of(Constellation::galileo);
    const Fix fix = NavigationEngine(parameters, {&sky}).solve(observations, {});
    EXPECT_LT(error_of(fix, receiver), 1e-4);
    for (const SatelliteStatus& s : fix.satellites)
        if (s.used) {
            EXPECT_EQ(s.id.constellation, Constellation::galileo);
        }
    keep_second_signals_of(Constellation::sbas);
    const Fix mixed = NavigationEngine(parameters, {&sky}).solve(observations, {});
    EXPECT_GT(mixed.satellites_used(), 20) << "where no satellite has two signals, one is all there is";
}

TEST(NavigationEngine, HoldsTheCourseBelowTheReceiversOwnSpeed) {
    const SyntheticSky sky = test::synthetic_sky(sample_time, test::four_systems);
    TrueReceiver receiver = receiver_at(antenna, sample_time);
    receiver.velocity = LocalFrame(antenna).to_ecef(Velocity<Enu>(0.2, 0, 0)).vector();
    for (const auto& [threshold, course] : {std::pair{0.3, 0.0}, {0.1, 90.0}}) {
        NavigationEngine engine(plain(FilterKind::none), {&sky});
        ReceiverSettings settings;
        settings.course_held_below = MetresPerSecond(threshold);
        EXPECT_NEAR(engine.solve(measure(sky, receiver), settings).course.deg(), course, 0.1) << threshold;
    }
}

TEST(NavigationEngine, CoastsThenGivesUpThenReturns) {
    const SyntheticSky sky = test::synthetic_sky(sample_time, test::four_systems);
    NavigationEngine engine(plain(FilterKind::smoothed), {&sky});
    TrueReceiver receiver = receiver_at(antenna, sample_time);
    receiver.velocity = {15, -10, 5};
    Metres accuracy;
    for (int s = 0; s < 20; ++s) {
        const TrueReceiver now = later(receiver, s);
        Observations observations = measure(sky, now);
        if (s >= 10 && s < 15) observations.signals.clear();
        const Fix fix = engine.solve(observations, {});
        const FixType expected = s < 10 || s >= 15 ? FixType::fix_3d : s < 12 ? FixType::dead_reckoning : FixType::none;
        EXPECT_EQ(fix.type, expected) << s;
        EXPECT_EQ(fix.time, now.time);
        if (fix.type != FixType::none) {
            EXPECT_LT(error_of(fix, now), 1e-5);
            ASSERT_TRUE(fix.correlation);
            EXPECT_GT(fix.correlation->position_clock(2, 3), 0.5);
            EXPECT_NE(fix.correlation->velocity(0, 1), 0);
        }
        if (s == 9) accuracy = fix.horizontal_accuracy;
        if (s == 11) {
            EXPECT_GT(fix.horizontal_accuracy, accuracy);
        }
        if (s >= 10 && s < 15) {
            EXPECT_EQ(fix.satellites_used(), 0);
        }
    }
}

TEST(NavigationEngine, HoldsTheHeightWithThreeSatellites) {
    const SyntheticSky sky = test::synthetic_sky(sample_time, {Constellation::gps});
    NavigationEngine engine(plain(FilterKind::smoothed), {&sky});
    Metres last_vertical;
    for (int s = 0; s < 6; ++s) {
        const TrueReceiver now = later(receiver_at(antenna, sample_time), s);
        Observations observations = measure(sky, now);
        if (s >= 3) observations.signals.resize(3);
        const Fix fix = engine.solve(observations, {});
        EXPECT_EQ(fix.type, s < 3 ? FixType::fix_3d : FixType::fix_2d);
        EXPECT_LT(error_of(fix, now), 1e-5);
        EXPECT_GT(fix.dop.hdop, 0.5);
        EXPECT_EQ(std::isnan(fix.dop.pdop), s >= 3);
        // The height is no better known than when it was solved.
        if (s >= 3) {
            EXPECT_GE(fix.vertical_accuracy, last_vertical - Metres(1e-6));
        }
        last_vertical = fix.vertical_accuracy;
    }
}

TEST(NavigationEngine, KnowsAHeldHeightTheLessTheLongerAgoItWas) {
    const SyntheticSky sky = test::synthetic_sky(sample_time, {Constellation::gps});
    TrueReceiver climbing = receiver_at(antenna, sample_time);
    climbing.velocity = LocalFrame(antenna).to_ecef(Velocity<Enu>(0, 0, 10)).vector();
    for (const auto model : {DynamicModel::portable, DynamicModel::airborne_1g, DynamicModel::airborne_4g}) {
        NavigationEngine engine(plain(FilterKind::smoothed), {&sky});
        for (int s = 0; s < 30; ++s) {
            const TrueReceiver now = later(climbing, s);
            Observations observations = measure(sky, now);
            if (s >= 3) observations.signals.resize(3);
            const Fix fix = engine.solve(observations, {.dynamic_model = model});
            if (s < 3) continue;
            if (model != DynamicModel::portable) {
                EXPECT_EQ(fix.type, s < 5 ? FixType::dead_reckoning : FixType::none) << s;
                continue;
            }
            ASSERT_EQ(fix.type, FixType::fix_2d) << s;
            const auto error = LocalFrame(to_geodetic(Position<Ecef>(now.position))).to_enu(to_ecef(fix.position));
            EXPECT_LT(std::abs(error.vector().z()), 1.2 * fix.vertical_accuracy.value()) << s;
            EXPECT_LT(error.vector().head<2>().norm(), 1.2 * fix.horizontal_accuracy.value()) << s;
            EXPECT_GT(fix.vertical_accuracy.value(), 10 * (s - 2)) << s;
        }
    }
}

TEST(NavigationEngine, ReportsAccuraciesThatHold) {
    const SyntheticSky sky = test::synthetic_sky(sample_time, test::four_systems);
    const WeightParameters weights;
    RandomStream noise(7, "accuracy");
    NavigationEngine engine(plain(FilterKind::none), {&sky});
    const TrueReceiver receiver = receiver_at(antenna, sample_time);
    const LocalFrame frame(antenna);
    int within = 0, vertical = 0, speed = 0;
    constexpr int epochs = 1500;
    const Observations perfect = measure(sky, receiver);
    const Fix clean = engine.solve(perfect, {});
    for (int epoch = 0; epoch < epochs; ++epoch) {
        Observations observations = perfect;
        observations.receive_time += std::chrono::nanoseconds(0);
        for (Observation& o : observations.signals) {
            for (const SatelliteStatus& s : clean.satellites)
                if (s.id == o.satellite)
                    *o.pseudorange +=
                        Metres(noise.normal() * std::hypot(weights.floor.value(),
                                                           weights.at_zenith.value() / std::sin(s.elevation.rad())));
            *o.doppler += Hertz(noise.normal() * 0.02 * o.carrier.value() / speed_of_light);
        }
        const Fix fix = engine.solve(observations, {});
        const Eigen::Vector3d error = frame.to_enu(to_ecef(fix.position)).vector();
        within += std::hypot(error.x(), error.y()) <= fix.horizontal_accuracy.value() ? 1 : 0;
        vertical += std::abs(error.z()) <= fix.vertical_accuracy.value() ? 1 : 0;
        const double v2 =
            std::pow(fix.velocity.north, 2) + std::pow(fix.velocity.east, 2) + std::pow(fix.velocity.down, 2);
        speed += std::sqrt(v2) <= fix.speed_accuracy.value() ? 1 : 0;
    }
    EXPECT_NEAR(within, 0.645 * epochs, 0.06 * epochs);
    EXPECT_NEAR(vertical, 0.683 * epochs, 0.06 * epochs);
    EXPECT_NEAR(speed, 0.63 * epochs, 0.08 * epochs);
}

TEST(NavigationEngine, WidensItsAccuracyWhenResidualsDoNotFit) {
    const SyntheticSky sky = test::synthetic_sky(sample_time, {Constellation::gps});
    NavigationEngine engine(plain(FilterKind::none), {&sky});
    Observations observations = measure(sky, receiver_at(antenna, sample_time));
    ASSERT_GE(observations.signals.size(), 5U);
    observations.signals.resize(5);
    const Fix good = engine.solve(observations, {});
    *observations.signals[1].pseudorange += Metres(500);
    const Fix bad = engine.solve(observations, {});
    EXPECT_GT(bad.horizontal_accuracy.value(), 5 * good.horizontal_accuracy.value());
}

TEST(NavigationEngine, SolvesTimeAloneWhereTheAntennaWasSurveyed) {
    const SyntheticSky sky = test::synthetic_sky(sample_time, test::four_systems);
    NavigationParameters parameters = plain(FilterKind::smoothed);
    parameters.fixed_position = antenna;
    NavigationEngine engine(parameters, {&sky});
    ReceiverSettings settings;
    settings.dynamic_model = DynamicModel::stationary;
    const TrueReceiver receiver = receiver_at(antenna, sample_time);
    const Fix fix = engine.solve(measure(sky, receiver), settings);
    EXPECT_EQ(fix.type, FixType::time_only);
    EXPECT_NEAR(fix.clock_bias.value(), receiver.clock_bias_m, 1e-6);
    EXPECT_GT(fix.satellites_used(), 10);
    settings.dynamic_model = DynamicModel::portable;
    EXPECT_EQ(engine.solve(measure(sky, later(receiver, 1)), settings).type, FixType::fix_3d);
}

TEST(NavigationEngine, NamesDifferentialFixes) {
    const SyntheticSky sky = test::synthetic_sky(sample_time, test::four_systems);
    const Observations observations = measure(sky, receiver_at(antenna, sample_time));
    const auto fix_with = [&](DifferentialKind kind) {
        NavigationParameters parameters = plain(FilterKind::none);
        parameters.differential.kind = kind;
        return NavigationEngine(parameters, {&sky}).solve(observations, {});
    };
    EXPECT_EQ(fix_with(DifferentialKind::none).type, FixType::fix_3d);
    EXPECT_EQ(fix_with(DifferentialKind::sbas).type, FixType::dgnss);
    EXPECT_EQ(fix_with(DifferentialKind::rtk_float).type, FixType::rtk_float);
    EXPECT_EQ(fix_with(DifferentialKind::rtk_fixed).type, FixType::rtk_fixed);
    EXPECT_EQ(fix_with(DifferentialKind::rtk_fixed).horizontal_accuracy, Metres(0.014));
}

TEST(NavigationEngine, KeepsToTheLimitsOfItsDynamicModel) {
    const SyntheticSky sky = test::synthetic_sky(sample_time, test::four_systems);
    const TrueReceiver balloon = receiver_at(Geodetic::degrees(46, 30, 30000), sample_time);
    NavigationEngine engine(plain(FilterKind::smoothed), {&sky});
    ReceiverSettings settings;
    const Fix high = engine.solve(measure(sky, balloon), settings);
    EXPECT_EQ(high.type, FixType::none);
    EXPECT_TRUE(high.withheld);
    settings.dynamic_model = DynamicModel::airborne_1g;
    const Fix allowed = engine.solve(measure(sky, later(balloon, 1)), settings);
    EXPECT_EQ(allowed.type, FixType::fix_3d);
    EXPECT_FALSE(allowed.withheld);
    settings.airborne_ceiling = Metres(29'000);
    EXPECT_EQ(engine.solve(measure(sky, later(balloon, 2)), settings).type, FixType::none);

    TrueReceiver rocket = receiver_at(Geodetic::degrees(46, 30, 79'000), sample_time);
    rocket.velocity = LocalFrame(antenna).to_ecef(Velocity<Enu>(0, 0, 150)).vector();
    NavigationEngine another(plain(FilterKind::smoothed), {&sky});
    EXPECT_EQ(another.solve(measure(sky, rocket), {.dynamic_model = DynamicModel::airborne_4g}).type, FixType::fix_3d);
}

TEST(NavigationEngine, FindsAClockThatWanderedOffWhileNoSatelliteWasSeen) {
    // A record that is sent from a whole second on is chosen by true time, however wrong the receiver's clock is.
    SyntheticSky sky = test::synthetic_sky(sample_time, test::four_systems);
    NavigationEngine engine(plain(FilterKind::none), {&sky});
    TrueReceiver receiver = receiver_at(antenna, sample_time);
    receiver.clock_bias_m = -0.4 * speed_of_light;
    const Fix fix = engine.solve(measure(sky, receiver), {});
    EXPECT_EQ(fix.time, receiver.time);
    EXPECT_LT(error_of(fix, receiver), 2e-6);
    Observations jumped = measure(sky, receiver_at(antenna, sample_time + std::chrono::seconds(1)));
    jumped.clock_was_set = true;
    const Fix after = engine.solve(jumped, {});
    EXPECT_EQ(after.time, sample_time + std::chrono::seconds(1));
}

TEST(NavigationEngine, ReportsTheGeoidAtTheFix) {
    const auto geoid = test::flat_geoid(27.5);
    ASSERT_TRUE(geoid);
    const SyntheticSky sky = test::synthetic_sky(sample_time, test::four_systems);
    NavigationEngine engine(plain(FilterKind::none), {&sky, &*geoid});
    const Fix fix = engine.solve(measure(sky, receiver_at(antenna, sample_time)), {});
    EXPECT_NEAR(fix.geoid_undulation.value(), 27.5, 1e-6);
    EXPECT_EQ(fix.leap_seconds, 18);
}

TEST(NavigationEngine, SurvivesNonsense) {
    const SyntheticSky sky = test::synthetic_sky(sample_time, test::four_systems);
    NavigationEngine engine(plain(FilterKind::smoothed), {&sky});
    Observations observations = measure(sky, receiver_at(antenna, sample_time));
    RandomStream random(1, "nonsense");
    for (int s = 0; s < 30; ++s) {
        Observations broken = observations;
        broken.receive_time += std::chrono::seconds(s);
        for (Observation& o : broken.signals) {
            o.pseudorange = Metres(random.normal() * std::pow(10, 30 * random.uniform()));
            if (s % 3 == 0) o.pseudorange = Metres(std::nan(""));
            o.doppler = Hertz(random.normal() * 1e6);
        }
        const Fix fix = engine.solve(broken, {});
        EXPECT_EQ(fix.satellites.empty(), false);
    }
}

}  // namespace
}  // namespace skyloop
