#include "receiver/error_model/error_model.hpp"

#include <gtest/gtest.h>

#include <string>
#include <typeinfo>

#include "receiver/error_model/baseline.hpp"
#include "receiver/error_model/model_effects.hpp"
#include "receiver/error_model/simple_models.hpp"
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

TEST(EffectsFor, ElectronContentComesFromMapsThatCoverTheRun) {
    const GpsTime start = to_gps_time(2111, 0.0);
    EffectSettings settings;
    settings.atmosphere.tec_source = TecSource::ionex;
    const auto refusal = [&] {
        const auto effects = effects_for(ErrorModelKind::baseline, settings);
        return effects ? std::string("none") : effects.error().message;
    };
    EXPECT_EQ(refusal(), "the electron content is to come from maps and none are given; expected an IONEX file");
    IonosphereMaps maps;
    maps.latitude = {Angle::degrees(90), Angle::degrees(-90), 3};
    maps.longitude = {Angle::degrees(-180), Angle::degrees(90), 5};
    maps.maps = {{start, std::vector<double>(15, 20.0)},
                 {start + std::chrono::hours(2), std::vector<double>(15, 20.0)}};
    settings.maps = NamedIonosphereMaps{"day.i", maps};
    settings.run = {start, start + std::chrono::hours(3)};
    EXPECT_EQ(refusal().rfind("day.i: its maps span ", 0), 0U) << refusal();
    settings.run.last = start + std::chrono::hours(1);
    EXPECT_EQ(refusal(), "none");
    test::ModelRun run({}, settings);
    const SkyView sky = test::sky_of({{40, 90}});
    EXPECT_NEAR(run.epoch(sky, 0).arrivals.satellites.front().iono_delay.value(), 20 * 0.162, 0.01);
}

}  // namespace
}  // namespace skyloop
