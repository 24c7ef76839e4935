// The modern profile's settings: presets, what `errors` does, and the names of models.
#include "run/scenario/modern_settings.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "run/scenario/scenario.hpp"

namespace skyloop {
namespace {

using testing::Contains;

TEST(ErrorTerms, EachIsNamedOnceAndIsItsOwn) {
    ModernSettings settings;
    const auto terms = error_terms(settings);
    EXPECT_EQ(terms.size(), 25U);
    std::set<std::string_view> names;
    std::set<const ErrorTerm*> places;
    for (const NamedTerm& named : terms) {
        EXPECT_TRUE(names.insert(named.name).second) << named.name;
        EXPECT_TRUE(places.insert(named.term).second) << named.name;
        EXPECT_EQ(named.term->factor(), 1) << named.name << " acts by default";
    }
    EXPECT_TRUE(names.contains("multipath"));
    EXPECT_TRUE(names.contains("receiver_clock"));
}

TEST(EffectiveSettings, WithoutErrorsEveryTermAndCorrectionIsOff) {
    ModernSettings settings;
    settings.errors = false;
    ModernSettings acting = effective(settings);
    for (const NamedTerm& named : error_terms(acting))
        EXPECT_EQ(named.term->factor(), 0) << named.name;
    EXPECT_EQ(acting.navigation.corrections.ionosphere, IonosphereCorrection::none);
    EXPECT_EQ(acting.navigation.corrections.troposphere, TroposphereCorrection::none);
}

TEST(EffectiveSettings, WithErrorsNothingIsSwitchedOff) {
    ModernSettings acting = effective(ModernSettings());
    for (const NamedTerm& named : error_terms(acting))
        EXPECT_TRUE(named.term->enabled) << named.name;
    EXPECT_EQ(acting.navigation.corrections.ionosphere, IonosphereCorrection::broadcast);
    EXPECT_EQ(acting.navigation.corrections.troposphere, TroposphereCorrection::niell);
}

TEST(EffectiveSettings, TheReceiverCorrectsForWhatThereIs) {
    ModernSettings no_air;
    no_air.propagation.troposphere.enabled = false;
    EXPECT_EQ(effective(no_air).navigation.corrections.troposphere, TroposphereCorrection::none);
    EXPECT_EQ(effective(no_air).navigation.corrections.ionosphere, IonosphereCorrection::broadcast);
    ModernSettings no_plasma;
    no_plasma.propagation.ionosphere.scale = 0;
    EXPECT_EQ(effective(no_plasma).navigation.corrections.ionosphere, IonosphereCorrection::none);
    EXPECT_EQ(effective(no_plasma).navigation.corrections.troposphere, TroposphereCorrection::niell);
}

TEST(EffectiveSettings, CorrectionsFromOutsideTakeWhatBothEndsSee) {
    const auto with = [](DifferentialKind kind) {
        ModernSettings settings;
        settings.navigation.differential.kind = kind;
        return effective(settings);
    };
    struct Left {
        DifferentialKind kind;
        double of_orbits, of_air, of_own;
    };
    for (const Left& left :
         {Left{DifferentialKind::none, 1, 1, 1}, Left{DifferentialKind::sbas, 0.1, 1, 1},
          Left{DifferentialKind::rtk_float, 0, 0, 0.15}, Left{DifferentialKind::rtk_fixed, 0, 0, 0.008}}) {
        const ModernSettings acting = with(left.kind);
        EXPECT_EQ(acting.propagation.signal_in_space.factor(), left.of_orbits);
        EXPECT_EQ(acting.propagation.ionosphere.factor(), left.of_orbits);
        EXPECT_EQ(acting.propagation.troposphere.factor(), left.of_air);
        EXPECT_EQ(acting.propagation.troposphere_residual.factor(), left.of_air);
        EXPECT_EQ(acting.measurement.multipath.factor(), left.of_own);
        EXPECT_EQ(acting.measurement.code_noise.factor(), left.of_own);
        EXPECT_EQ(acting.measurement.doppler_noise.factor(), 1) << "corrections do not touch a rover's Doppler";
        EXPECT_EQ(acting.measurement.phase_noise.factor(), 1);
    }
}

TEST(EffectiveSettings, ScintillationHasOneTermOnBothSidesOfTheAntenna) {
    ModernSettings settings;
    settings.propagation.scintillation.seed = 7;
    EXPECT_EQ(effective(settings).measurement.scintillation.seed, 7U);
}

TEST(EffectiveSettings, WhatIsNamedGoesBeforeIt) {
    ModernSettings settings;
    settings.errors = false;
    settings.ionosphere_correction = IonosphereCorrection::klobuchar;
    settings.troposphere_correction = TroposphereCorrection::saastamoinen;
    const CorrectionParameters named = effective(settings).navigation.corrections;
    EXPECT_EQ(named.ionosphere, IonosphereCorrection::klobuchar);
    EXPECT_EQ(named.troposphere, TroposphereCorrection::saastamoinen);
    settings.errors = true;
    settings.ionosphere_correction = IonosphereCorrection::none;
    EXPECT_EQ(effective(settings).navigation.corrections.ionosphere, IonosphereCorrection::none);
}

TEST(ModernSettings, AReceiverThatCorrectsNothingExpectsWhatIsThere) {
    ModernSettings settings;
    EXPECT_FALSE(effective(settings).navigation.accuracy.whole_ionosphere);
    EXPECT_FALSE(effective(settings).navigation.accuracy.whole_troposphere);
    settings.ionosphere_correction = IonosphereCorrection::none;
    settings.troposphere_correction = TroposphereCorrection::none;
    EXPECT_TRUE(effective(settings).navigation.accuracy.whole_ionosphere);
    EXPECT_TRUE(effective(settings).navigation.accuracy.whole_troposphere);
    settings.errors = false;
    EXPECT_FALSE(effective(settings).navigation.accuracy.whole_ionosphere) << "there is none";
    EXPECT_FALSE(effective(settings).navigation.accuracy.whole_troposphere);
}

TEST(ModernSettings, PresetsDiffer) {
    const ModernSettings survey = ModernSettings::of(ModernPreset::survey);
    const ModernSettings consumer = ModernSettings::of(ModernPreset::consumer);
    const ModernSettings phone = ModernSettings::of(ModernPreset::phone);
    EXPECT_LT(survey.measurement.multipath_model.floor, consumer.measurement.multipath_model.floor);
    EXPECT_LT(consumer.measurement.multipath_model.floor, phone.measurement.multipath_model.floor);
    EXPECT_LT(survey.measurement.code_loop.spacing_chips, consumer.measurement.code_loop.spacing_chips);
    const auto zenith = [](const ModernSettings& s) {
        return s.propagation.link.antenna.gain({Angle(), Angle::degrees(90)});
    };
    EXPECT_LT(zenith(phone), zenith(consumer));
    EXPECT_EQ(ModernSettings().preset, ModernPreset::consumer);
}

TEST(ModelNames, ModernIsTheFirstAndTheDefault) {
    EXPECT_EQ(model_names().front(), "modern");
    EXPECT_EQ(model_names().size(), error_model_kinds().size() + 1);
    EXPECT_EQ(model_name(ModelSettings{}), "modern");
    for (const ErrorModelKind kind : error_model_kinds())
        EXPECT_THAT(model_names(), Contains(error_model_name(kind)));
}

TEST(ModelNames, EachChoosesItsModelAndOthersChangeNothing) {
    ModelSettings settings;
    for (const std::string_view name : model_names()) {
        EXPECT_TRUE(choose_model(settings, name)) << name;
        EXPECT_EQ(model_name(settings), name);
        EXPECT_EQ(settings.sensor_model.has_value(), name != "modern");
    }
    ASSERT_TRUE(choose_model(settings, "refraction"));
    for (const char* unknown : {"", "Modern", "modern ", "basline"}) {
        EXPECT_FALSE(choose_model(settings, unknown)) << unknown;
        EXPECT_EQ(model_name(settings), "refraction");
    }
    EXPECT_TRUE(choose_model(settings, "modern"));
    EXPECT_FALSE(settings.sensor_model);
}

}  // namespace
}  // namespace skyloop
