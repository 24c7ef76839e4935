/// The only place that builds everything.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "skyloop/base/result.hpp"
#include "skyloop/emulator/emulator.hpp"
#include "skyloop/geo/geoid.hpp"
#include "skyloop/scenario/scenario.hpp"

namespace skyloop {

/// Where the program's own data lies: folders that may hold boards/ and geoids/, the first that has a thing wins.
struct DataFolders {
    std::vector<std::filesystem::path> folders;
};

/// Where find_board() is to look.
std::vector<std::filesystem::path> board_folders(const DataFolders& data);

/// How a run is driven.
struct RunMode {
    bool virtual_time = false;                    ///< as fast as possible, on the virtual clock
    GpsTime now{};                                ///< the wall clock at start, GPST
    std::int64_t now_steady_ns = 0;               ///< the steady clock at that instant
    std::optional<std::filesystem::path> record;  ///< where to keep the recording
    bool open_ports = true;                       ///< false: no wires, the recording alone
};

/// A run ready to go, and what its user should be told first.
struct Assembly {
    std::unique_ptr<Geoid> geoid;  ///< outlives the emulator, which looks up undulations in it
    std::unique_ptr<Emulator> emulator;
    GpsTime start;
    std::optional<GpsTime> end;
    std::string digest;  ///< scenario_digest()
    std::vector<std::string> warnings;
    std::vector<std::string> details;  ///< for those who ask: what was read, and from where
};

/// Takes a scenario apart and gives each part its piece.
Result<Assembly> assemble(const Scenario& scenario, const DataFolders& data, const RunMode& mode);

/// What a user gives that decides the bytes of a run, as 16 hexadecimal digits: the scenario's text with the options
/// and trajectory file laid over it, seed, start and navigation files. The board file counts by its name only.
std::string scenario_digest(const Scenario& scenario, GpsTime start);

/// Broadcast orbits for a scenario: its files, or the nominal constellation, and when its run begins. Fails with
/// `input` for files that hold nothing to use, with `usage` for settings that contradict each other.
/// @param now the wall clock, GPST
struct LoadedNavigation {
    std::unique_ptr<NavigationSource> source;
    GpsTime start;  ///< of the run
    std::vector<std::string> warnings;
};
Result<LoadedNavigation> load_navigation(const Scenario& scenario, GpsTime now);

/// The trajectory of a scenario, begun at `start`.
std::unique_ptr<Trajectory> make_trajectory(const TrajectorySettings& settings, GpsTime start);

/// The world of a scenario and its way to a fix. Fails with `input` when they do not fit each other.
/// @param geoid may be absent; outlives the simulation
/// @param data where the tables of the modern model's ionosphere lie
Result<Simulation> make_simulation(const Scenario& scenario, std::unique_ptr<NavigationSource> navigation,
                                   const Geoid* geoid, GpsTime start, const DataFolders& data = {});

/// What the user of a scenario should be told before anything is read from elsewhere.
std::vector<std::string> scenario_warnings(const Scenario& scenario);

/// How the receiver of a scenario is configured when it starts.
ReceiverSettings receiver_settings(const Scenario& scenario, const firmware::BoardProfile& board);

/// Whether every port of a scenario names a wire that this version has; opens none.
Result<void> check_port_names(const Scenario& scenario);

/// The EGM96 geoid, or nothing and a warning.
std::unique_ptr<Geoid> find_geoid(const DataFolders& data, std::vector<std::string>& warnings);

}  // namespace skyloop
