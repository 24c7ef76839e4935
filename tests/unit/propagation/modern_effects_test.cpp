#include "world/propagation/modern_effects.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "modern_sky.hpp"
#include "world/gnss/atmosphere.hpp"

namespace skyloop {
namespace {

using std::chrono::seconds;

SkyView modern_test_sky() {
    SkyView sky = test::gps_ring(8, 35);
    for (int i = 0; i < 6; ++i)
        sky.satellites.push_back(test::satellite_at({Constellation::galileo, i + 1}, 60.0 * i, 10 + 12 * i));
    return sky;
}

// All arrivals of a few epochs under a storm.
std::vector<Arrivals> run_modern(const ModernPropagationParameters& parameters, ModernContext context) {
    context.run = {test::april_noon, test::april_noon + seconds(3600)};
    context.atmosphere.clouds = {cloud_catalogue().back()};
    context.atmosphere.rain.rate_mm_h = 60;
    auto effects = modern_effects(parameters, context);
    EXPECT_TRUE(effects) << (effects ? "" : effects.error().message);
    std::vector<Arrivals> epochs;
    const SkyView sky = modern_test_sky();
    for (int i = 0; i < 5; ++i) {
        epochs.push_back(free_space(sky));
        for (const auto& effect : *effects)
            effect->apply(epochs.back(), sky, test::truth_of(test::odessa_place, test::april_noon + seconds(400) * i));
    }
    return epochs;
}

ModernPropagationParameters everything_on() {
    ModernPropagationParameters parameters;
    parameters.loss_model.canopy_depth = Metres(4);
    parameters.loss_model.antenna_film = Decibels(1);
    parameters.scintillation_model.s4 = 0.4;
    parameters.scintillation_model.sigma_phi = Angle::radians(0.3);
    parameters.link.jammer_to_signal = Decibels(25);
    return parameters;
}

TEST(ModernEffects, EveryTermSwitchedOffLeavesNothing) {
    ModernPropagationParameters parameters = everything_on();
    for (ErrorTerm* term :
         {&parameters.signal_in_space, &parameters.ionosphere, &parameters.ionosphere_residual, &parameters.troposphere,
          &parameters.troposphere_residual, &parameters.gas, &parameters.clouds, &parameters.rain, &parameters.foliage,
          &parameters.antenna, &parameters.satellite_power, &parameters.scintillation, &parameters.interference})
        term->enabled = false;
    for (const Arrivals& epoch : run_modern(parameters, {})) {
        for (const Arrival& arrival : epoch.satellites) {
            EXPECT_EQ(arrival.signal_in_space_error.value(), 0);
            EXPECT_EQ(arrival.range_rate_error.value(), 0);
            EXPECT_EQ(arrival.iono_delay.value(), 0);
            EXPECT_EQ(arrival.tropo_delay.value(), 0);
            EXPECT_EQ(arrival.gas_loss.value(), 0);
            EXPECT_EQ(arrival.cloud_loss.value(), 0);
            EXPECT_EQ(arrival.rain_loss.value(), 0);
            EXPECT_EQ(arrival.foliage_loss.value(), 0);
            EXPECT_EQ(arrival.antenna_gain.value(), 0);
            EXPECT_EQ(arrival.power_offset.value(), 0);
            EXPECT_EQ(arrival.interference_loss.value(), 0);
            EXPECT_EQ(arrival.amplitude_scintillation, 0);
            EXPECT_EQ(arrival.phase_scintillation.rad(), 0);
            EXPECT_GT(arrival.cn0->value(), 40);
        }
    }
}

TEST(ModernEffects, EachTermAloneWritesItsOwnField) {
    const auto epochs = run_modern(everything_on(), {});
    for (const Arrival& arrival : epochs[2].satellites) {
        EXPECT_NE(arrival.signal_in_space_error.value(), 0);
        EXPECT_NE(arrival.range_rate_error.value(), 0);
        EXPECT_GT(arrival.iono_delay.value(), 0);
        EXPECT_GT(arrival.tropo_delay.value(), 2);
        EXPECT_GT(arrival.gas_loss.value(), 0.03);
        EXPECT_GT(arrival.cloud_loss.value(), 0);
        EXPECT_GT(arrival.rain_loss.value(), 0);
        EXPECT_NE(arrival.antenna_gain.value(), 0);
        EXPECT_NE(arrival.power_offset.value(), 0);
        EXPECT_GT(arrival.interference_loss.value(), 0);
        EXPECT_GT(arrival.amplitude_scintillation, 0);
        EXPECT_GT(arrival.phase_scintillation.rad(), 0);
    }
    EXPECT_GT(epochs[2].satellites[8].foliage_loss.value(), 3);
}

TEST(ModernEffects, TheSameSeedGivesTheSameArrivals) {
    const auto fields = [](const std::vector<Arrivals>& epochs) {
        std::vector<double> values;
        for (const Arrivals& epoch : epochs)
            for (const Arrival& a : epoch.satellites)
                values.insert(values.end(), {a.signal_in_space_error.value(), a.iono_delay.value(),
                                             a.tropo_delay.value(), a.cn0->value()});
        return values;
    };
    const auto first = fields(run_modern({}, {.seed = 5}));
    EXPECT_EQ(first, fields(run_modern({}, {.seed = 5})));
    EXPECT_NE(first, fields(run_modern({}, {.seed = 6})));
}

TEST(ModernEffects, MakeAResidualOnlyWhereTheReceiverCorrectsAllElse) {
    const auto delay = [](Choice choice, std::optional<IonosphereModel> correction) {
        ModernPropagationParameters parameters;
        parameters.ionosphere_model.model = IonosphereModel::klobuchar;
        parameters.ionosphere_model.residual = choice;
        ModernContext context;
        context.receiver_correction = correction;
        return run_modern(parameters, context)[3].satellites[2].iono_delay.value();
    };
    const double model = delay(Choice::off, {}), real = delay(Choice::on, {});
    EXPECT_NE(model, real);
    EXPECT_EQ(delay(Choice::automatic, {}), real);
    EXPECT_EQ(delay(Choice::automatic, IonosphereModel::klobuchar), real);
    EXPECT_EQ(delay(Choice::automatic, IonosphereModel::ntcm_g), model);
}

TEST(ModernEffects, MakeAResidualForGalileoWhereItsOwnModelIsTheTruth) {
    const Geodetic place = test::odessa_place;
    const SkyView sky{{test::satellite_at({Constellation::gps, 1}, 30, 40, place),
                       test::satellite_at({Constellation::galileo, 1}, 30, 40, place)}};
    const auto delays = [&](Choice choice) {
        ModernPropagationParameters parameters;
        parameters.ionosphere_model.model = IonosphereModel::ntcm_g;
        parameters.ionosphere_model.residual = choice;
        ModernContext context;
        context.receiver_correction = IonosphereModel::klobuchar;
        context.galileo_correction = IonosphereModel::ntcm_g;
        auto effects = modern_effects(parameters, context);
        if (!effects) throw std::runtime_error(effects.error().message);
        const TruthState truth = test::truth_of(place, test::april_noon);
        Arrivals arrivals = free_space(sky);
        for (const auto& effect : *effects)
            effect->apply(arrivals, sky, truth);
        return std::pair{arrivals.satellites[0].iono_delay.value(), arrivals.satellites[1].iono_delay.value()};
    };
    const auto model = delays(Choice::off), real = delays(Choice::on), automatic = delays(Choice::automatic);
    EXPECT_EQ(automatic.first, model.first);
    EXPECT_NE(real.second, model.second);
    EXPECT_EQ(automatic.second, real.second);
}

TEST(ModernEffects, FailWhenTheIonosphereIsMissing) {
    ModernPropagationParameters parameters;
    parameters.ionosphere_model.model = IonosphereModel::ionex;
    const auto effects = modern_effects(parameters, {});
    ASSERT_FALSE(effects);
    EXPECT_THAT(effects.error().message, testing::HasSubstr("expected an IONEX file"));
}

}  // namespace
}  // namespace skyloop
