#include <fmt/format.h>

#include <algorithm>

#include "base/core/words.hpp"
#include "base/time/utc_time.hpp"
#include "detail/modern_assembly.hpp"
#include "detail/receiver_assembly.hpp"
#include "receiver/error_model/model_effects.hpp"
#include "world/rinex/ionex_file.hpp"
#include "world/sbas/sbas_services.hpp"

namespace skyloop::inline run {

std::filesystem::path acting_ionosphere_maps(const Scenario& scenario) {
    if (const auto& model = scenario.model.sensor_model) {
        const bool take_maps = takes_electron_content(*model) && scenario.atmosphere.tec_source == TecSource::ionex;
        return take_maps ? scenario.tec_maps : std::filesystem::path();
    }
    const ModernSettings settings = effective(scenario.model.modern);
    const ModernPropagationParameters& propagation = settings.propagation;
    const bool act =
        propagation.ionosphere_model.model == IonosphereModel::ionex && propagation.ionosphere.factor() != 0;
    return act ? settings.ionosphere_maps : std::filesystem::path();
}

Result<std::optional<NamedIonosphereMaps>> load_ionosphere_maps(const std::filesystem::path& file) {
    if (file.empty()) return std::nullopt;
    auto maps = read_ionex_file(file);
    if (!maps) return fail(maps.error());
    return NamedIonosphereMaps{file.string(), std::move(*maps)};
}

TimeSpan span_of_tables(const Scenario& scenario, GpsTime start) {
    return {start, advanced(start, scenario.run.duration.value_or(Seconds(0)))};
}

std::optional<std::string> warning_of_last_map(const Scenario& scenario) {
    if (scenario.run.duration) return std::nullopt;
    const std::filesystem::path file = acting_ionosphere_maps(scenario);
    if (file.empty()) return std::nullopt;
    const auto maps = read_ionex_file(file);
    if (!maps || maps->maps.empty()) return std::nullopt;  // which load_ionosphere_maps() and check_coverage() tell
    return fmt::format(
        "{}: its maps reach to {}; the run has no end, and from then on the last of them holds, turned with the Sun",
        file.string(), utc_text(maps->maps.back().time));
}

namespace {

std::filesystem::path nequick_folder(const DataFolders& data) {
    for (const auto& folder : data.folders)
        if (std::filesystem::exists(folder / "nequick_g")) return folder / "nequick_g";
    return "nequick_g";
}

// What a warm start under an open sky takes until the fourth satellite is tracked, about; the collection of its
// ephemeris takes the rest.
constexpr Seconds warm_search{3};

// Of the receiver's antenna, from the catalogue of the run.
Result<std::optional<AntennaCalibration>> calibration_of(const WorldData& world) {
    if (world.receiver == nullptr || world.receiver->antenna_type.empty()) return std::nullopt;
    const std::string name = receiver_antenna_name(world.receiver->antenna_type);
    const auto place = world.receiver->told_at.find("antenna_type");
    const std::string at = place == world.receiver->told_at.end() ? "receiver.antenna_type: " : place->second;
    const AntennaCatalogue* const catalogue = world.precise ? world.precise->antennas().get() : nullptr;
    if (catalogue == nullptr)
        return fail(
            ErrorCode::usage,
            fmt::format("{}'{}' needs its calibration; expected an ANTEX file in sky.antennas, beside sky.orbits", at,
                        name));
    const auto found = catalogue->receivers.find(name);
    if (found != catalogue->receivers.end()) return found->second;
    std::vector<std::string_view> known;
    for (const auto& [other, calibration] : catalogue->receivers)
        known.push_back(other);
    return fail(ErrorCode::usage,
                fmt::format("{}'{}' is not in sky.antennas; expected an antenna and a radome that are{}", at, name,
                            did_you_mean(name, known)));
}

}  // namespace

Result<ModernWorld> modern_world_of(const Scenario& scenario, const NavigationSource& navigation,
                                    const WorldData& world) {
    ModernSettings settings = effective(scenario.model.modern);
    // The scene describes obstacles and echoes, but no tunnels.
    if (scenario.scene.given()) {
        settings.propagation.channel_model.environment.reset();
        for (SurroundingsStretch& stretch : settings.propagation.stretches)
            stretch.channel.environment.reset();
    }
    ModernContext context;
    context.run = span_of_tables(scenario, world.start);
    context.atmosphere = scenario.atmosphere;
    context.broadcast = navigation.ionosphere();
    if (settings.navigation.corrections.ionosphere != IonosphereCorrection::none)
        context.receiver_correction = IonosphereModel::klobuchar;
    if (settings.navigation.corrections.ionosphere == IonosphereCorrection::broadcast && context.broadcast.galileo)
        context.galileo_correction = IonosphereModel::ntcm_g;
    auto maps = load_ionosphere_maps(settings.ionosphere_maps);
    if (!maps) return fail(maps.error());
    context.maps = std::move(*maps);
    context.nequick_folder = nequick_folder(world.data);
    context.geoid = world.geoid;
    auto antenna = calibration_of(world);
    if (!antenna) return fail(antenna.error());
    context.receiver_antenna = std::move(*antenna);
    context.precise = world.precise;
    context.seed = scenario.run.seed_of_sky();
    context.gas_losses = world.gas_losses;
    return ModernWorld{std::move(settings.propagation), std::move(context)};
}

Result<WorldParts> modern_parts_of(const Scenario& scenario, const SimulationSetup& setup) {
    const auto world =
        modern_world_of(scenario, *setup.navigation,
                        {setup.geoid, setup.start, setup.data, setup.gas_losses, setup.precise,
                         setup.receiver < scenario.receivers.size() ? &scenario.receivers[setup.receiver] : nullptr});
    if (!world) return fail(world.error());
    auto effects = modern_effects(world->parameters, world->context);
    if (!effects) return fail(effects.error());
    // The same place for all receivers of the run, whose satellites send the same.
    const Geodetic place = make_trajectory(trajectory_of(scenario, 0), setup.start)->at(setup.start).geodetic;
    auto sbas = sbas_services({setup.navigation, world->parameters, world->context, place});
    if (!sbas) return fail(sbas.error());
    return WorldParts{std::move(*effects), std::move(*sbas)};
}

MeasuringReceiver measuring_receiver(const Scenario& scenario, const SimulationSetup& setup,
                                     const std::optional<Geodetic>& last_place) {
    ModernSettings settings = effective(with_board(scenario.model.modern, setup.board_keys));
    // Satellites broadcast an ionosphere even where the navigation data has lost it or there is none.
    settings.navigation.corrections.default_ionosphere = true;
    settings.navigation.ephemeris_collection =
        settings.ephemeris_collection.value_or(std::max(setup.warm_start - warm_search, Seconds(0)));
    NavigationKnowledge knowledge{setup.navigation.get(), setup.geoid, LeapSeconds::announced()};
    knowledge.geoid_step_deg = setup.geoid_step_deg;
    if (last_place) knowledge.last_place = to_ecef(*last_place);
    return {MeasurementEngine(settings.measurement, receiver_seed(scenario.run, setup.receiver)),
            NavigationEngine(settings.navigation, knowledge)};
}

}  // namespace skyloop::inline run
