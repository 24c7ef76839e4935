#include "detail/weather_warnings.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <span>
#include <string_view>

namespace skyloop {
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

}  // namespace

std::vector<std::string> weather_warnings(const Scenario& scenario, const Geoid* geoid) {
    std::vector<std::string> warnings;
    warn_of_idle_keys(scenario, warnings);
    warn_of_weather_below(scenario, geoid, warnings);
    return warnings;
}

}  // namespace skyloop
