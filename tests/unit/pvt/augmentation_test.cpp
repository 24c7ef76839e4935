// Corrections of SBAS satellites: when they are at hand, and what they do.
#include <gtest/gtest.h>

#include "plain_navigation.hpp"
#include "world/gnss/sbas_service.hpp"

namespace skyloop {
namespace {

using test::error_of;
using test::later;
using test::plain;
using test::receiver_at;
using test::sample_time;
using test::SyntheticSky;
using test::TrueReceiver;

const Geodetic in_europe = test::antenna, in_america = Geodetic::degrees(-23.5, -46.6, 800);

// GPS behind errors of 3 to 9 m, of which SBAS knows all.
Observations measured_behind_errors(const SyntheticSky& sky, const TrueReceiver& receiver) {
    Observations observations = test::measure(sky, receiver);
    for (Observation& o : observations.signals) {
        if (o.satellite.constellation != Constellation::gps) continue;
        o.augmentation = Metres(3 + o.satellite.number % 7);
        *o.pseudorange += *o.augmentation;
    }
    return observations;
}

struct AugmentedRun {
    explicit AugmentedRun(const Geodetic& place, bool wanted = true)
        : receiver(receiver_at(place, sample_time)), engine(plain(FilterKind::none), {&sky}) {
        // One that is seen is EGNOS's.
        for (const Observation& o : test::measure(sky, receiver).signals) {
            if (o.satellite.constellation != Constellation::sbas) continue;
            for (Ephemeris& record : sky.records())
                if (satellite_of(record) == o.satellite) std::get<KeplerEphemeris>(record).satellite.number = 36;
            break;
        }
        settings.sbas_ranging = false;
        settings.sbas_corrections = wanted;
    }
    Fix at(double second, bool hears_sbas = true) {
        const TrueReceiver now = later(receiver, second);
        Observations observations = measured_behind_errors(sky, now);
        if (!hears_sbas)
            std::erase_if(observations.signals,
                          [](const Observation& o) { return o.satellite.constellation == Constellation::sbas; });
        const Fix fix = engine.solve(observations, settings);
        error = error_of(fix, now);
        return fix;
    }

    SyntheticSky sky = test::synthetic_sky(sample_time, {Constellation::gps, Constellation::sbas});
    TrueReceiver receiver;
    NavigationEngine engine;
    ReceiverSettings settings;
    double error = 0;
};

TEST(Augmentation, TakesTheErrorsOffOnceItHasBeenHeard) {
    AugmentedRun run(in_europe);
    EXPECT_EQ(run.at(0).type, FixType::fix_3d);
    const double before = run.error;
    EXPECT_EQ(run.at(40).type, FixType::fix_3d);
    EXPECT_EQ(run.at(50).type, FixType::dgnss);
    EXPECT_LT(run.error, 0.2 * before);
    EXPECT_EQ(run.at(75, false).type, FixType::dgnss) << "they are kept for half a minute";
    EXPECT_EQ(run.at(85, false).type, FixType::fix_3d);
    EXPECT_EQ(run.at(90).type, FixType::fix_3d) << "and collected anew";
}

TEST(Augmentation, ServesWhereItsGridReachesAndWhereItIsWanted) {
    AugmentedRun unwanted(in_europe, false);
    AugmentedRun far(in_america);
    for (const double second : {0.0, 30.0, 60.0, 120.0}) {
        EXPECT_EQ(unwanted.at(second).type, FixType::fix_3d);
        EXPECT_EQ(far.at(second).type, FixType::fix_3d);
    }
}

TEST(SbasService, KnowsWhoseASatelliteIsAndWhereItServes) {
    EXPECT_EQ(sbas_system(133), SbasSystem::waas);
    EXPECT_EQ(sbas_system(136), SbasSystem::egnos);
    EXPECT_FALSE(sbas_system(140));
    EXPECT_TRUE(serves(SbasSystem::waas, Geodetic::degrees(40, -105, 1600)));
    EXPECT_FALSE(serves(SbasSystem::egnos, Geodetic::degrees(40, -105, 1600)));
    EXPECT_TRUE(serves(SbasSystem::msas, Geodetic::degrees(36, 140, 0)));
    EXPECT_TRUE(serves(SbasSystem::gagan, Geodetic::degrees(13, 77, 900)));
}

}  // namespace
}  // namespace skyloop
