#include "modern_assembly.hpp"

#include "receiver_assembly.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "skyloop/propagation/modern_effects.hpp"
#include "skyloop/rinex/ionex_file.hpp"

namespace skyloop {
namespace {

std::filesystem::path nequick_folder(const DataFolders& data) {
    for (const auto& folder : data.folders)
        if (std::filesystem::exists(folder / "nequick_g")) return folder / "nequick_g";
    return "nequick_g";
}

// What a warm start under an open sky takes until the fourth satellite is tracked, about; the collection of its
// ephemeris takes the rest.
constexpr Seconds warm_search{3};

// The span for which maps must be there; of a run without an end its start.
TimeSpan span_of(const Scenario& scenario, GpsTime start) {
    return {start, advanced(start, scenario.run.duration.value_or(Seconds(0)))};
}

}  // namespace

Result<std::vector<std::unique_ptr<PropagationEffect>>> modern_effects_of(const Scenario& scenario,
                                                                          const NavigationSource& navigation,
                                                                          const WorldData& world) {
    const ModernSettings settings = effective(scenario.model.modern);
    ModernContext context;
    context.run = span_of(scenario, world.start);
    context.atmosphere = scenario.atmosphere;
    context.broadcast = navigation.ionosphere();
    if (settings.navigation.corrections.ionosphere != IonosphereCorrection::none)
        context.receiver_correction = IonosphereModel::klobuchar;
    if (settings.navigation.corrections.ionosphere == IonosphereCorrection::broadcast && context.broadcast.galileo)
        context.galileo_correction = IonosphereModel::ntcm_g;
    if (!settings.ionosphere_maps.empty()) {
        auto maps = read_ionex_file(settings.ionosphere_maps);
        if (!maps) return fail(maps.error());
        context.maps = NamedIonosphereMaps{settings.ionosphere_maps.string(), std::move(*maps)};
    }
    context.nequick_folder = nequick_folder(world.data);
    context.geoid = world.geoid;
    context.seed = scenario.run.seed;
    context.gas_losses = world.gas_losses;
    return modern_effects(settings.propagation, context);
}

std::optional<std::string> warning_of_last_map(const Scenario& scenario) {
    if (scenario.run.duration || scenario.model.sensor_model) return std::nullopt;
    const ModernPropagationParameters propagation = effective(scenario.model.modern).propagation;
    if (propagation.ionosphere_model.model != IonosphereModel::ionex || propagation.ionosphere.factor() == 0)
        return std::nullopt;
    const auto maps = read_ionex_file(scenario.model.modern.ionosphere_maps);
    if (!maps) return std::nullopt;  // which modern_effects_of() tells
    return fmt::format(
        "{}: its maps reach to {}; the run has no end, and from then on the last of them holds, turned with "
        "the Sun",
        scenario.model.modern.ionosphere_maps.string(),
        format_utc(to_utc(maps->maps.back().time, LeapSeconds::announced()), 0));
}

MeasuringReceiver measuring_receiver(const Scenario& scenario, const SimulationSetup& setup) {
    ModernSettings settings = effective(scenario.model.modern);
    // Satellites broadcast an ionosphere even where the navigation data has lost it or there is none.
    settings.navigation.corrections.default_ionosphere = true;
    settings.navigation.ephemeris_collection =
        settings.ephemeris_collection.value_or(std::max(setup.warm_start - warm_search, Seconds(0)));
    return {MeasurementEngine(settings.measurement, receiver_seed(scenario.run.seed, setup.receiver)),
            NavigationEngine(settings.navigation, {setup.navigation.get(), setup.geoid, LeapSeconds::announced()})};
}

}  // namespace skyloop
