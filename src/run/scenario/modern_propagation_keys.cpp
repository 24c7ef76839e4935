#include <array>

#include "detail/scenario_keys.hpp"

namespace skyloop::inline run {
namespace {

void read_signal_in_space(TableReader& table, SignalInSpaceParameters& p) {
    table.quantity("gps_m", p.gps, {0, 1e4}, "σ of the range error of GPS");
    table.quantity("sbas_m", p.sbas, {0, 1e4}, "σ of the range error of SBAS");
    table.quantity("galileo_m", p.galileo, {0, 1e4}, "σ of the range error of Galileo");
    table.quantity("beidou2_m", p.beidou2, {0, 1e4}, "σ of the range error of BeiDou-2, C01 to C18");
    table.quantity("beidou3_m", p.beidou3, {0, 1e4}, "σ of the range error of BeiDou-3");
    table.quantity("qzss_m", p.qzss, {0, 1e4}, "σ of the range error of QZSS");
    table.quantity("glonass_m", p.glonass, {0, 1e4}, "σ of the range error of GLONASS");
    table.quantity("navic_m", p.navic, {0, 1e4}, "σ of the range error of NavIC");
    table.quantity("correlation_time_s", p.correlation_time, {1, 1e7},
                   "of its four processes: radial, along, cross, clock");
}

void read_ionosphere_residual(TableReader& table, IonosphereParameters& p) {
    table.word("residual", {{"automatic", Choice::automatic}, {"on", Choice::on}, {"off", Choice::off}}, p.residual,
               "automatic: on where the receiver corrects with the model of the truth");
    const bool departs =
        p.residual == Choice::on || (p.residual == Choice::automatic && p.model == IonosphereModel::klobuchar);
    constexpr std::string_view when =
        "with residual = \"on\", or automatic where the receiver corrects with the model of the truth";
    table.where(departs, when, [&] {
        table.number("residual_common", p.common, {0, 10}, "σ as a share of the delay, the same for all satellites");
        table.number("residual_gradient", p.gradient, {0, 10},
                     "σ as a share of the delay, north and east, for a pierce point 9° away");
        table.quantity("residual_common_time_s", p.common_time, {1, 1e7}, "correlation time of both");
        table.number("residual_single", p.single, {0, 10}, "σ as a share of the delay, of each satellite by itself");
        table.quantity("residual_single_time_s", p.single_time, {1, 1e7}, "its correlation time");
    });
}

void read_ionosphere_truth(TableReader& table, ModernSettings& settings, const std::filesystem::path& folder) {
    IonosphereParameters& p = settings.propagation.ionosphere_model;
    table.word("truth",
               {{"klobuchar", IonosphereModel::klobuchar},
                {"ntcm-g", IonosphereModel::ntcm_g},
                {"nequick-g", IonosphereModel::nequick_g},
                {"ionex", IonosphereModel::ionex},
                {"constant", IonosphereModel::constant}},
               p.model, "the model that is the truth");
    table.where(p.model == IonosphereModel::ionex, "with truth = \"ionex\"", [&] {
        table.file_path("maps", folder, settings.ionosphere_maps,
                        {"IONEX file for truth ionex: global maps that cover the run", "none"});
    });
    if (p.model == IonosphereModel::ionex && settings.ionosphere_maps.empty())
        table.mistake("truth", "is ionex, but maps names no file; expected an IONEX file");
    table.where(p.model == IonosphereModel::constant, "with truth = \"constant\"", [&] {
        table.quantity("content_tecu", p.constant_content, {0, 1000}, "vertical content of truth constant");
    });
    const bool galileo = p.model == IonosphereModel::ntcm_g || p.model == IonosphereModel::nequick_g;
    table.where(galileo, "with truth = \"ntcm-g\" or \"nequick-g\"", [&] {
        std::array<double, 3> level{p.ionisation.a0, p.ionisation.a1, p.ionisation.a2};
        table.numbers("ionisation", level, "for ntcm-g and nequick-g when the data has no coefficients of Galileo");
        p.ionisation = {level[0], level[1], level[2]};
    });
    table.where(p.model == IonosphereModel::klobuchar, "with truth = \"klobuchar\"", [&] {
        table.numbers("klobuchar_alpha", p.klobuchar.alpha, "for klobuchar when the navigation data has none of GPS");
        table.numbers("klobuchar_beta", p.klobuchar.beta, "for klobuchar when the navigation data has none of GPS");
    });
    read_ionosphere_residual(table, p);
    table.quantity("disturbance_tecu", p.waves.content, {0, 100},
                   "σ of the vertical content in travelling disturbances: 0.35 quiet, 4 disturbed; 0: none");
    table.where(p.waves.content != Tecu(0), "with disturbance_tecu above 0", [&] {
        table.quantity("disturbance_speed_mps", p.waves.speed, {0, 2000}, "by which they travel");
    });
}

void read_weather(TableReader& table, TroposphereParameters& p) {
    table.word("weather",
               {{"standard", WeatherSource::standard},
                {"gpt", WeatherSource::gpt},
                {"given", WeatherSource::given},
                {"p835", WeatherSource::p835}},
               p.weather, "air at the antenna: standard, GPT climate, given here, or ITU-R P.835");
    table.number("relative_humidity", p.relative_humidity, {0, 1}, "of all weathers but p835");
    table.where(p.weather == WeatherSource::given, "with weather = \"given\"", [&] {
        table.number("pressure_hpa", p.pressure_hpa, {1, 1200}, "of weather given, at the antenna");
        table.quantity("temperature_k", p.temperature, {150, 350}, "of weather given, at the antenna");
    });
    table.where(p.weather == WeatherSource::p835, "with weather = \"p835\"", [&] {
        table.number("sea_level_vapour_g_m3", p.sea_level_vapour_g_m3, {0, 100}, "of weather p835");
    });
}

void read_troposphere_truth(TableReader& table, TroposphereParameters& p) {
    read_weather(table, p);
    table.word("mapping",
               {{"niell", TroposphereMappingModel::niell},
                {"gmf", TroposphereMappingModel::gmf},
                {"vmf1", TroposphereMappingModel::vmf1},
                {"cosecant", TroposphereMappingModel::cosecant}},
               p.mapping, "from zenith to slant; cosecant: 1/sin e");
    table.where(p.mapping == TroposphereMappingModel::vmf1, "with mapping = \"vmf1\"", [&] {
        table.number("vmf1_a_hydrostatic", p.vmf1.a_hydrostatic, {1e-4, 1e-2}, "coefficient of mapping vmf1");
        table.number("vmf1_a_wet", p.vmf1.a_wet, {1e-5, 1e-2}, "coefficient of mapping vmf1");
    });
    table.quantity("gradient_north_m", p.gradient_north, {-1, 1}, "per 1/(sin e tan e + 0.0032)");
    table.quantity("gradient_east_m", p.gradient_east, {-1, 1}, "per 1/(sin e tan e + 0.0032)");
    table.quantity("residual_m", p.residual, {0, 10}, "σ of the wet delay at the zenith, a turbulent field");
    table.quantity("residual_in_rain_m", p.residual_in_rain, {0, 10}, "the same in rain");
    table.quantity("residual_in_thunderstorm_m", p.residual_in_thunderstorm, {0, 10}, "the same in a thunderstorm");
    table.quantity("wind_mps", p.wind, {0, 100}, "by which this field drifts");
    table.number("thunderstorm_rain_mm_h", p.thunderstorm_rain_mm_h, {0, 1000}, "rain that makes it a thunderstorm");
}

void read_losses(TableReader& table, LossParameters& p) {
    table.quantity("rain_cell_m", p.rain_cell, {0, 1e6}, "how far the rain reaches to any side");
    table.quantity("canopy_depth_m", p.canopy_depth, {0, 1000},
                   {"trees all around: crown that a level ray crosses; 0: none", "0; residential 11"});
    table.number("canopy_density", p.canopy_density, {0, 1}, "share of it that is leaves and branches");
    table.degrees("canopy_top_deg", p.canopy_top, {0, 90}, "elevation up to which crowns stand");
    table.number("canopy_db_per_m", p.canopy_db_per_m, {0, 10}, "loss in a crown, in those of a scene, too");
    table.quantity("most_foliage_db", p.most_foliage, {0, 100}, "limit of the loss in trees, in those of a scene, too");
    table.quantity("antenna_film_db", p.antenna_film, {0, 100}, "water or ice on the antenna, 0 to 3 dB");
}

template <class Pattern>
struct PatternReading {
    ModernSettings& settings;
    const std::filesystem::path& folder;
    Result<Pattern> (*read)(const std::filesystem::path& file);
    Pattern& pattern;
};

// A CSV file.
template <class Pattern>
void read_pattern(TableReader& table, std::string_view key, KeyText text, PatternReading<Pattern> reading) {
    std::filesystem::path file;
    table.file_path(key, reading.folder, file, text);
    if (file.empty()) return;
    reading.settings.tables.push_back(file);
    if (auto pattern = reading.read(file))
        reading.pattern = std::move(*pattern);
    else
        table.mistake(key, pattern.error());
}

void read_antenna(TableReader& table, ModernSettings& settings, const std::filesystem::path& folder) {
    ModernLinkParameters& p = settings.propagation.link;
    Decibels peak = p.antenna.peak(), drop = p.antenna.drop();
    double exponent = p.antenna.exponent();
    table.quantity("antenna_peak_dbic", peak, {-100, 100},
                   {"gain = peak − drop (1 − sin e)^exponent", "3.4; phone −9.5"});
    table.quantity("antenna_drop_db", drop, {0, 100}, {"from the zenith to the horizon", "19.5; survey 16.5, phone 9"});
    table.number("antenna_exponent", exponent, {0.1, 10}, {"the higher, the later the gain falls", "1.3; phone 1"});
    p.antenna = AntennaPattern(peak, drop, exponent);
    read_pattern(table, "antenna_table", {"CSV file [azimuth_deg,]elevation_deg,gain_dbic in place of these", "none"},
                 PatternReading<AntennaPattern>{settings, folder, AntennaPattern::read, p.antenna});
}

void read_received_power(TableReader& table, ModernLinkParameters::ReceivedPower& p) {
    table.quantity("gps_dbw", p.gps, {-250, 0}, "power of GPS in an isotropic antenna on the ground");
    table.quantity("sbas_dbw", p.sbas, {-250, 0}, "power of SBAS in an isotropic antenna on the ground");
    table.quantity("galileo_dbw", p.galileo, {-250, 0}, "power of Galileo in an isotropic antenna on the ground");
    table.quantity("beidou_dbw", p.beidou, {-250, 0}, "power of BeiDou in an isotropic antenna on the ground");
    table.quantity("qzss_dbw", p.qzss, {-250, 0}, "power of QZSS in an isotropic antenna on the ground");
    table.quantity("glonass_dbw", p.glonass, {-250, 0}, "power of GLONASS in an isotropic antenna on the ground");
    table.quantity("navic_dbw", p.navic, {-250, 0}, "power of NavIC in an isotropic antenna on the ground");
}

void read_link(TableReader& table, ModernSettings& settings, const std::filesystem::path& folder) {
    ModernLinkParameters& p = settings.propagation.link;
    read_received_power(table, p.received);
    read_pattern(table, "satellite_table", {"CSV file off_boresight_deg,eirp_dbw in place of these powers", "none"},
                 PatternReading<std::vector<SatellitePowerPoint>>{settings, folder, read_satellite_pattern_file,
                                                                  p.satellite_pattern});
    read_antenna(table, settings, folder);
    table.quantity("antenna_temperature_k", p.noise.antenna_temperature, {0, 1e5}, "noise temperature of the antenna");
    table.quantity("line_loss_db", p.noise.line_loss, {0, 100},
                   "between antenna and receiver: weakens the signal, and adds its own noise");
    table.quantity("noise_figure_db", p.noise.noise_figure, {0, 100}, "of the receiver");
    table.quantity("implementation_loss_db", p.implementation_loss, {0, 100}, {"of the receiver", "2.5; phone 3.8"});
    table.quantity("platform_noise_db", p.platform_noise, {0, 100},
                   "noise of the vehicle over the receiver's: car or drone 1 to 3");
    table.word("man_made_noise",
               {{"none", std::nullopt},
                {"city", NoiseEnvironment::city},
                {"residential", NoiseEnvironment::residential},
                {"rural", NoiseEnvironment::rural},
                {"quiet-rural", NoiseEnvironment::quiet_rural}},
               p.man_made, "of the place, ITU-R P.372, extrapolated to L1");
    table.quantity("satellite_spread_db", p.satellite_spread, {0, 20}, "σ between satellites, constant of each");
    table.quantity("ripple_db", p.ripple, {0, 20}, {"σ of each satellite's power", "0.5; phone 2"});
    table.quantity("ripple_at_horizon_db", p.ripple_at_horizon, {0, 20},
                   {"what comes to it at the horizon, times exp(−elevation/20°)", "6; survey 1, phone 0"});
    table.quantity("ripple_time_s", p.ripple_time, {0.1, 1e6}, {"its correlation time", "20; survey 60, phone 10"});
}

void read_interference(TableReader& table, ModernLinkParameters& p) {
    table.quantity("jammer_to_signal_db", p.jammer_to_signal, {-100, 200},
                   {"power of a jammer over −157 dBW, the nominal signal", "none"});
    table.where(p.jammer_to_signal.has_value(), "beside jammer_to_signal_db", [&] {
        table.word("kind",
                   {{"narrow-band", JammerKind::narrow_band},
                    {"matched", JammerKind::matched},
                    {"wide-band", JammerKind::wide_band}},
                   p.jammer, "the jammer's spectrum: narrow-band hurts most, wide-band least");
    });
}

void read_scintillation(TableReader& table, ScintillationParameters& p) {
    table.number("s4", p.s4, {0, 0.7}, "amplitude index at L1 towards the zenith");
    double sigma = p.sigma_phi.rad();
    table.number("sigma_phi_rad", sigma, {0, 3}, "σ of the phase at L1 towards the zenith");
    p.sigma_phi = Angle::radians(sigma);
    const bool restless = p.s4 > 0 || p.sigma_phi > Angle();
    table.where(restless, "with s4 or sigma_phi_rad above 0", [&] {
        table.boolean("equatorial_evening", p.equatorial_evening,
                      "the two are those of the worst hour near the magnetic equator");
    });
    constexpr std::string_view when = "with equatorial_evening = true, and s4 or sigma_phi_rad above 0";
    table.where(restless && p.equatorial_evening, when, [&] {
        table.number("evening_peak_h", p.evening_peak_h, {0, 24}, "that hour, local time");
        table.number("evening_width_h", p.evening_width_h, {0.1, 24}, "its 1 σ");
    });
}

}  // namespace

void read_modern_propagation_keys(TableReader& modern, ModernSettings& settings, const std::filesystem::path& folder) {
    ModernPropagationParameters& p = settings.propagation;
    modern.table("signal_in_space", "errors of orbits and clocks of the satellites",
                 [&](TableReader& t) { read_signal_in_space(t, p.signal_in_space_model); });
    modern.table("ionosphere", "the true ionosphere",
                 [&](TableReader& t) { read_ionosphere_truth(t, settings, folder); });
    modern.table("troposphere", "the true air",
                 [&](TableReader& t) { read_troposphere_truth(t, p.troposphere_model); });
    modern.table("losses", "rain, trees and water on the antenna",
                 [&](TableReader& t) { read_losses(t, p.loss_model); });
    modern.table("channel", "obstacles and echoes where there is no scene", [&](TableReader& t) {
        read_channel_keys(t, p.channel_model);
        t.where(p.channel_model.acts(), "with surroundings that have a channel, or with environment", [&] {
            t.quantity("roof_db", p.channel_model.roof, {0, 100},
                       {"loss towards the zenith by the roof of a car", "0; car = true 4"});
        });
    });
    modern.table("link", "powers, antenna and noise", [&](TableReader& t) { read_link(t, settings, folder); });
    modern.table("interference", "a jammer", [&](TableReader& t) { read_interference(t, p.link); });
    modern.table("scintillation", "a restless ionosphere",
                 [&](TableReader& t) { read_scintillation(t, p.scintillation_model); });
}

}  // namespace skyloop::inline run
