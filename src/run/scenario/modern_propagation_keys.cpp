#include <algorithm>
#include <array>

#include "detail/scenario_keys.hpp"

namespace skyloop {
namespace {

void read_signal_in_space(TableReader& table, SignalInSpaceParameters& p) {
    table.quantity("gps_m", p.gps, {0, 1e4});
    table.quantity("sbas_m", p.sbas, {0, 1e4});
    table.quantity("galileo_m", p.galileo, {0, 1e4});
    table.quantity("beidou2_m", p.beidou2, {0, 1e4});
    table.quantity("beidou3_m", p.beidou3, {0, 1e4});
    table.quantity("qzss_m", p.qzss, {0, 1e4});
    table.quantity("glonass_m", p.glonass, {0, 1e4});
    table.quantity("navic_m", p.navic, {0, 1e4});
    table.quantity("correlation_time_s", p.correlation_time, {1, 1e7});
}

void read_ionisation(TableReader& table, IonosphereParameters& p) {
    if (const auto a = table.numbers("ionisation", 3)) p.ionisation = {(*a)[0], (*a)[1], (*a)[2]};
    if (const auto a = table.numbers("klobuchar_alpha", 4)) std::copy(a->begin(), a->end(), p.klobuchar.alpha.begin());
    if (const auto b = table.numbers("klobuchar_beta", 4)) std::copy(b->begin(), b->end(), p.klobuchar.beta.begin());
}

// Of the ionosphere's keys those that the chosen truth does not look at.
void tell_idle_ionosphere(TableReader& table, ModernSettings& settings) {
    const IonosphereParameters& p = settings.propagation.ionosphere_model;
    const auto tell = [&](std::initializer_list<std::string_view> keys, std::string_view acts) {
        tell_idle(table, settings, "ionosphere", keys, acts);
    };
    if (p.model != IonosphereModel::constant) tell({"content_tecu"}, "with truth = \"constant\"");
    if (p.model != IonosphereModel::ionex) tell({"maps"}, "with truth = \"ionex\"");
    if (p.model != IonosphereModel::ntcm_g && p.model != IonosphereModel::nequick_g)
        tell({"ionisation"}, "with truth = \"ntcm-g\" or \"nequick-g\"");
    if (p.model != IonosphereModel::klobuchar)
        tell({"klobuchar_alpha", "klobuchar_beta"}, "with truth = \"klobuchar\"");
    const bool departs =
        p.residual == Choice::on || (p.residual == Choice::automatic && p.model == IonosphereModel::klobuchar);
    if (!departs)
        tell({"residual_common", "residual_gradient", "residual_common_time_s", "residual_single",
              "residual_single_time_s"},
             "with residual = \"on\", or automatic where the receiver corrects with the model of the truth");
}

void read_ionosphere_truth(TableReader& table, ModernSettings& settings, const std::filesystem::path& folder) {
    IonosphereParameters& p = settings.propagation.ionosphere_model;
    static constexpr std::array<Word<IonosphereModel>, 5> models{{{"klobuchar", IonosphereModel::klobuchar},
                                                                  {"ntcm-g", IonosphereModel::ntcm_g},
                                                                  {"nequick-g", IonosphereModel::nequick_g},
                                                                  {"ionex", IonosphereModel::ionex},
                                                                  {"constant", IonosphereModel::constant}}};
    table.word("truth", models, p.model);
    std::string maps;
    table.text("maps", maps);
    if (!maps.empty()) settings.ionosphere_maps = folder / maps;
    if (p.model == IonosphereModel::ionex && settings.ionosphere_maps.empty())
        table.mistake("truth", "is ionex, but maps names no file; expected an IONEX file");
    table.quantity("content_tecu", p.constant_content, {0, 1000});
    read_ionisation(table, p);
    static constexpr std::array<Word<Choice>, 3> choices{
        {{"automatic", Choice::automatic}, {"on", Choice::on}, {"off", Choice::off}}};
    table.word("residual", choices, p.residual);
    table.number("residual_common", p.common, {0, 10});
    table.number("residual_gradient", p.gradient, {0, 10});
    table.quantity("residual_common_time_s", p.common_time, {1, 1e7});
    table.number("residual_single", p.single, {0, 10});
    table.quantity("residual_single_time_s", p.single_time, {1, 1e7});
    tell_idle_ionosphere(table, settings);
}

void read_weather(TableReader& table, TroposphereParameters& p) {
    static constexpr std::array<Word<WeatherSource>, 4> sources{{{"standard", WeatherSource::standard},
                                                                 {"gpt", WeatherSource::gpt},
                                                                 {"given", WeatherSource::given},
                                                                 {"p835", WeatherSource::p835}}};
    table.word("weather", sources, p.weather);
    table.number("relative_humidity", p.relative_humidity, {0, 1});
    table.number("pressure_hpa", p.pressure_hpa, {1, 1200});
    table.quantity("temperature_k", p.temperature, {150, 350});
    table.number("sea_level_vapour_g_m3", p.sea_level_vapour_g_m3, {0, 100});
}

void read_troposphere_truth(TableReader& table, ModernSettings& settings) {
    TroposphereParameters& p = settings.propagation.troposphere_model;
    read_weather(table, p);
    static constexpr std::array<Word<TroposphereMappingModel>, 4> mappings{
        {{"niell", TroposphereMappingModel::niell},
         {"gmf", TroposphereMappingModel::gmf},
         {"vmf1", TroposphereMappingModel::vmf1},
         {"cosecant", TroposphereMappingModel::cosecant}}};
    table.word("mapping", mappings, p.mapping);
    table.number("vmf1_a_hydrostatic", p.vmf1.a_hydrostatic, {1e-4, 1e-2});
    table.number("vmf1_a_wet", p.vmf1.a_wet, {1e-5, 1e-2});
    table.quantity("gradient_north_m", p.gradient_north, {-1, 1});
    table.quantity("gradient_east_m", p.gradient_east, {-1, 1});
    table.quantity("residual_m", p.residual, {0, 10});
    table.quantity("residual_time_s", p.residual_time, {1, 1e7});
    table.quantity("walk_m_per_sqrt_h", p.walk, {0, 1});
    table.quantity("walk_in_rain_m_per_sqrt_h", p.walk_in_rain, {0, 1});
    table.quantity("walk_in_thunderstorm_m_per_sqrt_h", p.walk_in_thunderstorm, {0, 1});
    table.number("thunderstorm_rain_mm_h", p.thunderstorm_rain_mm_h, {0, 1000});
    if (p.weather != WeatherSource::given)
        tell_idle(table, settings, "troposphere", {"pressure_hpa", "temperature_k"}, "with weather = \"given\"");
    if (p.weather != WeatherSource::p835)
        tell_idle(table, settings, "troposphere", {"sea_level_vapour_g_m3"}, "with weather = \"p835\"");
    if (p.mapping != TroposphereMappingModel::vmf1)
        tell_idle(table, settings, "troposphere", {"vmf1_a_hydrostatic", "vmf1_a_wet"}, "with mapping = \"vmf1\"");
}

void read_losses(TableReader& table, LossParameters& p) {
    table.quantity("rain_cell_m", p.rain_cell, {0, 1e6});
    table.quantity("canopy_depth_m", p.canopy_depth, {0, 1000});
    table.number("canopy_density", p.canopy_density, {0, 1});
    double top = p.canopy_top.deg();
    table.number("canopy_top_deg", top, {0, 90});
    p.canopy_top = Angle::degrees(top);
    table.number("canopy_db_per_m", p.canopy_db_per_m, {0, 10});
    table.quantity("most_foliage_db", p.most_foliage, {0, 100});
    table.quantity("antenna_film_db", p.antenna_film, {0, 100});
}

void read_antenna(TableReader& table, ModernSettings& settings, const std::filesystem::path& folder) {
    ModernLinkParameters& p = settings.propagation.link;
    Decibels peak = p.antenna.peak(), drop = p.antenna.drop();
    double exponent = p.antenna.exponent();
    table.quantity("antenna_peak_dbic", peak, {-100, 100});
    table.quantity("antenna_drop_db", drop, {0, 100});
    table.number("antenna_exponent", exponent, {0.1, 10});
    p.antenna = AntennaPattern(peak, drop, exponent);
    std::string file;
    table.text("antenna_table", file);
    if (file.empty()) return;
    settings.tables.push_back(folder / file);
    auto pattern = AntennaPattern::read(folder / file);
    if (pattern)
        p.antenna = std::move(*pattern);
    else
        table.mistake_of_file("antenna_table", pattern.error());
}

void read_satellite_table(TableReader& table, ModernSettings& settings, const std::filesystem::path& folder) {
    std::string file;
    table.text("satellite_table", file);
    if (file.empty()) return;
    settings.tables.push_back(folder / file);
    auto pattern = read_satellite_pattern_file(folder / file);
    if (pattern)
        settings.propagation.link.satellite_pattern = std::move(*pattern);
    else
        table.mistake_of_file("satellite_table", pattern.error());
}

void read_received_power(TableReader& table, ModernLinkParameters::ReceivedPower& p) {
    table.quantity("gps_dbw", p.gps, {-250, 0});
    table.quantity("sbas_dbw", p.sbas, {-250, 0});
    table.quantity("galileo_dbw", p.galileo, {-250, 0});
    table.quantity("beidou_dbw", p.beidou, {-250, 0});
    table.quantity("qzss_dbw", p.qzss, {-250, 0});
    table.quantity("glonass_dbw", p.glonass, {-250, 0});
    table.quantity("navic_dbw", p.navic, {-250, 0});
}

void read_link(TableReader& table, ModernSettings& settings, const std::filesystem::path& folder) {
    ModernLinkParameters& p = settings.propagation.link;
    read_received_power(table, p.received);
    read_satellite_table(table, settings, folder);
    read_antenna(table, settings, folder);
    table.quantity("antenna_temperature_k", p.noise.antenna_temperature, {0, 1e5});
    table.quantity("line_loss_db", p.noise.line_loss, {0, 100});
    table.quantity("noise_figure_db", p.noise.noise_figure, {0, 100});
    table.quantity("implementation_loss_db", p.implementation_loss, {0, 100});
    table.quantity("platform_noise_db", p.platform_noise, {0, 100});
    static constexpr std::array<Word<std::optional<NoiseEnvironment>>, 5> places{
        {{"none", std::nullopt},
         {"city", NoiseEnvironment::city},
         {"residential", NoiseEnvironment::residential},
         {"rural", NoiseEnvironment::rural},
         {"quiet-rural", NoiseEnvironment::quiet_rural}}};
    table.word("man_made_noise", places, p.man_made);
    table.quantity("satellite_spread_db", p.satellite_spread, {0, 20});
    table.quantity("ripple_db", p.ripple, {0, 20});
    table.quantity("ripple_time_s", p.ripple_time, {0.1, 1e6});
}

void read_interference(TableReader& table, ModernSettings& settings) {
    ModernLinkParameters& p = settings.propagation.link;
    if (table.has("jammer_to_signal_db")) {
        Decibels ratio(0);
        table.quantity("jammer_to_signal_db", ratio, {-100, 200});
        p.jammer_to_signal = ratio;
    }
    static constexpr std::array<Word<JammerKind>, 3> kinds{{{"narrow-band", JammerKind::narrow_band},
                                                            {"matched", JammerKind::matched},
                                                            {"wide-band", JammerKind::wide_band}}};
    table.word("kind", kinds, p.jammer);
    if (!p.jammer_to_signal) tell_idle(table, settings, "interference", {"kind"}, "beside jammer_to_signal_db");
}

void read_scintillation(TableReader& table, ModernSettings& settings) {
    ScintillationParameters& p = settings.propagation.scintillation_model;
    table.number("s4", p.s4, {0, 0.7});
    double sigma = p.sigma_phi.rad();
    table.number("sigma_phi_rad", sigma, {0, 3});
    p.sigma_phi = Angle::radians(sigma);
    table.boolean("equatorial_evening", p.equatorial_evening);
    table.number("evening_peak_h", p.evening_peak_h, {0, 24});
    table.number("evening_width_h", p.evening_width_h, {0.1, 24});
    const bool restless = p.s4 > 0 || p.sigma_phi > Angle();
    if (!restless || !p.equatorial_evening)
        tell_idle(table, settings, "scintillation", {"evening_peak_h", "evening_width_h"},
                  "with equatorial_evening = true, and s4 or sigma_phi_rad above 0");
    if (!restless)
        tell_idle(table, settings, "scintillation", {"equatorial_evening"}, "with s4 or sigma_phi_rad above 0");
}

}  // namespace

void read_modern_propagation_keys(TableReader& modern, ModernSettings& settings, const std::filesystem::path& folder) {
    ModernPropagationParameters& p = settings.propagation;
    modern.table("signal_in_space", [&](TableReader& t) { read_signal_in_space(t, p.signal_in_space_model); });
    modern.table("ionosphere", [&](TableReader& t) { read_ionosphere_truth(t, settings, folder); });
    modern.table("troposphere", [&](TableReader& t) { read_troposphere_truth(t, settings); });
    modern.table("losses", [&](TableReader& t) { read_losses(t, p.loss_model); });
    modern.table("link", [&](TableReader& t) { read_link(t, settings, folder); });
    modern.table("interference", [&](TableReader& t) { read_interference(t, settings); });
    modern.table("scintillation", [&](TableReader& t) { read_scintillation(t, settings); });
}

}  // namespace skyloop
