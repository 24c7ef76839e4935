#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <string_view>

#include "base/geo/frames.hpp"
#include "detail/run_warnings.hpp"
#include "firmware/core/state_tracker.hpp"

namespace skyloop::inline run {
namespace {

using AtmosphereKeys = std::span<const std::string_view>;

// Of [atmosphere]: what weakens signals as it passes by, what delays them, and the noise that all C/N0 is over.
constexpr std::string_view cloud_and_rain_keys[] = {"cloud", "rain_mm_h", "rain_top_m"};
constexpr std::string_view delay_keys[] = {
    "tec_source",        "tec_maps", "total_electron_content_tecu", "zenith_dry_delay_m", "zenith_dry_decay_per_m",
    "zenith_wet_delay_m"};
constexpr std::string_view environment_keys[] = {"environment", "environment_noise_db"};

// What a model but the baseline takes of [atmosphere]; that takes all.
struct TakenOfAtmosphere {
    std::vector<AtmosphereKeys> keys;
    std::string_view words;

    [[nodiscard]] bool has(std::string_view key) const {
        return std::any_of(keys.begin(), keys.end(),
                           [&](AtmosphereKeys some) { return std::find(some.begin(), some.end(), key) != some.end(); });
    }
};

TakenOfAtmosphere taken_of_atmosphere(const ModelSettings& model) {
    if (!model.sensor_model)
        return {{cloud_and_rain_keys}, "clouds and rain from [atmosphere] and the rest from [model.modern]"};
    if (*model.sensor_model == ErrorModelKind::whole_path)
        return {{delay_keys, environment_keys}, "electron content, zenith delays and environment from [atmosphere]"};
    return {{environment_keys}, "the environment alone from [atmosphere]"};
}

void warn_of_idle_keys(const Scenario& scenario, std::vector<std::string>& warnings) {
    if (scenario.model.sensor_model == ErrorModelKind::baseline) return;
    const TakenOfAtmosphere taken = taken_of_atmosphere(scenario.model);
    std::vector<std::string> idle = scenario.atmosphere_keys;
    std::erase_if(idle, [&](const std::string& key) { return taken.has(key); });
    if (!idle.empty())
        warnings.push_back(fmt::format("atmosphere.{}: without effect in {}, which takes {}",
                                       fmt::join(idle, ", atmosphere."), model_name(scenario.model), taken.words));
}

// The antenna's height as the model of the air takes it, and what it counts from.
struct WeatherHeight {
    Metres height;
    std::string_view above;
};

// MODELS.md 3.6 has one sphere for the shells and the antenna; only D-03 asks for the geoid.
WeatherHeight weather_height(const Scenario& scenario, const Geodetic& place, const Geoid* geoid) {
    if (scenario.model.sensor_model) return {place.height.above_ellipsoid, "above the ellipsoid"};
    const Metres undulation = geoid != nullptr ? geoid->undulation(place.latitude, place.longitude) : Metres(0);
    return {above_sea_level(place.height, undulation).above_sea_level, "above the sea"};
}

// Weather whose upper end is known to lie below the antenna.
void warn_of_weather_below(const Scenario& scenario, const Geoid* geoid, std::vector<std::string>& warnings) {
    const auto* fixed = std::get_if<FixedSettings>(&scenario.trajectory);
    const auto& sensor_model = scenario.model.sensor_model;
    const bool weather_acts = !sensor_model || *sensor_model == ErrorModelKind::baseline;
    if (fixed == nullptr || !weather_acts) return;
    const auto [height, above] = weather_height(scenario, fixed->at, geoid);
    const Rain& rain = scenario.atmosphere.rain;
    if (rain.rate_mm_h > 0 && height >= rain.top)
        warnings.push_back(
            fmt::format("atmosphere.rain_top_m: rain falls from {:g} m {}, below the antenna at {:.0f} m, and weakens "
                        "nothing there",
                        rain.top.value(), above, height.value()));
    for (const CloudDeck& deck : scenario.atmosphere.clouds)
        if (height >= deck.top)
            warnings.push_back(
                fmt::format("atmosphere.cloud: {} ends {:g} m {}, below the antenna at {:.0f} m, and weakens nothing "
                            "there",
                            deck.kind, deck.top.value(), above, height.value()));
}

std::string layer_text(const AtmosphericLayer& layer) {
    return fmt::format("{} ({:g} to {:g} m)", layer.name.empty() ? "a layer" : layer.name, layer.base.value(),
                       layer.top.value());
}

// Shells that lie in each other: their air counts twice.
void warn_of_overlapping_layers(const Scenario& scenario, std::vector<std::string>& warnings) {
    if (scenario.model.sensor_model != ErrorModelKind::baseline) return;
    std::vector<AtmosphericLayer> layers = scenario.atmosphere.layers;
    std::erase_if(layers, [](const AtmosphericLayer& layer) { return !layer.enabled; });
    std::stable_sort(layers.begin(), layers.end(), [](const auto& a, const auto& b) { return a.base < b.base; });
    const AtmosphericLayer* highest = nullptr;
    std::vector<std::string> pairs;
    for (const AtmosphericLayer& layer : layers) {
        if (highest != nullptr && layer.base < highest->top)
            pairs.push_back(layer_text(*highest) + " and " + layer_text(layer));
        if (highest == nullptr || layer.top > highest->top) highest = &layer;
    }
    if (pairs.empty()) return;
    const std::string more = pairs.size() > 1 ? fmt::format(", the first of {} such pairs", pairs.size()) : "";
    warnings.push_back(fmt::format("atmosphere.layer: {} overlap{}: the air that they share weakens signals twice",
                                   pairs.front(), more));
}

}  // namespace

std::vector<std::string> weather_warnings(const Scenario& scenario, const Geoid* geoid) {
    std::vector<std::string> warnings;
    warn_of_idle_keys(scenario, warnings);
    warn_of_weather_below(scenario, geoid, warnings);
    warn_of_overlapping_layers(scenario, warnings);
    return warnings;
}

namespace {

constexpr double longest_look_s = 3600;

// What a receiver without errors believes.
Fix fix_of(const TruthState& truth, const Geoid* geoid) {
    Fix fix;
    fix.position = truth.geodetic;
    if (geoid != nullptr) fix.geoid_undulation = geoid->undulation(truth.geodetic.latitude, truth.geodetic.longitude);
    const Eigen::Vector3d enu = LocalFrame(truth.geodetic).to_enu(truth.velocity).vector();
    fix.velocity = {enu.y(), enu.x(), -enu.z()};
    fix.speed = MetresPerSecond(std::hypot(enu.x(), enu.y()));
    return fix;
}

std::string which_limit(const firmware::BoardProfile& board, std::uint64_t model, const Fix& fix) {
    firmware::BoardProfile of_all = board;
    of_all.export_limits = firmware::ExportLimits::off;
    if (firmware::within_limits(of_all, model, fix)) return "its export_limits";
    of_all.dynamic_limits = false;
    return firmware::within_limits(of_all, model, fix) ? "the limits of its dynamic_model"
                                                       : "500 m/s, from which on no receiver does";
}

}  // namespace

std::optional<std::string> limit_warning(const PathUnderLimits& path) {
    const TrajectorySettings& way = trajectory_of(path.scenario, path.receiver);
    if (std::holds_alternative<LiveSettings>(way)) return std::nullopt;
    const auto vehicle = make_trajectory(way, path.start);
    const bool moves = !std::holds_alternative<FixedSettings>(way);
    const double run = path.end ? difference(*path.end, path.start).value() : longest_look_s;
    const double step = std::max(1.0, run / longest_look_s);
    const auto looks = moves ? static_cast<int>(run / step) + 1 : 1;
    const std::uint64_t model = firmware::dynamic_model_number(path.dynamic_model);
    std::optional<std::pair<double, Fix>> first;
    int beyond = 0;
    for (int i = 0; i < looks; ++i) {
        const Fix fix = fix_of(vehicle->at(advanced(path.start, Seconds(i * step))), path.geoid);
        if (firmware::within_limits(path.board, model, fix)) continue;
        if (!first) first = {i * step, fix};
        ++beyond;
    }
    if (!first) return std::nullopt;
    const Fix& fix = first->second;
    const double height = above_sea_level(fix.position.height, fix.geoid_undulation).above_sea_level.value();
    const std::string how_long =
        beyond == looks ? "in the whole run"
                        : fmt::format("in {:.2g} % of the run, from {:.0f} s on", 100.0 * beyond / looks, first->first);
    return fmt::format("{} tells no fix {}: {:.0f} m above the sea at {:.0f} m/s is beyond {}", path.board.name,
                       how_long, height, std::hypot(fix.speed.value(), fix.velocity.down),
                       which_limit(path.board, model, fix));
}

}  // namespace skyloop::inline run
