#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "detail/scenario_keys.hpp"

namespace skyloop {
namespace {

using Words = std::string_view;

void read_baseline(TableReader& table, ModelSettings& settings) {
    BaselineParameters& p = settings.baseline;
    LinkBudgetParameters& link = settings.link;
    static constexpr std::array<Words, 2> presets{"strict", "calibrated"};
    if (const auto preset = table.choice("preset", presets, presets.front()))
        p = *preset == 0 ? BaselineParameters::strict() : BaselineParameters::calibrated();
    table.quantity("snr_cutoff_dbhz", p.snr_cutoff, {-100, 100});
    table.integer("max_reflections", p.max_reflections, {0, 16});
    table.quantity("reflection_loss_db", link.reflection_loss, {0, 100});
    static constexpr std::array<Word<PowerMode>, 2> powers{
        {{"eirp", PowerMode::eirp}, {"received_spec", PowerMode::received_spec}}};
    table.word("power_mode", powers, link.power_mode);
    table.quantity("satellite_power_dbw", link.satellite_power, {-200, 200});
    table.quantity("specified_received_power_dbw", link.specified_received_power, {-300, 0});
    table.number("thermal_noise_dbw_hz", link.thermal_noise_dbw_hz, {-300, 0});
    static constexpr std::array<Word<UereStatistic>, 2> statistics{
        {{"sample_std", UereStatistic::sample_std}, {"rms", UereStatistic::rms}}};
    table.word("statistic", statistics, p.statistic);
    table.number("iono_fraction", p.iono_fraction, {0, 10});
    table.number("tropo_fraction", p.tropo_fraction, {0, 10});
    static constexpr std::array<Word<NoiseAxes>, 2> axes{
        {{"isotropic", NoiseAxes::isotropic}, {"covariance", NoiseAxes::covariance}}};
    table.word("axes", axes, p.axes);
}

void read_simple_models(TableReader& model, ModelSettings& settings) {
    model.table("ideal", [](TableReader&) {});
    model.table("constant-sigma", [&](TableReader& table) {
        table.quantity("horizontal_sigma_m", settings.constant_sigma.horizontal_sigma, {0, 1e6});
        table.quantity("vertical_sigma_m", settings.constant_sigma.vertical_sigma, {0, 1e6});
    });
    model.table("satellite-count", [&](TableReader& table) {
        const auto& standard = settings.satellite_count.sigma_m;
        const auto sigma = table.numbers("sigma_m", standard.size(), standard);
        if (!sigma) return;
        if (*std::min_element(sigma->begin(), sigma->end()) < 0)
            return table.mistake(
                "sigma_m",
                "has a negative number; expected standard deviations for 4, 5, 6, 7, 8, 9 or more satellites");
        std::copy(sigma->begin(), sigma->end(), settings.satellite_count.sigma_m.begin());
    });
    model.table("whole-path", [&](TableReader& table) {
        WholePathParameters& p = settings.whole_path;
        table.number("oxygen_height_km", p.oxygen_height_km, {0, 100});
        table.number("vapour_height_km", p.vapour_height_km, {0, 100});
        table.number("vapour_g_m3", p.vapour_g_m3, {0, 100});
        table.number("oxygen_db_per_km", p.oxygen_db_per_km, {0, 100});
        table.number("vapour_db_per_km_per_g_m3", p.vapour_db_per_km_per_g_m3, {0, 100});
    });
    model.table("refraction", [&](TableReader& table) {
        table.number("surface_refractivity", settings.refraction.surface_refractivity, {0, 1000});
        table.quantity("scale_height_m", settings.refraction.scale_height, {100, 1e5});
        table.number("residual_fraction", settings.refraction.residual_fraction, {0, 10});
    });
}

// How k is taken: what is told of it.
struct Concentration {
    std::optional<ConcentrationMode> mode;
    std::optional<double> fixed;

    void give(AtmosphericLayer& layer) const {
        layer.concentration = mode.value_or(layer.concentration);
        layer.fixed_concentration = fixed.value_or(layer.fixed_concentration);
    }
};

// The keys of one table, over what `told` has already.
Concentration read_concentration(TableReader& table, Concentration told = {}) {
    static constexpr std::array<Word<std::optional<ConcentrationMode>>, 3> modes{
        {{"mean", ConcentrationMode::mean},
         {"midpoint", ConcentrationMode::midpoint},
         {"fixed", ConcentrationMode::fixed}}};
    const bool has_number = table.has("fixed_concentration");
    if (has_number) told.mode = ConcentrationMode::fixed;
    table.word("concentration", modes, told.mode);
    if (has_number) {
        double fixed = 1;
        table.number("fixed_concentration", fixed, {0, 10});
        told.fixed = fixed;
    }
    return told;
}

// Undiluted air up to the last layer's top would be nobody's wish.
void check_number_of_fixed(TableReader& table, const Concentration& told) {
    if (told.mode == ConcentrationMode::fixed && !told.fixed)
        table.mistake("concentration", "is 'fixed' without a number; expected fixed_concentration, too");
}

void read_layers(TableReader& atmosphere, AtmosphereParameters& p) {
    // For all layers; a layer's own keys go before them.
    const Concentration of_all = read_concentration(atmosphere);
    if (atmosphere.has("layer")) p.layers.clear();
    atmosphere.tables("layer", [&](TableReader& table) {
        AtmosphericLayer layer;
        table.text("name", layer.name);
        table.quantity("base_m", layer.base, {-1000, 1e7});
        table.quantity("top_m", layer.top, {-1000, 1e7});
        table.number("vapour_g_m3", layer.vapour_g_m3, {0, 100});
        table.boolean("enabled", layer.enabled);
        const Concentration own = read_concentration(table, of_all);
        check_number_of_fixed(table, own);
        own.give(layer);
        if (layer.top <= layer.base)
            table.mistake_here(
                fmt::format("top_m is {}; expected more than base_m, {}", layer.top.value(), layer.base.value()));
        p.layers.push_back(layer);
    });
    if (of_all.mode && !atmosphere.has("layer")) {
        check_number_of_fixed(atmosphere, of_all);
        p.layers = default_layers();
        for (AtmosphericLayer& layer : p.layers)
            of_all.give(layer);
    }
}

void read_clouds(TableReader& atmosphere, AtmosphereParameters& p) {
    const std::vector<CloudDeck>& catalogue = cloud_catalogue();
    std::vector<Words> kinds;
    for (const CloudDeck& deck : catalogue)
        kinds.push_back(deck.kind);
    atmosphere.tables("cloud", [&](TableReader& table) {
        const auto kind = table.choice("kind", kinds);
        table.needs_one_of({"kind"}, "has no kind; expected fog, stratus, … thunderstorm");
        CloudDeck deck = catalogue[kind.value_or(0)];
        Metres thickness = deck.top - deck.base;
        table.quantity("base_m", deck.base, {0, 30000});
        table.quantity("thickness_m", thickness, {1, 30000});
        table.number("density_g_m3", deck.density_g_m3, {0, 100});
        deck.top = deck.base + thickness;
        p.clouds.push_back(deck);
    });
    atmosphere.boolean("clouds_apply_concentration", p.clouds_apply_concentration);
}

void read_rain(TableReader& atmosphere, AtmosphereParameters& p) {
    atmosphere.number("rain_mm_h", p.rain.rate_mm_h, {0, 500});
    atmosphere.quantity("rain_top_m", p.rain.top, {0, 30000});
    static constexpr std::array<Word<RainModel>, 2> models{
        {{"p838", RainModel::p838}, {"as_vapour", RainModel::as_vapour}}};
    atmosphere.word("rain_model", models, p.rain.model);
}

void read_environment(TableReader& atmosphere, AtmosphereParameters& p) {
    std::vector<Words> names;
    for (const Environment& e : environment_catalogue())
        names.push_back(e.name);
    if (const auto index = atmosphere.choice("environment", names))
        p.environment_noise = environment_catalogue()[*index].noise;
    atmosphere.note_not_both("environment", "environment_noise_db");
    if (atmosphere.has("environment") && atmosphere.has("environment_noise_db"))
        atmosphere.mistake("environment_noise_db", "stands beside environment; expected one of the two");
    atmosphere.quantity("environment_noise_db", p.environment_noise, {0, 100});
}

void read_ionosphere(TableReader& atmosphere, Scenario& scenario, const std::filesystem::path& folder) {
    AtmosphereParameters& p = scenario.atmosphere;
    static constexpr std::array<Word<TecSource>, 4> sources{{{"automatic", TecSource::automatic},
                                                             {"header", TecSource::header},
                                                             {"constant", TecSource::constant},
                                                             {"ionex", TecSource::ionex}}};
    // A number given is a number meant, and so are maps: they switch the broadcast coefficients off unless the source
    // is named as well.
    const bool has_maps = atmosphere.has("tec_maps");
    if (atmosphere.has("total_electron_content_tecu")) p.tec_source = TecSource::constant;
    if (has_maps) p.tec_source = TecSource::ionex;
    atmosphere.word("tec_source", sources, p.tec_source);
    if (has_maps)
        atmosphere.file_path("tec_maps", folder, scenario.tec_maps);
    else if (p.tec_source == TecSource::ionex)
        atmosphere.mistake("tec_source", "is ionex, but tec_maps names no file; expected an IONEX file");
    atmosphere.quantity("total_electron_content_tecu", p.total_electron_content, {0, 1000});
    atmosphere.quantity("ionosphere_loss_db", p.ionosphere_loss, {0, 100});
    atmosphere.quantity("riometer_absorption_30mhz_db", p.riometer_absorption_30mhz, {0, 100});
    atmosphere.quantity("ionosphere_base_m", p.ionosphere_base, {1e4, 1e6});
}

}  // namespace

void read_model_keys(TableReader& model, ModelSettings& settings, const std::filesystem::path& folder) {
    if (const auto index = model.choice("name", model_names(), model_name(settings)))
        choose_model(settings, model_names()[*index]);
    static constexpr std::array<Word<bool>, 2> errors{{{"all", true}, {"none", false}}};
    if (model.has("errors") && settings.sensor_model)
        model.mistake("errors",
                      fmt::format("belongs to the modern model; this scenario's is {}", model_name(settings)));
    model.word("errors", errors, settings.modern.errors);
    model.table("modern", [&](TableReader& table) { read_modern_keys(table, settings.modern, folder); });
    model.table("baseline", [&](TableReader& table) { read_baseline(table, settings); });
    read_simple_models(model, settings);
}

void read_atmosphere_keys(TableReader& atmosphere, Scenario& scenario, const std::filesystem::path& folder) {
    AtmosphereParameters& p = scenario.atmosphere;
    atmosphere.quantity("sea_level_temperature_k", p.sea_level_temperature, {100, 400});
    atmosphere.number("gravity_mps2", p.gravity_mps2, {0.1, 100});
    atmosphere.number("molar_mass_kg_per_mol", p.molar_mass_kg_per_mol, {0.001, 1});
    atmosphere.number("gas_constant_j_per_mol_k", p.gas_constant, {1, 100});
    atmosphere.quantity("earth_radius_m", p.earth_radius, {1e6, 1e7});
    atmosphere.number("oxygen_constant_ghz2", p.oxygen_constant, {0.001, 10});
    atmosphere.quantity("zenith_dry_delay_m", p.zenith_dry_delay, {0, 100});
    atmosphere.number("zenith_dry_decay_per_m", p.zenith_dry_decay_per_m, {0, 0.01});
    atmosphere.quantity("zenith_wet_delay_m", p.zenith_wet_delay, {0, 100});
    read_layers(atmosphere, p);
    read_clouds(atmosphere, p);
    read_rain(atmosphere, p);
    read_environment(atmosphere, p);
    read_ionosphere(atmosphere, scenario, folder);
}

}  // namespace skyloop
