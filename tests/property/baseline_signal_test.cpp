// Behaviours B-10 and B-12 to B-15 of MODELS.md section 9: what moves the baseline's C/N0 and error scale, and how
// much.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "receiver/error_model/baseline.hpp"
#include "support/model_sky.hpp"
#include "world/propagation/specific_attenuation.hpp"

namespace skyloop {
namespace {

using test::ModelRun;

const SkyView signal_sky = test::sky_of(test::ten_spots());

template <class Change>
Trace first_epoch(const EffectSettings& effects, Change&& change, const ErrorModelSettings& settings = {}) {
    ModelRun run(settings, effects);
    return run.epoch(signal_sky, 0, change);
}

Trace first_epoch(const EffectSettings& effects) {
    return first_epoch(effects, [](Arrivals&) {});
}

double error_scale(const Trace& trace, const BaselineParameters& parameters = {}) {
    return uere_scale(trace.epoch.fix, trace.arrivals, parameters).position_error.value();
}

TEST(OxygenConstant, ChangesOxygenByOnePointEightPercentAndTheFixNotAtAll) {
    EffectSettings printed, source;
    source.atmosphere.oxygen_constant = 0.227;
    for (AtmosphereParameters* atmosphere : {&printed.atmosphere, &source.atmosphere}) {
        atmosphere->layers = default_layers();
        atmosphere->layers.front().vapour_g_m3 = 0;
    }
    const Trace a = first_epoch(printed);
    const Trace b = first_epoch(source);
    for (std::size_t i = 0; i < signal_sky.satellites.size(); ++i) {
        const double ratio = a.arrivals.satellites[i].gas_loss.value() / b.arrivals.satellites[i].gas_loss.value();
        EXPECT_NEAR(ratio - 1, -0.018, 0.0005);
    }
    EXPECT_EQ(a.epoch.fix.position.latitude, b.epoch.fix.position.latitude);
}

TEST(ErrorScale, DoublesWithTheElectronContentThatDrivesIt) {
    ErrorModelSettings settings;
    settings.baseline.tropo_fraction = 0;
    EffectSettings once, twice;
    once.atmosphere.total_electron_content = Tecu(20);
    twice.atmosphere.total_electron_content = Tecu(40);
    const auto nothing = [](Arrivals&) {};
    const double e1 = error_scale(first_epoch(once, nothing, settings), settings.baseline);
    const double e2 = error_scale(first_epoch(twice, nothing, settings), settings.baseline);
    EXPECT_GT(e1, 1);
    EXPECT_NEAR(e2 / e1, 2, 1e-12);
}

TEST(ErrorScale, VanishesWhenAllSatellitesErrAlike) {
    const auto equal_delays = [](Arrivals& arrivals) {
        for (Arrival& arrival : arrivals.satellites) {
            arrival.iono_delay = Metres(7);
            arrival.tropo_delay = Metres(4);
        }
    };
    const Trace trace = first_epoch({}, equal_delays);
    EXPECT_NEAR(error_scale(trace), 0, 1e-12);
    EXPECT_LT(test::position_error(trace).norm(), 1e-8);
    BaselineParameters rms;
    rms.statistic = UereStatistic::rms;
    EXPECT_NEAR(error_scale(trace, rms), 11 * trace.epoch.fix.dop.pdop, 1e-9);
}

TEST(EnvironmentNoise, LowersEverySignalByItsDecibels) {
    EffectSettings quiet, loud;
    loud.atmosphere.environment_noise = Decibels(40);
    const Trace a = first_epoch(quiet);
    const Trace b = first_epoch(loud);
    for (std::size_t i = 0; i < signal_sky.satellites.size(); ++i) {
        const double fall = a.arrivals.satellites[i].cn0->value() - b.arrivals.satellites[i].cn0->value();
        EXPECT_NEAR(fall, 39, 1e-9);
    }
    EXPECT_EQ(b.epoch.fix.satellites_used(), 10);
}

TEST(EnvironmentNoise, OfFortyFourDecibelsLosesTheFix) {
    for (const double noise : {44.0, 50.0}) {
        EffectSettings effects;
        effects.atmosphere.environment_noise = Decibels(noise);
        const Trace trace = first_epoch(effects);
        EXPECT_EQ(trace.epoch.fix.type, FixType::none);
        for (const Arrival& arrival : trace.arrivals.satellites)
            EXPECT_LT(*arrival.cn0, DbHz(5));
    }
}

// A street canyon that closes over the even satellites.
struct Canyon {
    int reflections;
    double detour_m;
    void operator()(Arrivals& arrivals) const {
        for (std::size_t i = 0; i < arrivals.satellites.size(); i += 2) {
            Arrival& arrival = arrivals.satellites[i];
            arrival.line_of_sight = false;
            arrival.reflections = reflections;
            arrival.excess_path = Metres(detour_m);
        }
    }
};

TEST(Reflections, CostThreeDecibelsEachAndTheirDetourSpreadsTheErrors) {
    const Trace open = first_epoch({});
    for (const int n : {1, 2, 5}) {
        SCOPED_TRACE(n);
        const Trace canyon = first_epoch({}, Canyon{n, 40.0 * n});
        for (std::size_t i = 0; i < signal_sky.satellites.size(); ++i) {
            const double fall = open.arrivals.satellites[i].cn0->value() - canyon.arrivals.satellites[i].cn0->value();
            EXPECT_NEAR(fall, i % 2 == 0 ? 3.0103 * n : 0, 1e-9);
        }
        EXPECT_EQ(canyon.epoch.fix.satellites_used(), 10);
        const Metres before = uere_scale(open.epoch.fix, open.arrivals, {}).sigma_uere;
        const Metres after = uere_scale(canyon.epoch.fix, canyon.arrivals, {}).sigma_uere;
        EXPECT_GT(after, before + Metres(5));
        EXPECT_GT(canyon.epoch.fix.horizontal_accuracy, open.epoch.fix.horizontal_accuracy);
    }
}

TEST(Reflections, SeventeenHideASatelliteHoweverStrongItIs) {
    EffectSettings strong;
    strong.link_budget.satellite_power = DecibelWatts(80);
    EXPECT_EQ(first_epoch(strong, Canyon{16, 100}).epoch.fix.satellites_used(), 10);
    const Fix fix = first_epoch(strong, Canyon{17, 100}).epoch.fix;
    EXPECT_EQ(fix.satellites_used(), 5);
    for (std::size_t i = 0; i < fix.satellites.size(); ++i)
        EXPECT_EQ(fix.satellites[i].cn0.has_value(), i % 2 == 1);
}

// MODELS.md D-12.
TEST(Reflections, WithTheDefaultPowerNoMoreThanThirteenLowAndFourteenHighSurvive) {
    const auto survives = [](double elevation_deg, int reflections) {
        ModelRun run({});
        const auto reflect = [=](Arrivals& arrivals) { arrivals.satellites.front().reflections = reflections; };
        return *run.epoch(test::sky_of({{0, elevation_deg}}), 0, reflect).arrivals.satellites.front().cn0 >= DbHz(5);
    };
    EXPECT_TRUE(survives(5, 13));
    EXPECT_FALSE(survives(5, 14));
    EXPECT_TRUE(survives(90, 14));
    EXPECT_FALSE(survives(90, 15));
}

TEST(Clouds, ChangeSignalsByLessThanAHundredthOfADecibel) {
    const Trace clear = first_epoch({});
    for (const CloudDeck& cloud : cloud_catalogue()) {
        SCOPED_TRACE(cloud.kind);
        EffectSettings effects;
        effects.atmosphere.clouds = {cloud};
        const Trace cloudy = first_epoch(effects);
        for (std::size_t i = 0; i < signal_sky.satellites.size(); ++i) {
            const double fall = clear.arrivals.satellites[i].cn0->value() - cloudy.arrivals.satellites[i].cn0->value();
            EXPECT_GT(fall, 0);
            EXPECT_LT(fall, 0.01);
        }
    }
}

TEST(Clouds, TakeMoreTheDenserTheirKind) {
    double last = 0;
    for (const std::string kind : {"fog", "stratus", "cumulus", "nimbostratus", "thunderstorm"}) {
        SCOPED_TRACE(kind);
        EffectSettings effects;
        for (const CloudDeck& cloud : cloud_catalogue())
            if (cloud.kind == kind) effects.atmosphere.clouds.push_back(cloud);
        ASSERT_EQ(effects.atmosphere.clouds.size(), 1u);
        const double loss = first_epoch(effects).arrivals.satellites.front().cloud_loss.value();
        EXPECT_GT(loss, last);
        last = loss;
    }
    for (const CloudDeck& cloud : cloud_catalogue()) {
        EffectSettings effects;
        effects.atmosphere.clouds = {cloud};
        EXPECT_LE(first_epoch(effects).arrivals.satellites.front().cloud_loss.value(), last) << cloud.kind;
    }
}

}  // namespace
}  // namespace skyloop
