/// The only place that builds everything.
/// All mistakes of a scenario, not the first alone.
/// run.json: what ran and what it counted.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/core/result.hpp"
#include "base/geo/geoid.hpp"
#include "firmware/core/board_profile.hpp"
#include "run/emulator/data_folders.hpp"
#include "run/emulator/emulator.hpp"
#include "run/emulator/load_scene.hpp"
#include "run/emulator/real_time.hpp"
#include "run/output/run_output.hpp"
#include "run/scenario/scenario.hpp"
#include "wire/ntrip/ntrip_caster.hpp"
#include "world/gnss/precise_truth.hpp"
#include "world/propagation/atmosphere_losses.hpp"

namespace skyloop::inline run {

struct WireRequest;

/// What a program that has the emulator inside itself puts in the place of the outside world.
struct Embedding {
    /// The other end of a wire, instead of what its URI says; null for one that is to be opened as ever.
    std::function<std::unique_ptr<Transport>(std::size_t receiver, const WireRequest&)> open_wire{};
    /// What stands between a receiver and its satellites besides the scenario's own scene.
    std::function<std::unique_ptr<PropagationEffect>(std::size_t receiver)> obstacles{};
};

/// Where find_board() is to look.
std::vector<std::filesystem::path> board_folders(const DataFolders& data);

/// How a run is driven.
struct RunMode {
    bool virtual_time = false;                      ///< as fast as possible, on the virtual clock
    GpsTime now{};                                  ///< the wall clock at start, GPST
    std::int64_t now_steady_ns = 0;                 ///< the steady clock at that instant
    std::optional<std::filesystem::path> record;    ///< where the recording goes that Emulator::begin() begins
    bool open_ports = true;                         ///< false: no wires, the recording alone
    bool only_checked = false;                      ///< nothing will run: live sources are not opened
    bool first_ports_only = false;                  ///< of several receivers only the first gets its wires
    std::optional<std::filesystem::path> repeat{};  ///< a recording whose clients' bytes are heard again
    CommandQueue* live_commands = nullptr;          ///< where other threads ask for something; outlives the run
    PowerWatchdog* power_watchdog = nullptr;        ///< over the actuators, by receiver; outlives the run; null: none
    const Embedding* embedding = nullptr;  ///< of a run that a program leads; read while assembling; null: none
};

/// What was told to another program beside the wires, and what became of it.
struct OutputSummary {
    std::string description;
    OutputCounts counts;
};

/// What became of the run's own caster.
struct CasterSummary {
    std::string description;
    NtripCasterCounts counts;
};

/// A run ready to go, and what its user should be told first.
struct Assembly {
    std::unique_ptr<Geoid> geoid;  ///< outlives the emulator, which looks up undulations in it
    std::unique_ptr<Emulator> emulator;
    GpsTime start;
    Geodetic place{};  ///< of the first receiver's vehicle at the start
    std::optional<GpsTime> end;
    std::string digest;                      ///< scenario_digest()
    std::string trajectory;                  ///< what the recorded path is; empty: it is none
    std::vector<std::string> track_details;  ///< what was found in its file, a line each
    LoadedScene scene;                       ///< what stands around; its warnings are among those below
    std::vector<std::string> warnings;
    std::vector<std::string> notes{};           ///< what was chosen among others
    std::optional<DeadlineGrants> deadlines{};  ///< that its loop was given; nothing: it has none to keep
    std::vector<OutputSummary> outputs{};       ///< of the run, once it is over
    std::optional<CasterSummary> caster{};      ///< the same; nothing: there was none
    std::vector<std::string> details;           ///< for those who ask: what was read, and from where
};

/// Takes a scenario apart and gives each part its piece. What is in the folder of a recording stays as it is until
/// Emulator::begin(), which has to come before the run.
Result<Assembly> assemble(const Scenario& scenario, const DataFolders& data, const RunMode& mode);

/// What a user gives that decides the bytes of a run, as 16 hexadecimal digits: the scenario's text with the options
/// and trajectory file laid over it, seed, start, scene, and the files of navigation, tracks, states, boards,
/// ionosphere maps and antennas. What clients say is in none.
/// @param scene digest of the files of the scene; 0: there are none
std::string scenario_digest(const Scenario& scenario, const DataFolders& data, GpsTime start, std::uint64_t scene = 0);

/// Broadcast orbits for a scenario: its files, that of the cache, or the nominal sky, and when its run begins. Without
/// a start of its own a run with files begins when enough satellites that its receivers solve with first have orbits
/// and stand above the mask where the run begins. Fails with `input` for files that hold nothing to use, with `usage`
/// for settings that contradict each other.
/// @param now the wall clock, GPST
/// @param folders where the boards are, one that is not there counts as one that tracks every system, and the cache
struct LoadedNavigation {
    std::unique_ptr<NavigationSource> source{};
    GpsTime start{};  ///< of the run
    std::vector<std::string> warnings{};
    std::vector<std::string> notes{};               ///< what was chosen among others
    std::vector<std::filesystem::path> files{};     ///< that were read
    std::shared_ptr<const PreciseTruth> precise{};  ///< by load_precise_truth(); null: records are the truth
};
Result<LoadedNavigation> load_navigation(const Scenario& scenario, GpsTime now, const DataFolders& folders = {});

/// Adds the precise products of a scenario, where it names some, as the truth behind its navigation data. A run without
/// a start of its own then begins where they do, at the earliest; of satellites that they do not know it warns. Fails
/// with `input` for files that cannot be read, with `usage` where the run is outside of their time, and where it has no
/// records of that day that could be wrong.
Result<void> load_precise_truth(const Scenario& scenario, LoadedNavigation& loaded);

/// The trajectory of a scenario, begun at `start`. That of a file must have been loaded by load_track().
std::unique_ptr<Trajectory> make_trajectory(const TrajectorySettings& settings, GpsTime start);

struct SimulationSetup;
/// The path of a receiver's antenna: that of the vehicle, or beside it when it has a lever arm.
std::unique_ptr<Trajectory> make_antenna_path(const Scenario& scenario, const SimulationSetup& setup);
/// The same on a vehicle that goes another way than the scenario says.
std::unique_ptr<Trajectory> make_antenna_path(const Scenario& scenario, std::size_t receiver,
                                              std::unique_ptr<Trajectory> vehicle);
/// Where a receiver was when it was last on, which it knows at a warm start of the run and at a hot one of `power_up`:
/// where it is. Nothing at other starts, of which one has been on for long, and where a live source is yet to tell.
/// @param now the truth at the start
std::optional<Geodetic> place_before_start(const Scenario& scenario, std::size_t receiver, const TruthState& now);

/// What the simulation of one antenna needs besides the scenario.
struct SimulationSetup {
    std::shared_ptr<const NavigationSource> navigation;
    const Geoid* geoid = nullptr;  ///< may be absent; outlives the simulation
    GpsTime start;
    DataFolders data{};        ///< where the tables of the modern model's ionosphere lie
    std::size_t receiver = 0;  ///< whose antenna: its place in the scenario's list
    /// What stands around; null: nothing, whatever the scenario says.
    std::shared_ptr<const UrbanScene> scene{};
    const Embedding* embedding = nullptr;                ///< null: none
    double epochs_per_second = 1;                        ///< of the receiver, at start
    Seconds warm_start = firmware::Timing().warm_start;  ///< of the receiver's board, to its first fix
    std::string board_keys{};                            ///< BoardProfile::modern
    double geoid_step_deg = 0;                           ///< the same
    /// Of the modern model; receivers of one run share it.
    std::shared_ptr<GasLossTable> gas_losses = std::make_shared<GasLossTable>();
    std::shared_ptr<const OsnmaKeys> osnma{};       ///< null: Galileo's pages are not authenticated
    std::shared_ptr<const PreciseTruth> precise{};  ///< that the receivers of a run share; null: records are the truth
};
/// The world of a scenario and its way to a fix. Receivers of one run share the world and its errors; what their own
/// electronics add differs. Fails with `input` when scenario and world do not fit each other.
Result<Simulation> make_simulation(const Scenario& scenario, const SimulationSetup& setup);

/// What the user of a scenario should be told of the scenario alone. @param geoid null: the ellipsoid stands in for the
/// sea
std::vector<std::string> scenario_warnings(const Scenario& scenario, const Geoid* geoid);

/// How a receiver of a scenario is configured when it starts. @param index its place in the scenario's list
ReceiverSettings receiver_settings(const Scenario& scenario, const firmware::BoardProfile& board,
                                   std::size_t index = 0);

/// The EGM96 geoid, or nothing and a warning.
std::unique_ptr<Geoid> find_geoid(const DataFolders& data, std::vector<std::string>& warnings);

/// `first`, and a line for each other mistake that shows when navigation data, track, timeline, live sources, scene and
/// receivers are each tried by themselves. A file that a key names and that is not there is a mistake at that key.
/// @param scenario as far as it could be read
/// @param now the wall clock, GPST
Error with_other_mistakes(const Error& first, const Scenario& scenario, const DataFolders& data, GpsTime now);

/// What a summary is of: a run that begins, so that one that is killed can still be repeated, or one that has ended, as
/// it was to or, stopped from outside, before.
enum class SummaryOf { beginning, end, cut_end };

/// The text of run.json: version, seed, digest, start, counts, bytes and the lateness histogram.
std::string run_summary(const Scenario& scenario, const Assembly& assembly, std::string_view version,
                        SummaryOf what = SummaryOf::end);

}  // namespace skyloop::inline run
