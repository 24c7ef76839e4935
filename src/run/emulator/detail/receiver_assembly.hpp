/// The part of the assembly that is made once for each receiver.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "run/emulator/assembly.hpp"
#include "run/emulator/osnma_files.hpp"
#include "run/emulator/wires.hpp"
#include "wire/transport/can_transport.hpp"

namespace skyloop::inline run {

/// What all receivers of a run share.
struct SharedParts {
    const Scenario& scenario;
    const DataFolders& data;
    const RunMode& mode;
    std::shared_ptr<const NavigationSource> navigation;
    const Geoid* geoid = nullptr;
    GpsTime start;
    std::shared_ptr<const UrbanScene> scene;        // null: nothing stands around
    std::shared_ptr<const PreciseTruth> precise{};  // null: records are the truth
    std::shared_ptr<GasLossTable> gas_losses = std::make_shared<GasLossTable>();
    std::shared_ptr<CanBuses> can_buses = std::make_shared<CanBuses>();
    std::shared_ptr<const OsnmaKeys> osnma = osnma_keys_of(scenario, start);  // null: there is none
};

/// One receiver before anything is opened or emptied for it.
struct PlannedStation {
    Station::Parts parts;
    std::vector<WireRequest> wires;
};

/// Builds the receiver of this place in the scenario's list. Fails with `usage` or `input`, naming the receiver when
/// there are several.
Result<PlannedStation> plan_station(const SharedParts& shared, std::size_t index, std::vector<std::string>& warnings);
/// Opens its wires and, against the clock, its actuator.
Result<void> plug_in(PlannedStation& station, const SharedParts& shared, std::size_t index);
/// What it is to save at the end of the run can be saved. Asked once its recording has a folder, where it may lie.
Result<void> check_state(const Station::Parts& parts, const SharedParts& shared, std::size_t index);
/// Claims the folder of its recording: the first receiver's is the folder itself, the others' are receiver1 and so on.
Result<void> add_recorder(Station::Parts& parts, const SharedParts& shared, std::size_t index);

/// The seed of a receiver's own random numbers. The first has that of all.
std::uint64_t receiver_seed(const RunSettings& run, std::size_t index);

/// An error of one receiver of several names it.
Error of_receiver(Error error, const Scenario& scenario, std::size_t index);

}  // namespace skyloop::inline run
