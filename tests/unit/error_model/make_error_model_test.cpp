#include "skyloop/error_model/make_error_model.hpp"

#include <gtest/gtest.h>

#include <string>
#include <typeinfo>

#include "skyloop/error_model/baseline.hpp"
#include "skyloop/error_model/constant_sigma.hpp"
#include "skyloop/error_model/ideal.hpp"
#include "skyloop/error_model/model_effects.hpp"
#include "skyloop/error_model/refraction.hpp"
#include "skyloop/error_model/satellite_count.hpp"
#include "skyloop/error_model/whole_path.hpp"
#include "support/model_sky.hpp"

namespace skyloop {
namespace {

TEST(ErrorModelNames, GoBothWays) {
    EXPECT_EQ(error_model_kinds().size(), 6u);
    for (const ErrorModelKind kind : error_model_kinds())
        EXPECT_EQ(error_model_from_name(error_model_name(kind)), kind);
    EXPECT_EQ(error_model_from_name("constant-sigma"), ErrorModelKind::constant_sigma);
    EXPECT_FALSE(error_model_from_name("modern"));
    EXPECT_FALSE(error_model_from_name(""));
}

template <class Model>
bool makes(ErrorModelKind kind) {
    ErrorModelSettings settings;
    settings.kind = kind;
    const auto model = make_error_model(settings);
    return dynamic_cast<Model*>(model.get()) != nullptr;
}

TEST(MakeErrorModel, MakesTheModelOfItsName) {
    EXPECT_TRUE(makes<Ideal>(ErrorModelKind::ideal));
    EXPECT_TRUE(makes<ConstantSigma>(ErrorModelKind::constant_sigma));
    EXPECT_TRUE(makes<SatelliteCount>(ErrorModelKind::satellite_count));
    EXPECT_TRUE(makes<WholePath>(ErrorModelKind::whole_path));
    EXPECT_TRUE(makes<Refraction>(ErrorModelKind::refraction));
    EXPECT_TRUE(makes<Baseline>(ErrorModelKind::baseline));
}

TEST(EffectsFor, ElectronContentComesFromTheHeaderWhenItHasCoefficients) {
    EffectSettings settings;
    settings.klobuchar = KlobucharCoefficients{{1e-8, 0, 0, 0}, {90000, 0, 0, 0}};
    const SkyView sky = test::sky_of({{40, 90}});
    const auto delay_with = [&](TecSource source) {
        settings.atmosphere.tec_source = source;
        test::ModelRun run({}, settings);
        return run.epoch(sky, 0).arrivals.satellites.front().iono_delay.value();
    };
    EXPECT_NEAR(delay_with(TecSource::constant), 5.0, 0.01);
    EXPECT_NEAR(delay_with(TecSource::automatic), 1.5, 0.01);
    EXPECT_EQ(delay_with(TecSource::automatic), delay_with(TecSource::header));
    settings.klobuchar.reset();
    EXPECT_EQ(delay_with(TecSource::automatic), delay_with(TecSource::constant));
}

TEST(EffectsFor, AHeaderWithoutCoefficientsIsRefusedWhereItMatters) {
    EffectSettings settings;
    settings.atmosphere.tec_source = TecSource::header;
    for (const ErrorModelKind kind : {ErrorModelKind::baseline, ErrorModelKind::whole_path}) {
        const auto effects = effects_for(kind, settings);
        ASSERT_FALSE(effects);
        EXPECT_EQ(effects.error().code, ErrorCode::input);
        EXPECT_NE(effects.error().message.find("ionosphere coefficients"), std::string::npos);
    }
    EXPECT_TRUE(effects_for(ErrorModelKind::ideal, settings));
}

}  // namespace
}  // namespace skyloop
