// Every key lands in its field, whatever the order of the keys.
#include "run/scenario/scenario_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "base/time/utc_time.hpp"
#include "scenario_text.hpp"

namespace skyloop {
namespace {

using test::scenario_of;
using testing::ElementsAre;
using testing::SizeIs;

GpsTime instant_of(std::string_view utc) { return to_gps_time(parse_utc(utc).value(), LeapSeconds::announced()); }

void expect_place(const Geodetic& place, double latitude, double longitude, double height) {
    EXPECT_NEAR(place.latitude.deg(), latitude, 1e-12);
    EXPECT_NEAR(place.longitude.deg(), longitude, 1e-12);
    EXPECT_NEAR(place.height.above_ellipsoid.value(), height, 1e-9);
}

TEST(ScenarioFile, AnEmptyFileIsTheDefaults) {
    const Scenario s = scenario_of("");
    EXPECT_FALSE(s.run.start);
    EXPECT_FALSE(s.run.start_now);
    EXPECT_FALSE(s.run.duration);
    EXPECT_EQ(s.run.seed, 1U);
    EXPECT_EQ(s.run.speed, 1);
    EXPECT_TRUE(s.sky.navigation.empty());
    EXPECT_FALSE(s.sky.ephemeris_rule);
    EXPECT_FALSE(s.model.sensor_model) << "modern";
    EXPECT_EQ(model_name(s.model), "modern");
    EXPECT_TRUE(std::holds_alternative<FixedSettings>(s.trajectory));
    ASSERT_EQ(s.receivers.size(), 1U);
    EXPECT_EQ(s.receivers[0].board, "ublox-m8");
    EXPECT_TRUE(s.receivers[0].ports.empty());
    EXPECT_TRUE(s.warnings.empty());
    EXPECT_EQ(s.name, "folder/test.toml");
}

TEST(ScenarioFile, EveryRunAndSkyKeyLandsInItsField) {
    const Scenario s = scenario_of(test::every_key_text);
    EXPECT_EQ(s.source, test::every_key_text);
    EXPECT_EQ(s.run.start, instant_of("2024-03-05T12:00:00.5Z"));
    EXPECT_FALSE(s.run.start_now);
    EXPECT_EQ(s.run.duration, Seconds(12.5));
    EXPECT_EQ(s.run.seed, 42U);
    EXPECT_EQ(s.run.speed, 2.5);
    EXPECT_THAT(s.sky.navigation,
                ElementsAre(std::filesystem::path("folder/a.rnx"), std::filesystem::path("folder/sub/b.rnx.gz")));
    EXPECT_TRUE(s.sky.rebase_navigation);
    EXPECT_THAT(s.sky.constellations, ElementsAre(Constellation::gps, Constellation::qzss));
    EXPECT_NEAR(s.sky.elevation_mask.value().deg(), 12.5, 1e-12);
    EXPECT_EQ(s.sky.ephemeris_rule, EphemerisRule::nearest);
    EXPECT_EQ(s.sky.ephemeris_validity, Seconds(3600));
    ASSERT_TRUE(std::holds_alternative<CircleSettings>(s.trajectory));
    const Circle::Shape& circle = std::get<CircleSettings>(s.trajectory).shape;
    expect_place(circle.centre, 10.5, -20.25, 300);
    EXPECT_EQ(circle.radius, Metres(250));
    EXPECT_EQ(circle.speed, MetresPerSecond(-7));
    EXPECT_NEAR(circle.start_azimuth.deg(), 45, 1e-12);
}

TEST(ScenarioFile, EveryModelKeyLandsInItsField) {
    const ModelSettings m = scenario_of(test::every_key_text).model;
    EXPECT_EQ(m.sensor_model, ErrorModelKind::whole_path);
    EXPECT_EQ(m.baseline.snr_cutoff, DbHz(6.5));
    EXPECT_EQ(m.link.max_reflections, 3);
    EXPECT_EQ(m.link.reflection_loss, Decibels(4.5));
    EXPECT_EQ(m.link.power_mode, PowerMode::received_spec);
    EXPECT_EQ(m.link.satellite_power, DecibelWatts(27.5));
    EXPECT_EQ(m.link.specified_received_power, DecibelWatts(-157.5));
    EXPECT_EQ(m.link.thermal_noise_dbw_hz, -203.5);
    EXPECT_EQ(m.baseline.statistic, UereStatistic::rms);
    EXPECT_EQ(m.baseline.iono_fraction, 0.25);
    EXPECT_EQ(m.baseline.tropo_fraction, 0.75);
    EXPECT_EQ(m.baseline.axes, NoiseAxes::covariance);
    EXPECT_EQ(m.constant_sigma.horizontal_sigma, Metres(1.5));
    EXPECT_EQ(m.constant_sigma.vertical_sigma, Metres(2.5));
    EXPECT_THAT(m.satellite_count.sigma_m, ElementsAre(13, 9, 6, 5, 4, 3));
    EXPECT_EQ(m.whole_path.oxygen_height_km, 5.5);
    EXPECT_EQ(m.whole_path.vapour_height_km, 1.75);
    EXPECT_EQ(m.whole_path.vapour_g_m3, 8.5);
    EXPECT_EQ(m.whole_path.oxygen_db_per_km, 0.0075);
    EXPECT_EQ(m.whole_path.vapour_db_per_km_per_g_m3, 0.000025);
    EXPECT_EQ(m.refraction.surface_refractivity, 325);
    EXPECT_EQ(m.refraction.scale_height, Metres(7250));
    EXPECT_EQ(m.refraction.residual_fraction, 0.125);
}

TEST(ScenarioFile, EveryAtmosphereKeyLandsInItsField) {
    const AtmosphereParameters a = scenario_of(test::every_key_text).atmosphere;
    EXPECT_EQ(a.total_electron_content, Tecu(12.5));
    EXPECT_EQ(a.tec_source, TecSource::header);
    EXPECT_EQ(a.ionosphere_loss, Decibels(0.5));
    EXPECT_EQ(a.riometer_absorption_30mhz, Decibels(1.5));
    EXPECT_EQ(a.ionosphere_base, Metres(70000));
    EXPECT_EQ(a.environment_noise, Decibels(17.5));
    EXPECT_EQ(a.sea_level_temperature, Kelvin(290.5));
    EXPECT_EQ(a.oxygen_constant, 0.227);
    EXPECT_EQ(a.zenith_dry_delay, Metres(2.25));
    EXPECT_EQ(a.zenith_dry_decay_per_m, 0.000125);
    EXPECT_EQ(a.zenith_wet_delay, Metres(0.25));
    EXPECT_EQ(a.rain.rate_mm_h, 12.5);
    EXPECT_EQ(a.rain.top, Metres(3500));
    EXPECT_EQ(a.rain.model, RainModel::as_vapour);
    EXPECT_TRUE(a.clouds_apply_concentration);
    EXPECT_EQ(a.gravity_mps2, 9.75);
    EXPECT_EQ(a.molar_mass_kg_per_mol, 0.03);
    EXPECT_EQ(a.gas_constant, 8.25);
    EXPECT_EQ(a.earth_radius, Metres(6372000));
}

TEST(ScenarioFile, LayersReplaceTheDefaultOnesAndOneWordServesAll) {
    const AtmosphereParameters a = scenario_of(test::every_key_text).atmosphere;
    ASSERT_THAT(a.layers, SizeIs(2));
    EXPECT_EQ(a.layers[0].name, "low");
    EXPECT_EQ(a.layers[0].base, Metres(10));
    EXPECT_EQ(a.layers[0].top, Metres(9000));
    EXPECT_EQ(a.layers[0].vapour_g_m3, 6.5);
    EXPECT_FALSE(a.layers[0].enabled);
    EXPECT_EQ(a.layers[0].concentration, ConcentrationMode::fixed) << "a layer's own word goes before the common one";
    EXPECT_EQ(a.layers[0].fixed_concentration, 0.375);
    EXPECT_EQ(a.layers[1].concentration, ConcentrationMode::midpoint);
    EXPECT_EQ(a.layers[1].fixed_concentration, 0.625);
    EXPECT_TRUE(a.layers[1].enabled);

    const AtmosphereParameters defaults =
        scenario_of("[atmosphere]\nconcentration = \"fixed\"\nfixed_concentration = 0.125").atmosphere;
    ASSERT_EQ(defaults.layers.size(), default_layers().size());
    for (const AtmosphericLayer& layer : defaults.layers) {
        EXPECT_EQ(layer.concentration, ConcentrationMode::fixed) << layer.name;
        EXPECT_EQ(layer.fixed_concentration, 0.125) << layer.name;
    }
}

TEST(ScenarioFile, CloudsComeFromTheCatalogueUnlessTheirNumbersAreGiven) {
    const AtmosphereParameters a = scenario_of(test::every_key_text).atmosphere;
    ASSERT_THAT(a.clouds, SizeIs(1));
    EXPECT_EQ(a.clouds[0].kind, "thunderstorm");
    EXPECT_EQ(a.clouds[0].base, Metres(750));
    EXPECT_EQ(a.clouds[0].top, Metres(8750));
    EXPECT_EQ(a.clouds[0].density_g_m3, 1.125);

    for (const CloudDeck& deck : cloud_catalogue()) {
        const auto clouds = scenario_of("[[atmosphere.cloud]]\nkind = \"" + deck.kind + "\"").atmosphere.clouds;
        ASSERT_THAT(clouds, SizeIs(1));
        EXPECT_EQ(clouds[0].kind, deck.kind);
        EXPECT_EQ(clouds[0].base, deck.base);
        EXPECT_EQ(clouds[0].top, deck.top);
        EXPECT_EQ(clouds[0].density_g_m3, deck.density_g_m3);
    }
    const auto raised = scenario_of("[[atmosphere.cloud]]\nkind = \"cumulus\"\nbase_m = 5000").atmosphere.clouds[0];
    const auto cumulus = std::find_if(cloud_catalogue().begin(), cloud_catalogue().end(),
                                      [](const CloudDeck& deck) { return deck.kind == "cumulus"; });
    EXPECT_NEAR((raised.top - raised.base).value(), (cumulus->top - cumulus->base).value(), 1e-9)
        << "a raised cloud keeps its thickness";
}

TEST(ScenarioFile, EnvironmentsAreNoiseOverThermal) {
    for (const Environment& e : environment_catalogue()) {
        const Scenario s = scenario_of("[atmosphere]\nenvironment = \"" + std::string(e.name) + "\"");
        EXPECT_EQ(s.atmosphere.environment_noise, e.noise) << e.name;
    }
}

TEST(ScenarioFile, AnElectronContentSwitchesTheBroadcastCoefficientsOff) {
    EXPECT_EQ(scenario_of("").atmosphere.tec_source, TecSource::automatic);
    EXPECT_EQ(scenario_of("[atmosphere]\ntotal_electron_content_tecu = 30.86").atmosphere.tec_source,
              TecSource::constant);
    EXPECT_EQ(
        scenario_of("[atmosphere]\ntotal_electron_content_tecu = 9\ntec_source = \"automatic\"").atmosphere.tec_source,
        TecSource::automatic);
}

TEST(ScenarioFile, MapsOfTheElectronContentAreItsSource) {
    const Scenario maps = scenario_of("[atmosphere]\ntec_maps = \"day.i\"");
    EXPECT_EQ(maps.atmosphere.tec_source, TecSource::ionex);
    EXPECT_EQ(maps.tec_maps.filename(), "day.i");
    const Scenario other = scenario_of(test::every_key_text);
    EXPECT_EQ(other.atmosphere.tec_source, TecSource::header) << "a source that is named goes before them";
    EXPECT_EQ(other.tec_maps.filename(), "day.i");
}

TEST(ScenarioFile, ExplicitKeysGoBeforeThePresetInAnyOrder) {
    const auto fractions = [](std::string_view keys) {
        const BaselineParameters p = scenario_of("[model.baseline]\n" + std::string(keys)).model.baseline;
        return std::pair(p.iono_fraction, p.tropo_fraction);
    };
    EXPECT_EQ(fractions(""), std::pair(1.0, 1.0));
    EXPECT_EQ(fractions("preset = \"strict\""), std::pair(1.0, 1.0));
    EXPECT_EQ(fractions("preset = \"calibrated\""), std::pair(0.5, 0.1));
    EXPECT_EQ(fractions("preset = \"calibrated\"\niono_fraction = 0.7"), std::pair(0.7, 0.1));
    EXPECT_EQ(fractions("iono_fraction = 0.7\npreset = \"calibrated\""), std::pair(0.7, 0.1));
    EXPECT_EQ(fractions("tropo_fraction = 0.3\npreset = \"strict\""), std::pair(1.0, 0.3));
}

TEST(ScenarioFile, EveryModelIsFoundByItsName) {
    for (const ErrorModelKind kind : error_model_kinds())
        EXPECT_EQ(scenario_of("[model]\nname = \"" + std::string(error_model_name(kind)) + "\"").model.sensor_model,
                  kind);
    EXPECT_FALSE(scenario_of("[model]\nname = \"modern\"").model.sensor_model);
}

TEST(ScenarioFile, AStartIsUtcInEveryForm) {
    const auto start = [](std::string_view value) {
        return scenario_of("[run]\nstart = " + std::string(value)).run.start;
    };
    const GpsTime noon = instant_of("2024-03-05T12:00:00Z");
    EXPECT_EQ(start("\"2024-03-05T12:00:00Z\""), noon);
    EXPECT_EQ(start("2024-03-05T12:00:00Z"), noon);
    EXPECT_EQ(start("2024-03-05T12:00:00+00:00"), noon);
    EXPECT_EQ(start("2024-03-05T12:00:00"), noon) << "a local date and time is read as UTC";
    EXPECT_EQ(start("2024-03-05 12:00:00.125"), noon + std::chrono::milliseconds(125));
    EXPECT_EQ(start("2024-03-05T14:00:00+02:00"), noon) << "a zone is taken away";
    EXPECT_EQ(start("2024-03-05T08:29:59.5-03:30"), noon - std::chrono::milliseconds(500));
    EXPECT_EQ(start("2024-03-05"), noon - std::chrono::hours(12)) << "a day is its midnight";
    const Scenario now = scenario_of("[run]\nstart = \"now\"");
    EXPECT_TRUE(now.run.start_now);
    EXPECT_FALSE(now.run.start);
}

TEST(ScenarioFile, ANavigationFileMayStandAlone) {
    EXPECT_THAT(scenario_of("[sky]\nnavigation = \"x.rnx\"").sky.navigation,
                ElementsAre(std::filesystem::path("folder/x.rnx")));
    EXPECT_THAT(scenario_of("[sky]\nnavigation = \"/abs/x.rnx\"").sky.navigation,
                ElementsAre(std::filesystem::path("/abs/x.rnx")));
}

TEST(ScenarioFile, ReceiverKeysLandInTheirFields) {
    const ReceiverEntry r = scenario_of(test::every_key_text).receivers[0];
    EXPECT_EQ(r.board, "ublox-f9p");
    EXPECT_THAT(r.ports, ElementsAre("pty:/tmp/gps", "file:out.nmea"));
    EXPECT_EQ(r.rate_hz, 7.5);
    EXPECT_EQ(r.baud, 57600U);
    EXPECT_THAT(r.sentences, ElementsAre(firmware::NmeaSentence::zda, firmware::NmeaSentence::rmc));
    EXPECT_THAT(scenario_of("[[receiver]]\nport = \"-\"").receivers[0].ports, ElementsAre("-"));
}

TEST(ScenarioFile, EveryShippedScenarioIsReadWithoutAMistake) {
    int count = 0;
    for (const auto& entry : std::filesystem::directory_iterator(SKYLOOP_SOURCE_DIR "/tools/scenarios")) {
        if (entry.path().extension() != ".toml") continue;
        const auto scenario = read_scenario_file(entry.path());
        ASSERT_TRUE(scenario) << scenario.error().message;
        EXPECT_TRUE(scenario->run.duration) << entry.path() << ": an example ends by itself";
        EXPECT_THAT(scenario->warnings, testing::IsEmpty());
        ++count;
    }
    EXPECT_GE(count, 3);
}

TEST(ScenarioFile, AMissingFileIsTheOutsideWorldsFailure) {
    const auto scenario = read_scenario_file("/no/such/scenario.toml");
    ASSERT_FALSE(scenario);
    EXPECT_EQ(scenario.error().code, ErrorCode::outside);
    EXPECT_THAT(scenario.error().message, testing::HasSubstr("/no/such/scenario.toml"));
}

}  // namespace
}  // namespace skyloop
