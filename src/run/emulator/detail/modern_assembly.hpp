/// The parts of a run that measures and solves.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "run/emulator/assembly.hpp"

namespace skyloop {

/// What lies outside the scenario.
struct WorldData {
    const Geoid* geoid = nullptr;
    GpsTime start;
    DataFolders data;
    std::shared_ptr<GasLossTable> gas_losses;
};

/// The effects of the modern profile, from a scenario's settings. Fails with `input` when a file they need is missing
/// or does not fit the run.
Result<std::vector<std::unique_ptr<PropagationEffect>>> modern_effects_of(const Scenario& scenario,
                                                                          const NavigationSource& navigation,
                                                                          const WorldData& world);

/// The receiver's own part. Navigation and geoid outlive it. @param last_place of place_before_start()
MeasuringReceiver measuring_receiver(const Scenario& scenario, const SimulationSetup& setup,
                                     const std::optional<Geodetic>& last_place);

}  // namespace skyloop
