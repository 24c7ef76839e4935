/// When a run with recorded orbits begins, and what its time asks of them.
#pragma once

#include <optional>
#include <set>
#include <string>
#include <vector>

#include "run/emulator/data_folders.hpp"
#include "run/scenario/scenario.hpp"
#include "world/gnss/navigation_data.hpp"

namespace skyloop::inline run {

/// What a run's receivers can solve with.
struct SolvableSky {
    std::set<Constellation> systems;  ///< SBAS adds to the others and is no solution alone
    std::optional<Geodetic> place;    ///< where the run begins; nothing: not known before
    Angle mask;
    bool one_clock = false;  ///< of all systems, as sensor models have it

    /// Of a run that may begin. The place is that of its first receiver; the file of a recorded path is read for it
    /// where the start of the run hangs on it, and what is wrong with that is told when it is loaded. Of a board that
    /// is not found, which is told when it is opened, all systems.
    static SolvableSky of(const Scenario& scenario, const DataFolders& folders);
    /// The same wherever one stands.
    [[nodiscard]] SolvableSky anywhere() const { return {systems, std::nullopt, mask, one_clock}; }
    /// Whether healthy satellites with orbits, where the place is known those above the mask, are enough for a position
    /// and the clock of each of their systems.
    [[nodiscard]] bool solvable(const NavigationSource& source, GpsTime time) const;
};

/// When a run with these data begins: as told, else when its sky can first be solved, and stays so for a minute. A
/// record that lies alone before all others would make a run begin where nothing can be solved. Where it never can: the
/// first record.
/// @param sky of a run without a start of its own  @param now the wall clock
GpsTime start_of(const Scenario& scenario, const NavigationData& data, const SolvableSky& sky, GpsTime now);

/// What is wrong with the time of the run, in sentences: it begins where the data have no orbits or too few satellites
/// stand above the mask, or it outlasts them.
std::vector<std::string> time_warnings(const Scenario& scenario, const NavigationData& data, const SolvableSky& sky,
                                       GpsTime start);

}  // namespace skyloop::inline run
