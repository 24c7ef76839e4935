/// The parts of a run that measures and solves.
/// Maps of the ionosphere for a run.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/core/result.hpp"
#include "run/emulator/assembly.hpp"
#include "run/scenario/scenario.hpp"
#include "world/gnss/sbas_message.hpp"
#include "world/propagation/modern_effects.hpp"
#include "world/propagation/named_ionosphere_maps.hpp"

namespace skyloop::inline run {

/// The IONEX file that a run's delays come from; empty: none.
std::filesystem::path acting_ionosphere_maps(const Scenario& scenario);

/// Those of an IONEX file; nothing where none is named.
Result<std::optional<NamedIonosphereMaps>> load_ionosphere_maps(const std::filesystem::path& file);

/// The span for which maps must be there; of a run without an end its start.
TimeSpan span_of_tables(const Scenario& scenario, GpsTime start);

/// Of a run without an end: until when the maps of its ionosphere reach, of which the last then holds on. Nothing where
/// the run has an end or no maps act.
std::optional<std::string> warning_of_last_map(const Scenario& scenario);

/// What lies outside the scenario.
struct WorldData {
    const Geoid* geoid = nullptr;
    GpsTime start;
    DataFolders data;
    std::shared_ptr<GasLossTable> gas_losses;
    std::shared_ptr<const PreciseTruth> precise{};  ///< null: records are the truth
    const ReceiverEntry* receiver = nullptr;        ///< whose antenna it is; null: that of nobody, a point
};

/// From what the effects of the modern profile are made.
struct ModernWorld {
    ModernPropagationParameters parameters;
    ModernContext context;
};
/// That of a scenario. Fails with `input` when the maps that it needs are missing, or the calibration of the antenna.
Result<ModernWorld> modern_world_of(const Scenario& scenario, const NavigationSource& navigation,
                                    const WorldData& world);
/// What comes between the satellites and an antenna, and what SBAS satellites say of it; null: nothing.
struct WorldParts {
    std::vector<std::unique_ptr<PropagationEffect>> effects;
    std::unique_ptr<SbasSource> sbas{};
};
/// Those of the modern profile, from a scenario's settings. Fails with `input` when a file they need is missing or does
/// not fit the run.
Result<WorldParts> modern_parts_of(const Scenario& scenario, const SimulationSetup& setup);

/// The receiver's own part. Navigation and geoid outlive it. @param last_place of place_before_start()
MeasuringReceiver measuring_receiver(const Scenario& scenario, const SimulationSetup& setup,
                                     const std::optional<Geodetic>& last_place);

}  // namespace skyloop::inline run
