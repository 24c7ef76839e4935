#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "detail/scenario_keys.hpp"
#include "run/scenario/scenario.hpp"

namespace skyloop::inline run {
namespace {

using Words = std::string_view;

void read_baseline(TableReader& table, ModelSettings& settings) {
    BaselineParameters& p = settings.baseline;
    LinkBudgetParameters& link = settings.link;
    static constexpr std::array<Words, 2> presets{"strict", "calibrated"};
    if (const auto preset = table.choice("preset", presets, "calibrated sets iono_fraction 0.5 and tropo_fraction 0.1",
                                         presets.front()))
        p = *preset == 0 ? BaselineParameters::strict() : BaselineParameters::calibrated();
    table.quantity("snr_cutoff_dbhz", p.snr_cutoff, {-100, 100}, "a satellite exactly at the cut-off is used");
    table.integer("max_reflections", link.max_reflections, {0, 16}, "a path with more is no path");
    table.quantity("reflection_loss_db", link.reflection_loss, {0, 100}, "of each wall");
    table.word("power_mode", {{"eirp", PowerMode::eirp}, {"received_spec", PowerMode::received_spec}}, link.power_mode,
               "received_spec replaces power less free-space loss by the specified minimum");
    table.quantity("satellite_power_dbw", link.satellite_power, {-200, 200},
                   "equivalent isotropic power that a satellite sends");
    table.quantity("specified_received_power_dbw", link.specified_received_power, {-300, 0},
                   "of power_mode received_spec");
    table.number("thermal_noise_dbw_hz", link.thermal_noise_dbw_hz, {-300, 0}, "noise density of the receiver");
    table.word("statistic", {{"sample_std", UereStatistic::sample_std}, {"rms", UereStatistic::rms}}, p.statistic,
               "of the errors over the satellites");
    table.number("iono_fraction", p.iono_fraction, {0, 10},
                 "part of the ionospheric delay that enters the range error");
    table.number("tropo_fraction", p.tropo_fraction, {0, 10},
                 "part of the tropospheric delay that enters the range error");
    table.word("axes", {{"isotropic", NoiseAxes::isotropic}, {"covariance", NoiseAxes::covariance}}, p.axes,
               "the same variance on each ECEF axis, or the covariance of the solution");
}

void read_simple_models(TableReader& model, ModelSettings& settings) {
    model.table("ideal", "the truth", [](TableReader&) {});
    model.table("constant-sigma", "a sensor model: the same error everywhere", [&](TableReader& table) {
        table.quantity("horizontal_sigma_m", settings.constant_sigma.horizontal_sigma, {0, 1e6},
                       "one standard deviation of both horizontal axes together; each has it over √2");
        table.quantity("vertical_sigma_m", settings.constant_sigma.vertical_sigma, {0, 1e6},
                       "one standard deviation of the height");
    });
    model.table("satellite-count", "a sensor model: an error by the number of satellites", [&](TableReader& table) {
        auto& sigma = settings.satellite_count.sigma_m;
        table.numbers("sigma_m", sigma, "one standard deviation with 4, 5, 6, 7, 8 and more satellites");
        if (*std::min_element(sigma.begin(), sigma.end()) < 0)
            table.mistake(
                "sigma_m",
                "has a negative number; expected standard deviations for 4, 5, 6, 7, 8, 9 or more satellites");
    });
    model.table("whole-path", "a sensor model: losses over the whole path", [&](TableReader& table) {
        WholePathParameters& p = settings.whole_path;
        table.number("oxygen_height_km", p.oxygen_height_km, {0, 100}, "scale height of oxygen");
        table.number("vapour_height_km", p.vapour_height_km, {0, 100}, "scale height of water vapour");
        table.number("vapour_g_m3", p.vapour_g_m3, {0, 100}, "water vapour on the ground");
        table.number("oxygen_db_per_km", p.oxygen_db_per_km, {0, 100}, "loss in oxygen at L1");
        table.number("vapour_db_per_km_per_g_m3", p.vapour_db_per_km_per_g_m3, {0, 100}, "loss in water vapour at L1");
    });
    model.table("refraction", "a sensor model: refraction in the air", [&](TableReader& table) {
        table.number("surface_refractivity", settings.refraction.surface_refractivity, {0, 1000},
                     "N-units on the ground");
        table.quantity("scale_height_m", settings.refraction.scale_height, {100, 1e5}, "of the refractivity");
        table.number("residual_fraction", settings.refraction.residual_fraction, {0, 10},
                     "part of the delay that remains");
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

// The keys of one table, over what `told` has already. @param mode,number of the keys
Concentration read_concentration(TableReader& table, KeyText mode, KeyText number, Concentration told = {}) {
    if (table.has("fixed_concentration")) told.mode = ConcentrationMode::fixed;
    table.word("concentration",
               {{"mean", ConcentrationMode::mean},
                {"midpoint", ConcentrationMode::midpoint},
                {"fixed", ConcentrationMode::fixed}},
               told.mode, mode);
    table.number("fixed_concentration", told.fixed, {0, 10}, number);
    return told;
}

// Undiluted air up to the last layer's top would be nobody's wish.
void check_number_of_fixed(TableReader& table, const Concentration& told) {
    if (told.mode == ConcentrationMode::fixed && !told.fixed)
        table.mistake("concentration", "is 'fixed' without a number; expected fixed_concentration, too");
}

void read_layers(TableReader& atmosphere, AtmosphereParameters& p) {
    // For all layers; a layer's own keys go before them.
    const Concentration of_all = read_concentration(
        atmosphere,
        {"how k of all layers is taken, by which their air (oxygen and vapour) is thinned against that at the sea",
         "mean"},
        {"k of all layers, needed for concentration fixed; giving it makes fixed the way", "none"});
    if (atmosphere.has("layer")) p.layers.clear();
    atmosphere.tables(
        "layer", {"layers of the air; one replaces all of the defaults", "troposphere to thermosphere"},
        [&](TableReader& table) {
            AtmosphericLayer layer;
            table.text("name", layer.name, {"for people", "none"});
            table.quantity("base_m", layer.base, {-1000, 1e7},
                           "height of its lower end above the sea, of baseline above the ellipsoid");
            table.quantity("top_m", layer.top, {-1000, 1e7}, "height of its upper end; above the lower one");
            table.number("vapour_g_m3", layer.vapour_g_m3, {0, 100}, "water vapour in it");
            table.boolean("enabled", layer.enabled, "false: it is not there");
            const Concentration own = read_concentration(
                table, {"how its k is taken", "that of the atmosphere"},
                {"its k, needed for concentration fixed; giving it makes fixed the way", "that of the atmosphere"},
                of_all);
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
    atmosphere.tables("cloud", {"decks of clouds, of which those above the antenna act", "none"},
                      [&](TableReader& table) {
                          const auto kind = table.choice("kind", kinds, "which sets the numbers below");
                          table.needs_one_of({"kind"}, "has no kind; expected fog, stratus, … thunderstorm");
                          CloudDeck deck = catalogue[kind.value_or(0)];
                          Metres thickness = deck.top - deck.base;
                          table.quantity("base_m", deck.base, {0, 30000}, "height of its lower end above the sea");
                          table.quantity("thickness_m", thickness, {1, 30000}, "from its lower to its upper end");
                          table.number("density_g_m3", deck.density_g_m3, {0, 100}, "liquid water in it");
                          deck.top = deck.base + thickness;
                          p.clouds.push_back(deck);
                      });
    atmosphere.boolean("clouds_apply_concentration", p.clouds_apply_concentration, "clouds are thinned as the air is");
}

void read_rain(TableReader& atmosphere, AtmosphereParameters& p) {
    atmosphere.number("rain_mm_h", p.rain.rate_mm_h, {0, 500}, "rain at the antenna, where that is below its top");
    atmosphere.quantity(
        "rain_top_m", p.rain.top, {0, 30000},
        "height from which it falls, above the sea, of baseline above the ellipsoid; above it there is none");
    atmosphere.word("rain_model", {{"p838", RainModel::p838}, {"as_vapour", RainModel::as_vapour}}, p.rain.model,
                    "ITU-R P.838, or as vapour");
}

void read_environment(TableReader& atmosphere, AtmosphereParameters& p) {
    std::vector<Words> names;
    for (const Environment& e : environment_catalogue())
        names.push_back(e.name);
    if (const auto index =
            atmosphere.choice("environment", names, {"noise over thermal by the place, 1 to 40 dB", "countryside"}))
        p.environment_noise = environment_catalogue()[*index].noise;
    atmosphere.not_both("environment", "environment_noise_db");
    atmosphere.quantity("environment_noise_db", p.environment_noise, {0, 100}, {"the same as a number", "1"});
}

void read_ionosphere(TableReader& atmosphere, Scenario& scenario, const std::filesystem::path& folder) {
    AtmosphereParameters& p = scenario.atmosphere;
    // A number given is a number meant, and so are maps: they switch the broadcast coefficients off unless the source
    // is named as well.
    const bool has_maps = atmosphere.has("tec_maps");
    if (atmosphere.has("total_electron_content_tecu")) p.tec_source = TecSource::constant;
    if (has_maps) p.tec_source = TecSource::ionex;
    atmosphere.word("tec_source",
                    {{"automatic", TecSource::automatic},
                     {"header", TecSource::header},
                     {"constant", TecSource::constant},
                     {"ionex", TecSource::ionex}},
                    p.tec_source, "broadcast coefficients, the constant, or maps; automatic: header when there is one");
    if (has_maps)
        atmosphere.file_path(
            "tec_maps", folder, scenario.tec_maps,
            {"IONEX file: global maps that cover the run, without an end its start; giving it makes ionex the source",
             "none"});
    else if (p.tec_source == TecSource::ionex)
        atmosphere.mistake("tec_source", "is ionex, but tec_maps names no file; expected an IONEX file");
    atmosphere.quantity("total_electron_content_tecu", p.total_electron_content, {0, 1000},
                        "vertical; giving it switches the broadcast coefficients off");
    atmosphere.quantity("ionosphere_loss_db", p.ionosphere_loss, {0, 100}, "constant loss");
    atmosphere.quantity("riometer_absorption_30mhz_db", p.riometer_absorption_30mhz, {0, 100},
                        "zenith absorption at 30 MHz, scaled to the carrier");
    atmosphere.quantity("ionosphere_base_m", p.ionosphere_base, {1e4, 1e6},
                        "height at which that absorption's slant is taken, and from which on there is no loss");
}

}  // namespace

void read_model_keys(TableReader& model, ModelSettings& settings, const std::filesystem::path& folder) {
    if (const auto index = model.choice(
            "name", model_names(), "the way to a fix: modern measures and solves, the others add an error to the truth",
            model_name(settings)))
        choose_model(settings, model_names()[*index]);
    if (model.has("errors") && settings.sensor_model)
        model.mistake("errors",
                      fmt::format("belongs to the modern model; this scenario's is {}", model_name(settings)));
    model.word("errors", {{"all", true}, {"none", false}}, settings.modern.errors,
               "none switches every error and delay off, and the receiver's filter; modern only");
    model.table("modern", "measures what arrives and solves it",
                [&](TableReader& table) { read_modern_keys(table, settings.modern, folder); });
    model.table("baseline", "the article's sensor model", [&](TableReader& table) { read_baseline(table, settings); });
    read_simple_models(model, settings);
}

void read_atmosphere_keys(TableReader& atmosphere, Scenario& scenario, const std::filesystem::path& folder) {
    AtmosphereParameters& p = scenario.atmosphere;
    atmosphere.quantity("sea_level_temperature_k", p.sea_level_temperature, {100, 400}, "of the standard atmosphere");
    atmosphere.number("gravity_mps2", p.gravity_mps2, {0.1, 100}, "of the standard atmosphere");
    atmosphere.number("molar_mass_kg_per_mol", p.molar_mass_kg_per_mol, {0.001, 1}, "of air");
    atmosphere.number("gas_constant_j_per_mol_k", p.gas_constant, {1, 100}, "universal gas constant");
    atmosphere.quantity("earth_radius_m", p.earth_radius, {1e6, 1e7}, "of the spherical Earth of slant paths");
    atmosphere.number("oxygen_constant_ghz2", p.oxygen_constant, {0.001, 10},
                      "of the article's oxygen loss; 0.227 in the primary source");
    atmosphere.quantity("zenith_dry_delay_m", p.zenith_dry_delay, {0, 100}, "on the ground");
    atmosphere.number("zenith_dry_decay_per_m", p.zenith_dry_decay_per_m, {0, 0.01}, "with height");
    atmosphere.quantity("zenith_wet_delay_m", p.zenith_wet_delay, {0, 100}, "on the ground");
    read_layers(atmosphere, p);
    read_clouds(atmosphere, p);
    read_rain(atmosphere, p);
    read_environment(atmosphere, p);
    read_ionosphere(atmosphere, scenario, folder);
}

std::span<const std::string_view> model_names() {
    static const std::vector<std::string_view> names = [] {
        std::vector<std::string_view> all{"modern"};
        for (const ErrorModelKind kind : error_model_kinds())
            all.push_back(error_model_name(kind));
        return all;
    }();
    return names;
}

std::string_view model_name(const ModelSettings& settings) {
    return settings.sensor_model ? error_model_name(*settings.sensor_model) : model_names().front();
}

bool choose_model(ModelSettings& settings, std::string_view name) {
    const auto sensor_model = error_model_from_name(name);
    if (!sensor_model && name != model_names().front()) return false;
    settings.sensor_model = sensor_model;
    return true;
}

}  // namespace skyloop::inline run
