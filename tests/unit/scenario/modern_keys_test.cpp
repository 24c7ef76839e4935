// Every key of [model.modern] lands in its field; presets, surroundings and terms do what they say.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <functional>

#include "scenario_text.hpp"

namespace skyloop {
namespace {

using test::mistakes_of;
using test::scenario_of;
using testing::HasSubstr;

ModernSettings modern_of(const std::string& keys) { return scenario_of(keys).model.modern; }

// A key under [model.modern.TABLE], a value that is not its default, and what the reader is to make of it.
struct Key {
    std::string table, key, value;
    std::function<double(const ModernSettings&)> found;
    double expected;
};

template <class Enumeration>
double number_of_word(Enumeration word) {
    return static_cast<double>(static_cast<int>(word));
}

void expect_keys(const std::vector<Key>& keys) {
    for (const Key& k : keys) {
        const std::string name = k.table + "." + k.key;
        EXPECT_NE(k.found(ModernSettings()), k.expected) << name << ": a value that is the default proves nothing";
        const ModernSettings read = modern_of("[model.modern." + k.table + "]\n" + k.key + " = " + k.value);
        EXPECT_NEAR(k.found(read), k.expected, 1e-12) << name;
        // The wrong type has a line, a column and the key's full name.
        EXPECT_THAT(mistakes_of("[model.modern." + k.table + "]\n" + k.key + " = 1979-05-27"),
                    HasSubstr("test.toml:2:" + std::to_string(k.key.size() + 4) + ": model.modern." + name + ": "));
    }
}

#define SKYLOOP_FIELD(path) [](const ModernSettings& s) { return s.path.value(); }
#define SKYLOOP_PLAIN(path) [](const ModernSettings& s) { return static_cast<double>(s.path); }
#define SKYLOOP_WORD(path) [](const ModernSettings& s) { return number_of_word(s.path); }

TEST(ModernKeys, OfTheSignalInSpaceAndTheIonosphere) {
    expect_keys({
        {"signal_in_space", "gps_m", "0.5", SKYLOOP_FIELD(propagation.signal_in_space_model.gps), 0.5},
        {"signal_in_space", "sbas_m", "0.25", SKYLOOP_FIELD(propagation.signal_in_space_model.sbas), 0.25},
        {"signal_in_space", "galileo_m", "0.75", SKYLOOP_FIELD(propagation.signal_in_space_model.galileo), 0.75},
        {"signal_in_space", "beidou2_m", "1.5", SKYLOOP_FIELD(propagation.signal_in_space_model.beidou2), 1.5},
        {"signal_in_space", "beidou3_m", "1.75", SKYLOOP_FIELD(propagation.signal_in_space_model.beidou3), 1.75},
        {"signal_in_space", "qzss_m", "2", SKYLOOP_FIELD(propagation.signal_in_space_model.qzss), 2},
        {"signal_in_space", "glonass_m", "3", SKYLOOP_FIELD(propagation.signal_in_space_model.glonass), 3},
        {"signal_in_space", "navic_m", "4", SKYLOOP_FIELD(propagation.signal_in_space_model.navic), 4},
        {"signal_in_space", "correlation_time_s", "60",
         SKYLOOP_FIELD(propagation.signal_in_space_model.correlation_time), 60},
        {"ionosphere", "truth", "\"constant\"", SKYLOOP_WORD(propagation.ionosphere_model.model),
         number_of_word(IonosphereModel::constant)},
        {"ionosphere", "content_tecu", "12.5", SKYLOOP_FIELD(propagation.ionosphere_model.constant_content), 12.5},
        {"ionosphere", "ionisation", "[1, 2, 3.5]",
         [](const ModernSettings& s) { return s.propagation.ionosphere_model.ionisation.a2; }, 3.5},
        {"ionosphere", "klobuchar_alpha", "[1e-8, 2e-8, 3e-8, 4e-8]",
         [](const ModernSettings& s) { return s.propagation.ionosphere_model.klobuchar.alpha[3] * 1e8; }, 4},
        {"ionosphere", "klobuchar_beta", "[1e4, 2e4, 3e4, 4e4]",
         [](const ModernSettings& s) { return s.propagation.ionosphere_model.klobuchar.beta[1]; }, 2e4},
        {"ionosphere", "residual", "\"off\"", SKYLOOP_WORD(propagation.ionosphere_model.residual),
         number_of_word(Choice::off)},
        {"ionosphere", "residual_common", "0.5", SKYLOOP_PLAIN(propagation.ionosphere_model.common), 0.5},
        {"ionosphere", "residual_gradient", "0.5", SKYLOOP_PLAIN(propagation.ionosphere_model.gradient), 0.5},
        {"ionosphere", "residual_common_time_s", "60", SKYLOOP_FIELD(propagation.ionosphere_model.common_time), 60},
        {"ionosphere", "residual_single", "0.5", SKYLOOP_PLAIN(propagation.ionosphere_model.single), 0.5},
        {"ionosphere", "residual_single_time_s", "60", SKYLOOP_FIELD(propagation.ionosphere_model.single_time), 60},
        {"ionosphere", "disturbance_tecu", "4", SKYLOOP_FIELD(propagation.ionosphere_model.waves.content), 4},
        {"ionosphere", "disturbance_speed_mps", "500", SKYLOOP_FIELD(propagation.ionosphere_model.waves.speed), 500},
    });
    EXPECT_EQ(modern_of("[model.modern.ionosphere]\ntruth = \"ionex\"\nmaps = \"day.i\"").ionosphere_maps,
              "folder/day.i")
        << "beside the scenario";
    EXPECT_EQ(mistakes_of("[model.modern.ionosphere]\ntruth = \"ionex\""),
              "test.toml:2:9: model.modern.ionosphere.truth: is ionex, but maps names no file; expected an IONEX file");
}

TEST(ModernKeys, OfTheTroposphereAndLosses) {
    expect_keys({
        {"troposphere", "weather", "\"gpt\"", SKYLOOP_WORD(propagation.troposphere_model.weather),
         number_of_word(WeatherSource::gpt)},
        {"troposphere", "relative_humidity", "0.75", SKYLOOP_PLAIN(propagation.troposphere_model.relative_humidity),
         0.75},
        {"troposphere", "pressure_hpa", "950.5", SKYLOOP_PLAIN(propagation.troposphere_model.pressure_hpa), 950.5},
        {"troposphere", "temperature_k", "290.5", SKYLOOP_FIELD(propagation.troposphere_model.temperature), 290.5},
        {"troposphere", "sea_level_vapour_g_m3", "9.5",
         SKYLOOP_PLAIN(propagation.troposphere_model.sea_level_vapour_g_m3), 9.5},
        {"troposphere", "mapping", "\"vmf1\"", SKYLOOP_WORD(propagation.troposphere_model.mapping),
         number_of_word(TroposphereMappingModel::vmf1)},
        {"troposphere", "vmf1_a_hydrostatic", "0.0015", SKYLOOP_PLAIN(propagation.troposphere_model.vmf1.a_hydrostatic),
         0.0015},
        {"troposphere", "vmf1_a_wet", "0.0007", SKYLOOP_PLAIN(propagation.troposphere_model.vmf1.a_wet), 0.0007},
        {"troposphere", "gradient_north_m", "0.001", SKYLOOP_FIELD(propagation.troposphere_model.gradient_north),
         0.001},
        {"troposphere", "gradient_east_m", "-0.002", SKYLOOP_FIELD(propagation.troposphere_model.gradient_east),
         -0.002},
        {"troposphere", "residual_m", "0.07", SKYLOOP_FIELD(propagation.troposphere_model.residual), 0.07},
        {"troposphere", "residual_in_rain_m", "0.08", SKYLOOP_FIELD(propagation.troposphere_model.residual_in_rain),
         0.08},
        {"troposphere", "residual_in_thunderstorm_m", "0.09",
         SKYLOOP_FIELD(propagation.troposphere_model.residual_in_thunderstorm), 0.09},
        {"troposphere", "wind_mps", "15", SKYLOOP_FIELD(propagation.troposphere_model.wind), 15},
        {"troposphere", "thunderstorm_rain_mm_h", "25",
         SKYLOOP_PLAIN(propagation.troposphere_model.thunderstorm_rain_mm_h), 25},
        {"losses", "rain_cell_m", "500", SKYLOOP_FIELD(propagation.loss_model.rain_cell), 500},
        {"losses", "canopy_depth_m", "7.5", SKYLOOP_FIELD(propagation.loss_model.canopy_depth), 7.5},
        {"losses", "canopy_density", "0.5", SKYLOOP_PLAIN(propagation.loss_model.canopy_density), 0.5},
        {"losses", "canopy_top_deg", "20",
         [](const ModernSettings& s) { return s.propagation.loss_model.canopy_top.deg(); }, 20},
        {"losses", "canopy_db_per_m", "1.5", SKYLOOP_PLAIN(propagation.loss_model.canopy_db_per_m), 1.5},
        {"losses", "most_foliage_db", "20", SKYLOOP_FIELD(propagation.loss_model.most_foliage), 20},
        {"losses", "antenna_film_db", "2.5", SKYLOOP_FIELD(propagation.loss_model.antenna_film), 2.5},
    });
}

TEST(ModernKeys, ABoardStandsBetweenThePresetAndTheScenario) {
    const ModernSettings said = modern_of(
        "[model.modern]\npreset = \"survey\"\n[model.modern.tracking]\ncode_bandwidth_hz = 0.7\n"
        "[model.modern.multipath]\nfloor_m = 0.9\n[model.modern.terms.code_noise]\nscale = 3");
    const ModernSettings both =
        with_board(said, "[tracking]\ncode_bandwidth_hz = 0.03\ndoppler_window_s = 0.2\n[solution]\nuse_after_s = 4\n");
    EXPECT_EQ(both.measurement.code_loop.bandwidth, Hertz(0.7)) << "the scenario's";
    EXPECT_EQ(both.measurement.doppler_window, Seconds(0.2)) << "the board's";
    EXPECT_EQ(both.navigation.use.after, Seconds(4)) << "the board's";
    EXPECT_EQ(both.measurement.code_loop.spacing_chips, 0.1) << "the preset's";
    EXPECT_EQ(both.measurement.multipath_model.floor, Metres(0.9)) << "no board has it";
    EXPECT_EQ(both.measurement.code_noise.scale, 3);
    EXPECT_EQ(with_board(said, "").measurement.doppler_window, said.measurement.doppler_window);
}

TEST(ModernKeys, OfTheLinkAndItsDisturbances) {
    const auto gain_at = [](const ModernSettings& s, double elevation) {
        return s.propagation.link.antenna.gain({Angle(), Angle::degrees(elevation)}).value();
    };
    expect_keys({
        {"link", "gps_dbw", "-150", SKYLOOP_FIELD(propagation.link.received.gps), -150},
        {"link", "sbas_dbw", "-150", SKYLOOP_FIELD(propagation.link.received.sbas), -150},
        {"link", "galileo_dbw", "-150", SKYLOOP_FIELD(propagation.link.received.galileo), -150},
        {"link", "beidou_dbw", "-150", SKYLOOP_FIELD(propagation.link.received.beidou), -150},
        {"link", "qzss_dbw", "-150", SKYLOOP_FIELD(propagation.link.received.qzss), -150},
        {"link", "glonass_dbw", "-150", SKYLOOP_FIELD(propagation.link.received.glonass), -150},
        {"link", "navic_dbw", "-150", SKYLOOP_FIELD(propagation.link.received.navic), -150},
        {"link", "antenna_peak_dbic", "5", [&](const ModernSettings& s) { return gain_at(s, 90); }, 5},
        {"link", "antenna_drop_db", "10", [&](const ModernSettings& s) { return gain_at(s, 0); }, 3.4 - 10},
        {"link", "antenna_exponent", "1", [&](const ModernSettings& s) { return gain_at(s, 30); }, 3.4 - 19.5 / 2},
        {"link", "antenna_temperature_k", "150", SKYLOOP_FIELD(propagation.link.noise.antenna_temperature), 150},
        {"link", "line_loss_db", "3.5", SKYLOOP_FIELD(propagation.link.noise.line_loss), 3.5},
        {"link", "noise_figure_db", "4.5", SKYLOOP_FIELD(propagation.link.noise.noise_figure), 4.5},
        {"link", "implementation_loss_db", "1.25", SKYLOOP_FIELD(propagation.link.implementation_loss), 1.25},
        {"link", "platform_noise_db", "2.5", SKYLOOP_FIELD(propagation.link.platform_noise), 2.5},
        {"link", "satellite_spread_db", "0.75", SKYLOOP_FIELD(propagation.link.satellite_spread), 0.75},
        {"link", "ripple_db", "1.75", SKYLOOP_FIELD(propagation.link.ripple), 1.75},
        {"link", "ripple_time_s", "7", SKYLOOP_FIELD(propagation.link.ripple_time), 7},
        {"link", "man_made_noise", "\"city\"",
         [](const ModernSettings& s) { return s.propagation.link.man_made == NoiseEnvironment::city ? 1.0 : 0.0; }, 1},
        {"interference", "jammer_to_signal_db", "30",
         [](const ModernSettings& s) { return s.propagation.link.jammer_to_signal.value_or(Decibels(0)).value(); }, 30},
        {"interference", "kind", "\"wide-band\"", SKYLOOP_WORD(propagation.link.jammer),
         number_of_word(JammerKind::wide_band)},
        {"scintillation", "s4", "0.5", SKYLOOP_PLAIN(propagation.scintillation_model.s4), 0.5},
        {"scintillation", "sigma_phi_rad", "0.25",
         [](const ModernSettings& s) { return s.propagation.scintillation_model.sigma_phi.rad(); }, 0.25},
        {"scintillation", "equatorial_evening", "true",
         SKYLOOP_PLAIN(propagation.scintillation_model.equatorial_evening), 1},
        {"scintillation", "evening_peak_h", "19", SKYLOOP_PLAIN(propagation.scintillation_model.evening_peak_h), 19},
        {"scintillation", "evening_width_h", "3", SKYLOOP_PLAIN(propagation.scintillation_model.evening_width_h), 3},
    });
    EXPECT_FALSE(modern_of("[model.modern.link]\nman_made_noise = \"none\"").propagation.link.man_made);
}

TEST(ModernKeys, ATableThatCannotBeReadIsNoMistakeOfTheScenario) {
    for (const std::string key : {"antenna_table", "satellite_table"}) {
        const auto refused = read_scenario("[model.modern.link]\n" + key + " = \"none.csv\"\n", "test.toml");
        ASSERT_FALSE(refused);
        EXPECT_EQ(refused.error().code, ErrorCode::outside) << "another day it may be there";
        EXPECT_THAT(refused.error().message,
                    testing::AllOf(testing::StartsWith("test.toml:2:"), HasSubstr("model.modern.link." + key + ": "),
                                   HasSubstr("none.csv")));
    }
    EXPECT_THAT(mistakes_of("[run]\nspeed = 0\n[model.modern.link]\nantenna_table = \"none.csv\"\n"),
                testing::AllOf(HasSubstr("run.speed"), HasSubstr("none.csv")))
        << "one mistake of its own makes the file a wrong one";
}

TEST(ModernKeys, TheFilesOfTablesAreKnown) {
    const auto folder = std::filesystem::path(testing::TempDir());
    std::ofstream(folder / "skyloop-antenna.csv") << "elevation_deg,gain_dbic\n0,-3\n90,4\n";
    std::ofstream(folder / "skyloop-satellite.csv") << "off_boresight_deg,eirp_dbw\n0,27\n14,27\n";
    const auto settings =
        modern_of("[model.modern.link]\nantenna_table = \"" + (folder / "skyloop-antenna.csv").string() +
                  "\"\nsatellite_table = \"" + (folder / "skyloop-satellite.csv").string() + "\"");
    EXPECT_THAT(settings.tables,
                testing::UnorderedElementsAre(folder / "skyloop-antenna.csv", folder / "skyloop-satellite.csv"));
    std::filesystem::remove(folder / "skyloop-antenna.csv");
    std::filesystem::remove(folder / "skyloop-satellite.csv");
}

TEST(ModernKeys, OfTheMeasurement) {
    expect_keys({
        {"clock", "h0_s", "1e-15", [](const ModernSettings& s) { return s.measurement.clock.noise.h0 * 1e15; }, 1},
        {"clock", "h_minus_2_per_s", "1e-15",
         [](const ModernSettings& s) { return s.measurement.clock.noise.h_minus_2 * 1e15; }, 1},
        {"clock", "temperature_k", "3.5", SKYLOOP_FIELD(measurement.clock.temperature.deviation), 3.5},
        {"clock", "temperature_time_s", "90", SKYLOOP_FIELD(measurement.clock.temperature.correlation_time), 90},
        {"clock", "frequency_per_k", "0.0005", SKYLOOP_PLAIN(measurement.clock.temperature.per_kelvin), 0.0005},
        {"clock", "bias_m", "-1234.5", SKYLOOP_FIELD(measurement.clock.bias), -1234.5},
        {"clock", "drift_mps", "77", SKYLOOP_FIELD(measurement.clock.drift), 77},
        {"clock", "steering", "\"continuous\"", SKYLOOP_WORD(measurement.clock.steering),
         number_of_word(ClockSteering::continuous)},
        {"tracking", "code_bandwidth_hz", "0.75", SKYLOOP_FIELD(measurement.code_loop.bandwidth), 0.75},
        {"tracking", "code_spacing_chips", "0.375", SKYLOOP_PLAIN(measurement.code_loop.spacing_chips), 0.375},
        {"tracking", "front_end_bandwidth_hz", "3e6", SKYLOOP_FIELD(measurement.code_loop.front_end_bandwidth), 3e6},
        {"tracking", "integration_s", "0.01", SKYLOOP_FIELD(measurement.frequency_loop.integration), 0.01},
        {"tracking", "phase_bandwidth_hz", "7", SKYLOOP_FIELD(measurement.phase_loop.bandwidth), 7},
        {"tracking", "frequency_bandwidth_hz", "9", SKYLOOP_FIELD(measurement.frequency_loop.bandwidth), 9},
        {"tracking", "cn0_resolution_db", "0.125", SKYLOOP_FIELD(measurement.cn0_resolution), 0.125},
        {"tracking", "slips_per_hour", "12", SKYLOOP_PLAIN(measurement.slips_per_hour), 12},
        {"acquisition", "cold_threshold_dbhz", "31.5", SKYLOOP_FIELD(measurement.acquisition.cold_threshold), 31.5},
        {"acquisition", "warm_threshold_dbhz", "27.5", SKYLOOP_FIELD(measurement.acquisition.warm_threshold), 27.5},
        {"acquisition", "loss_threshold_dbhz", "19.5", SKYLOOP_FIELD(measurement.acquisition.loss_threshold), 19.5},
        {"acquisition", "phase_threshold_dbhz", "29.5", SKYLOOP_FIELD(measurement.acquisition.phase_threshold), 29.5},
        {"acquisition", "loss_after_s", "2.5", SKYLOOP_FIELD(measurement.acquisition.loss_after), 2.5},
        {"acquisition", "reacquisition_s", "3.5", SKYLOOP_FIELD(measurement.acquisition.reacquisition), 3.5},
        {"acquisition", "hot_search_s", "4.5", SKYLOOP_FIELD(measurement.acquisition.hot_search), 4.5},
        {"acquisition", "warm_search_s", "5.5", SKYLOOP_FIELD(measurement.acquisition.warm_search), 5.5},
        {"acquisition", "cold_search_s", "6.5", SKYLOOP_FIELD(measurement.acquisition.cold_search), 6.5},
        {"acquisition", "half_cycle_after_s", "7.5", SKYLOOP_FIELD(measurement.acquisition.half_cycle_after), 7.5},
        {"multipath", "floor_m", "0.375", SKYLOOP_FIELD(measurement.multipath_model.floor), 0.375},
        {"multipath", "at_horizon_m", "2.75", SKYLOOP_FIELD(measurement.multipath_model.at_horizon), 2.75},
        {"multipath", "static_time_s", "33", SKYLOOP_FIELD(measurement.multipath_model.static_time), 33},
        {"multipath", "moving_time_s", "11", SKYLOOP_FIELD(measurement.multipath_model.moving_time), 11},
    });
    const MeasurementParameters loops = modern_of("[model.modern.tracking]\nintegration_s = 0.004").measurement;
    EXPECT_EQ(loops.code_loop.integration, Seconds(0.004)) << "one time for all loops";
    EXPECT_EQ(loops.phase_loop.integration, Seconds(0.004));
}

TEST(ModernKeys, OfTheSolution) {
    expect_keys({
        {"solution", "ionosphere_correction", "\"klobuchar\"",
         [](const ModernSettings& s) {
             return s.ionosphere_correction ? number_of_word(*s.ionosphere_correction) : -1;
         },
         number_of_word(IonosphereCorrection::klobuchar)},
        {"solution", "troposphere_correction", "\"saastamoinen\"",
         [](const ModernSettings& s) {
             return s.troposphere_correction ? number_of_word(*s.troposphere_correction) : -1;
         },
         number_of_word(TroposphereCorrection::saastamoinen)},
        {"solution", "relative_humidity", "0.25", SKYLOOP_PLAIN(navigation.corrections.relative_humidity), 0.25},
        {"solution", "weight_floor_m", "0.375", SKYLOOP_FIELD(navigation.weights.floor), 0.375},
        {"solution", "weight_at_zenith_m", "0.625", SKYLOOP_FIELD(navigation.weights.at_zenith), 0.625},
        {"solution", "filter", "\"none\"", SKYLOOP_WORD(navigation.filter.kind), number_of_word(FilterKind::none)},
        {"solution", "position_memory_s", "3.5", SKYLOOP_FIELD(navigation.filter.position_memory), 3.5},
        {"solution", "code_smoothing_s", "55", SKYLOOP_FIELD(navigation.filter.code_smoothing), 55},
        {"solution", "coasting_s", "9.5", SKYLOOP_FIELD(navigation.filter.coasting), 9.5},
        {"solution", "raim", "false", SKYLOOP_PLAIN(navigation.integrity.enabled), 0},
        {"solution", "false_alarm", "0.001", SKYLOOP_PLAIN(navigation.integrity.false_alarm), 0.001},
        {"solution", "most_exclusions", "7", SKYLOOP_PLAIN(navigation.integrity.most_exclusions), 7},
        {"solution", "position_accuracy_scale", "7.5", SKYLOOP_PLAIN(navigation.accuracy.position_scale), 7.5},
        {"solution", "velocity_accuracy_scale", "6.5", SKYLOOP_PLAIN(navigation.accuracy.velocity_scale), 6.5},
        {"solution", "accuracy_ionosphere_share", "0.5", SKYLOOP_PLAIN(navigation.accuracy.ionosphere_share), 0.5},
        {"solution", "accuracy_ionosphere_tilt", "0.25", SKYLOOP_PLAIN(navigation.accuracy.ionosphere_tilt), 0.25},
        {"solution", "accuracy_troposphere_share", "1.5", SKYLOOP_PLAIN(navigation.accuracy.troposphere_share), 1.5},
        {"solution", "ephemeris_collection_s", "18.5",
         [](const ModernSettings& s) { return s.ephemeris_collection ? s.ephemeris_collection->value() : -1; }, 18.5},
    });
}

#undef SKYLOOP_FIELD
#undef SKYLOOP_PLAIN
#undef SKYLOOP_WORD

TEST(ModernKeys, APresetIsTheBaseAndKeysGoBeforeItInAnyOrder) {
    for (std::size_t i = 0; i < std::size(modern_preset_names); ++i) {
        const std::string key = "preset = \"" + std::string(modern_preset_names[i]) + "\"\n";
        const ModernSettings wanted = ModernSettings::of(static_cast<ModernPreset>(i));
        const ModernSettings read = modern_of("[model.modern]\n" + key);
        EXPECT_EQ(read.preset, wanted.preset);
        EXPECT_EQ(read.measurement.multipath_model.floor, wanted.measurement.multipath_model.floor);
        EXPECT_EQ(read.measurement.clock.steering, wanted.measurement.clock.steering);
        EXPECT_EQ(read.navigation.weights.floor, wanted.navigation.weights.floor);
        const ModernSettings changed = modern_of("[model.modern.multipath]\nfloor_m = 7\n[model.modern]\n" + key);
        EXPECT_EQ(changed.measurement.multipath_model.floor, Metres(7));
        EXPECT_EQ(changed.measurement.multipath_model.at_horizon, wanted.measurement.multipath_model.at_horizon);
    }
    EXPECT_EQ(modern_of("").preset, ModernPreset::consumer);
}

TEST(ModernKeys, SurroundingsAreKept) {
    for (std::size_t i = 0; i < std::size(surroundings_names); ++i)
        EXPECT_EQ(
            modern_of("[model.modern]\nsurroundings = \"" + std::string(surroundings_names[i]) + "\"").surroundings,
            static_cast<Surroundings>(i));
}

TEST(ModernKeys, EveryTermIsSwitchedScaledAndSeededByItself) {
    ModernSettings names;
    for (const NamedTerm& wanted : error_terms(names)) {
        ModernSettings read =
            modern_of("[model.modern.terms." + std::string(wanted.name) + "]\nenabled = false\nscale = 2.5\nseed = 77");
        int changed = 0;
        for (const NamedTerm& named : error_terms(read)) {
            const bool same = named.name == wanted.name;
            EXPECT_EQ(named.term->enabled, !same) << named.name;
            EXPECT_EQ(named.term->scale, same ? 2.5 : 1) << named.name;
            EXPECT_EQ(named.term->seed, same ? std::optional<std::uint64_t>(77) : std::nullopt) << named.name;
            changed += same ? 1 : 0;
        }
        EXPECT_EQ(changed, 1) << wanted.name;
    }
}

TEST(ModernKeys, ErrorsCanAllBeSwitchedOff) {
    EXPECT_FALSE(scenario_of("[model]\nerrors = \"none\"").model.modern.errors);
    EXPECT_TRUE(scenario_of("[model]\nerrors = \"all\"").model.modern.errors);
    EXPECT_FALSE(scenario_of("[model]\nerrors = \"none\"\n[model.modern]\npreset = \"survey\"").model.modern.errors)
        << "a preset does not switch them on again";
}

TEST(ModernKeys, OfTheReceiver) {
    const ReceiverEntry plain = scenario_of("[[receiver]]").receivers[0];
    EXPECT_TRUE(plain.constellations.empty());
    EXPECT_FALSE(plain.dual_frequency);
    EXPECT_EQ(plain.start, StartKind::hot);
    EXPECT_EQ(plain.dynamic_model, DynamicModel::portable);
    const ReceiverEntry r = scenario_of(
                                "[[receiver]]\nconstellations = [\"galileo\", \"gps\"]\ndual_frequency = true\n"
                                "start = \"cold\"\ndynamic_model = \"airborne-2g\"\nstatic_hold_mps = 0.5")
                                .receivers[0];
    EXPECT_THAT(r.constellations, testing::ElementsAre(Constellation::galileo, Constellation::gps));
    EXPECT_TRUE(r.dual_frequency);
    EXPECT_EQ(r.start, StartKind::cold);
    EXPECT_EQ(r.dynamic_model, DynamicModel::airborne_2g);
    EXPECT_EQ(r.static_hold_below, MetresPerSecond(0.5));
    EXPECT_EQ(scenario_of("[[receiver]]\nstart = \"warm\"").receivers[0].start, StartKind::warm);
}

TEST(ModernKeys, MistakesSayWhereAndWhat) {
    EXPECT_EQ(mistakes_of("[model.modern]\npreset = \"consumr\""),
              "test.toml:2:10: model.modern.preset: is 'consumr'; expected one of survey consumer phone; did you mean "
              "'consumer'?");
    EXPECT_EQ(mistakes_of("[model.modern]\nsurroundings = \"open_sky\""),
              "test.toml:2:16: model.modern.surroundings: is 'open_sky'; expected one of open-sky rural residential "
              "forest suburban-drive urban urban-canyon indoor-window valley tunnel garage; did you mean 'open-sky'?");
    EXPECT_EQ(mistakes_of("[model.modern.terms.multipth]\nenabled = false"),
              "test.toml:1:21: model.modern.terms.multipth: unknown key; did you mean 'multipath'?");
    EXPECT_EQ(mistakes_of("[model.modern.terms.multipath]\nenabld = false"),
              "test.toml:2:1: model.modern.terms.multipath.enabld: unknown key; did you mean 'enabled'?");
    EXPECT_EQ(mistakes_of("[model.modern.terms.multipath]\nscale = -1"),
              "test.toml:2:9: model.modern.terms.multipath.scale: is -1; expected a number from 0 to 1000");
    EXPECT_EQ(mistakes_of("[model.modern.terms.multipath]\nseed = -1"),
              "test.toml:2:8: model.modern.terms.multipath.seed: is -1; expected a whole number of 0 or more");
    EXPECT_EQ(mistakes_of("[model.modern.tracking]\ncode_spacing_chips = 2"),
              "test.toml:2:22: model.modern.tracking.code_spacing_chips: is 2; expected a number from 0.01 to 1.99");
    EXPECT_EQ(mistakes_of("[model]\nerrors = \"non\""),
              "test.toml:2:10: model.errors: is 'non'; expected one of all none; did you mean 'none'?");
    EXPECT_EQ(mistakes_of("[model]\nerrors = \"none\"\n[model.modern.terms.gas]\nenabled = true"),
              "test.toml:4:11: model.modern.terms.gas.enabled: is true beside errors = \"none\", which switches every "
              "term off; expected one of the two");
    EXPECT_EQ(mistakes_of("[model]\nerrors = \"none\"\n[model.modern.terms.gas]\nscale = 2"), "accepted");
    EXPECT_EQ(mistakes_of("[model]\nname = \"baseline\"\nerrors = \"none\""),
              "test.toml:3:10: model.errors: belongs to the modern model; this scenario's is baseline");
    EXPECT_EQ(mistakes_of("[[receiver]]\nstart = \"luke\""),
              "test.toml:2:9: receiver.start: is 'luke'; expected one of hot warm cold");
    EXPECT_THAT(mistakes_of("[[receiver]]\ndynamic_model = \"automotiv\""), HasSubstr("did you mean 'automotive'?"));
    EXPECT_THAT(mistakes_of("[[receiver]]\nconstellations = [\"gps\", \"gps\"]"), HasSubstr("test.toml:2:"));
    EXPECT_THAT(mistakes_of("[model.modern.troposphere]\nmapping = \"nial\""), HasSubstr("did you mean 'niell'?"));
}

// Keys that the words beside them leave without effect.
TEST(ModernKeys, TellWhichCannotAct) {
    const auto idle = [](const std::string& table, const std::string& keys) {
        return modern_of("[model.modern." + table + "]\n" + keys).idle_keys;
    };
    const auto tells = [&](const std::string& table, const std::string& keys, const std::string& key) {
        EXPECT_THAT(idle(table, keys), testing::ElementsAre(HasSubstr("model.modern." + table + "." + key + ": ")));
    };
    tells("ionosphere", "content_tecu = 100", "content_tecu");
    tells("ionosphere", "truth = \"klobuchar\"\nionisation = [80, 0, 0]", "ionisation");
    tells("ionosphere", "klobuchar_alpha = [1e-8, 0, 0, 0]", "klobuchar_alpha");
    tells("ionosphere", "residual_common = 0.5", "residual_common");
    tells("ionosphere", "truth = \"klobuchar\"\nresidual = \"off\"\nresidual_single = 0.5", "residual_single");
    tells("troposphere", "pressure_hpa = 900", "pressure_hpa");
    tells("troposphere", "sea_level_vapour_g_m3 = 9", "sea_level_vapour_g_m3");
    tells("troposphere", "vmf1_a_wet = 1e-3", "vmf1_a_wet");
    tells("interference", "kind = \"wide-band\"", "kind");
    tells("scintillation", "equatorial_evening = true", "equatorial_evening");
    tells("scintillation", "s4 = 0.3\nevening_peak_h = 20", "evening_peak_h");
    tells("clock", "steering = \"continuous\"\ndrift_mps = 10", "drift_mps");
}

TEST(ModernKeys, TellNothingOfThoseThatAct) {
    for (const char* keys :
         {"[ionosphere]\ntruth = \"constant\"\ncontent_tecu = 100",
          "[ionosphere]\nresidual = \"on\"\nresidual_single = 1",
          "[ionosphere]\ntruth = \"klobuchar\"\nresidual_common = 0.5",
          "[ionosphere]\nresidual_common = 0.5\n[model.modern.solution]\nionosphere_correction = \"broadcast\"",
          "[ionosphere]\nresidual_common = 0.5\n[model.modern.solution]\nionosphere_correction = \"none\"",
          "[troposphere]\nweather = \"given\"\npressure_hpa = 900\ntemperature_k = 280",
          "[troposphere]\nmapping = \"vmf1\"\nvmf1_a_wet = 1e-3",
          "[interference]\njammer_to_signal_db = 20\nkind = \"wide-band\"",
          "[scintillation]\ns4 = 0.3\nequatorial_evening = true\nevening_peak_h = 20", "[clock]\ndrift_mps = 10"})
        EXPECT_THAT(modern_of("[model.modern." + std::string(keys).substr(1)).idle_keys, testing::IsEmpty()) << keys;
}

}  // namespace
}  // namespace skyloop
