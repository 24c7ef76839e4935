/// One run, as plain data: what a scenario file and the command line say.
/// The buildings around a run, as a scenario sets them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "base/geo/simulator_frames.hpp"
#include "firmware/core/board_profile.hpp"
#include "motion/trajectory/generated_path.hpp"
#include "motion/trajectory/geometric_paths.hpp"
#include "motion/trajectory/live_path.hpp"
#include "motion/trajectory/recorded_path.hpp"
#include "motion/trajectory/route.hpp"
#include "motion/trajectory/source_clock.hpp"
#include "motion/trajectory/track.hpp"
#include "receiver/error_model/model_parameters.hpp"
#include "run/fault/command.hpp"
#include "run/fault/fault_kind.hpp"
#include "run/fault/timeline.hpp"
#include "run/output/output_settings.hpp"
#include "run/scenario/campaign_settings.hpp"
#include "run/scenario/modern_settings.hpp"
#include "run/verdict/expectation.hpp"
#include "world/city/city_file.hpp"
#include "world/flow/receiver_settings.hpp"
#include "world/gnss/ephemeris.hpp"
#include "world/propagation/propagation_parameters.hpp"

namespace skyloop::inline run {

/// In place of a file: demo_city().
inline constexpr const char* demo_scene_name = "demo";

/// [scene]: which files stand around the antenna, how they are read, and what their surfaces do.
struct SceneEntry {
    std::vector<std::filesystem::path> buildings;  ///< files, or demo_scene_name; joined into one frame
    std::filesystem::path terrain;                 ///< height grid; empty: none
    /// Without an origin the frame lies antenna_above_scene below scene_start() (emulator/load_scene.hpp).
    CityFileSettings reading;
    std::string origin_told_at = "scene.origin: ";  ///< "FILE:LINE:COLUMN: KEY: ", for messages

    std::optional<int> reflections;       ///< most of one path, 1 … 16; nothing: 16, in the modern model 3
    bool roofs_reflect = false;           ///< besides walls
    std::optional<bool> ground_reflects;  ///< nothing: in the modern model alone
    bool diffraction = true;              ///< modern: at edges
    double scattering = 0.6;              ///< modern: coefficient of rough walls
    bool foliage = true;                  ///< modern: the scene's own trees
    int rays = 0;                         ///< of a search, of the whole hemisphere; 0: by the epoch rate
    std::optional<int> threads;           ///< of each receiver, that search beside the loop; nothing: 1, of led runs 0
    std::size_t memory_limit_mb = 4096;   ///< of the scene; 0: none
    bool cache = true;                    ///< of cities that take time to read

    /// False: nothing stands around, the default.
    [[nodiscard]] bool given() const { return !buildings.empty() || !terrain.empty(); }
};

/// "FILE:LINE:COLUMN: KEY: " by keys, for what shows only when a run is put together; what an option has given is not
/// among them.
using ToldPlaces = std::map<std::string, std::string, std::less<>>;

/// Seconds; with it a run's span stays far inside 64-bit nanoseconds.
inline constexpr double longest_run_s = 100 * 366.0 * 86400;

struct RunSettings {
    std::optional<GpsTime> start;  ///< nothing: now, or the first epoch of the navigation data
    bool start_now = false;
    std::optional<Seconds> duration;  ///< nothing: until stopped
    std::uint64_t seed = 1;
    std::optional<std::uint64_t> sky_seed, receiver_seed;  ///< nothing: `seed`
    double speed = 1;                                      ///< simulated seconds per second
    [[nodiscard]] std::uint64_t seed_of_sky() const { return sky_seed.value_or(seed); }
    [[nodiscard]] std::uint64_t seed_of_receivers() const { return receiver_seed.value_or(seed); }
};

/// In the place of navigation files: those of the day, whatever they are called.
inline constexpr std::string_view automatic_navigation_word = "auto";

/// Products that were computed afterwards.
struct PreciseFiles {
    std::vector<std::filesystem::path> orbits;  ///< SP3; empty: records are the truth
    std::vector<std::filesystem::path> clocks;  ///< RINEX clock files; empty: those of the orbits
    std::vector<std::filesystem::path> biases;  ///< SINEX BIAS; empty: codes are late as it is broadcast
    std::filesystem::path antennas;             ///< ANTEX; empty: signals leave from the centre of mass
};

/// What happens to the keys of OSNMA, and when after the start; at most one of them.
struct OsnmaEvents {
    std::optional<Seconds> new_key, new_chain, revoked_chain, revoked_key, alert;
};

struct SkySettings {
    std::vector<std::filesystem::path> navigation;  ///< empty: the nominal sky
    bool automatic_navigation = false;              ///< that of the start's day in the cache, where there is one
    PreciseFiles precise;                           ///< the truth behind what satellites send
    bool rebase_navigation = false;                 ///< move the data to the start time, keeping its time of day
    std::vector<Constellation> constellations;      ///< empty: all of the data; for sensor models gps and qzss
    std::optional<Angle> elevation_mask;            ///< nothing: the board's; of sensor models 5°
    std::optional<EphemerisRule> ephemeris_rule;    ///< nothing: the model's own rule
    std::optional<Seconds> ephemeris_validity;      ///< nothing: each system's own
    bool osnma = false;                             ///< Galileo's pages are authenticated
    OsnmaEvents osnma_events;
};

/// Paths are kept as what was asked for; they become a Trajectory when the start time is known. The heading, clockwise
/// from true north, is that of the vehicle until it moves: from then on it looks where it goes.
struct FixedSettings {
    Geodetic at = Geodetic::degrees(46.4774, 30.7326, 77);
    Angle heading{};
};
struct WaypointSettings {
    std::vector<Waypoint> corners{};
    Angle heading{};
};
struct CircleSettings {
    Circle::Shape shape{};
    Angle heading{};
};
/// A recorded path. Its file is read by load_track() (emulator/load_track.hpp), which needs the geoid.
struct FileSettings {
    std::filesystem::path path{};
    std::string path_told_at{};  ///< "FILE:LINE:COLUMN: KEY: ", for messages; empty: in no file
    Angle heading{};
    bool keeps_time = false;           ///< the rows keep their own GPS time; else the first one is the start of the run
    std::optional<Geodetic> origin{};  ///< of local metres and of heights above the ground, where the file has such
    Seconds gap{10};  ///< stretches without rows longer than this are told, and become what the policy says
    GapPolicy gap_policy = GapPolicy::bridge;
    Playback playback{};
    std::optional<VehicleClass> vehicle{};  ///< stands by its motion where the rows tell no attitude
    bool heading_given = false;             ///< else a vehicle of a class looks where it first goes
    Smoothing smoothing = Smoothing::none;
    std::optional<MetresPerSecond> route_speed{};  ///< of places without times; nothing: the file's or the vehicle's
    Metres route_tolerance{2};                     ///< RouteSettings::tolerance
    bool route_told = false;                       ///< one of both has been given
    std::shared_ptr<const Track> track{};          ///< clean; null until it has been loaded
    std::vector<TrackGap> gaps{};
    std::shared_ptr<const FlownRoute> route{};  ///< of a track without times; null for others
    std::shared_ptr<const Trajectory> way{};    ///< as the run plays it, for all who ride on it; null until then
    /// How the curve is led through the rows.
    [[nodiscard]] CurveSettings curve() const {
        return {vehicle, heading_given ? std::optional(heading) : std::nullopt, smoothing};
    }
    /// How places without times are flown.
    [[nodiscard]] RouteSettings route_settings() const {
        return {vehicle, route_speed ? std::optional(route_speed->value()) : std::nullopt, route_tolerance.value(),
                heading.rad()};
    }
};
/// What becomes of a run whose source of truth is silent for long.
enum class LostSource { hold, outage, pause, stop };
/// A path that another program flies at this moment. It becomes a LivePath when the source is opened, by open_feeds()
/// (emulator/live_feeds.hpp).
struct LiveSettings {
    std::string source{};                                ///< "udp-json:5000": parse_feed_address()
    std::string source_told_at = "trajectory.source: ";  ///< "FILE:LINE:COLUMN: KEY: ", for messages
    std::string vehicle{};  ///< which one of the source's; empty: the first that it speaks of
    Angle heading{};
    std::optional<Geodetic> at{};  ///< where the vehicle stands until the source speaks; nothing: the run waits for it
    ClockMode clock = ClockMode::realtime;
    bool sea_is_ellipsoid = false;        ///< what the source calls height above the sea is height above the ellipsoid
    std::optional<Geodetic> origin{};     ///< of sources that count in local metres
    std::optional<LocalMap> local_map{};  ///< how such metres lie on the Earth; nothing: as the source means them
    bool filtered = false;                ///< places that a receiver measured go through a filter
    double rate_hz = 50;                  ///< asked of sources that can be asked
    Seconds delay{0};                     ///< LivePathSettings::delay
    Seconds lost_after{5};                ///< of silence
    LostSource when_lost = LostSource::hold;
    std::shared_ptr<LivePath> path{};  ///< null until it has been opened
};
/// A path that is generated. It is planned when it is read, and by load_track() with the seed of the run.
struct GeneratedSettings {
    GeneratedPath path{};
    Angle heading{};
    std::shared_ptr<const LocalShape> shape{};  ///< null until it has been planned
};
using TrajectorySettings =
    std::variant<FixedSettings, WaypointSettings, CircleSettings, FileSettings, LiveSettings, GeneratedSettings>;

/// How the fix is made, and the numbers of all ways.
struct ModelSettings {
    std::optional<ErrorModelKind> sensor_model;  ///< nothing: modern, which measures and solves
    ModernSettings modern = ModernSettings::of(ModernPreset::consumer);
    BaselineParameters baseline;
    LinkBudgetParameters link;
    ConstantSigmaParameters constant_sigma;
    SatelliteCountParameters satellite_count;
    WholePathParameters whole_path;
    RefractionParameters refraction;
};

/// "modern" and the names of the sensor models, in the order in which people list them.
std::span<const std::string_view> model_names();
/// One of them.
std::string_view model_name(const ModelSettings& settings);
/// Makes it the model of that name. False for an unknown name, which changes nothing.
bool choose_model(ModelSettings& settings, std::string_view name);

struct ReceiverEntry;
struct Scenario;

/// A key of a receiver that is there, and of what of it nothing comes at a board.
struct KeyJudge {
    std::string told_at{};  ///< "FILE:LINE:COLUMN: KEY: "
    /// Phrases behind the board's name, a value each: "never sends THS".
    std::vector<std::string> (*idle)(const UsedReceiver&, const ReceiverEntry&, const Scenario&) = nullptr;
};

/// One emulated receiver and its wires.
struct ReceiverEntry {
    std::string name;                   ///< empty: receiver0, receiver1, …
    std::string board = "ublox-m8";     ///< for find_board(): a name, or the path of a file
    std::vector<std::string> ports;     ///< URIs, after the name of a port and "=" or alone; empty: one pty
    std::string corrections;            ///< URI of a caster's mount point, after a port and "=" or alone; empty: none
    int corrections_position_s = 10;    ///< the caster is told the position, every so many s; 0: never
    std::string power;                  ///< URI of the actuator that power_cut switches; empty: none
    std::optional<double> rate_hz;      ///< nothing: the board's
    std::optional<std::uint32_t> baud;  ///< nothing: the board's
    std::vector<firmware::NmeaSentence> sentences;  ///< empty: the board's
    std::vector<Constellation> constellations;      ///< that it tracks; empty: the board's
    bool dual_frequency = false;                    ///< tracks the second signal of each system too
    StartKind start = StartKind::hot;
    DynamicModel dynamic_model = DynamicModel::portable;
    std::optional<firmware::ExportLimits> export_limits;  ///< nothing: the board's
    std::optional<Seconds> latency;                       ///< from the epoch to its output; nothing: the board's
    MetresPerSecond static_hold_below{0};
    bool power_up = false;  ///< it is switched on at the start of the run: banner, then `start`
    std::map<std::uint32_t, std::uint64_t> config{};  ///< raw values by the ids of items that its user has saved in it
    std::filesystem::path state_file;                 ///< keeps battery-backed memory and flash; empty: nothing does
    std::string antenna_type;  ///< and radome, as catalogues name them; empty: measured at its phase centre
    std::array<double, 3> antenna_offset{};  ///< forward, right, down from the point that follows the trajectory, m
    std::optional<TrajectorySettings> trajectory{};  ///< of the vehicle it rides on; nothing: the scenario's
    std::optional<std::size_t> base;  ///< the receiver, by its place in the list, that carries the base antenna
    std::optional<std::size_t> corrections_from{};  ///< the receiver whose RTCM output this one takes in
    ToldPlaces told_at{};                           ///< of the keys that a board or a machine may refuse
    std::vector<KeyJudge> judges{};                 ///< of the keys of which at some boards nothing comes
};

/// A fault and when it works.
struct FaultEntry {
    TimelineEntry when;
    std::string kind;  ///< of fault_kinds()
    Parameters parameters;
    std::vector<std::size_t> receivers;  ///< by their places in the list, ascending; all of them unless told otherwise
    bool allow_idle = false;             ///< a judged run goes on where nothing can come of it
    std::string told_at{};               ///< "FILE:LINE:COLUMN: ", for messages; empty: in no file
};

/// A command and when it is carried out.
struct CommandEntry {
    TimelineEntry when;
    Command command;
    std::string told_at{};  ///< as that of a fault
};

/// A mount point of the run's caster: RTCM of a port of a receiver, or of virtual reference stations.
struct CasterMount {
    std::string name;
    std::size_t receiver = 0;      ///< by its place in the list
    std::string port;              ///< the name of one of its board's; empty: the one that a wire without a name has
    std::string told_at{};         ///< "FILE:LINE:COLUMN: KEY: ", for messages
    bool virtual_station = false;  ///< each client has one of its own, beside the place that it tells
    int msm = 7;                   ///< kind of its observations, 4 … 7
};

/// [caster]
struct CasterSettings {
    std::string listen;                          ///< "[HOST:]PORT"; empty: there is no caster
    std::map<std::string, std::string> users{};  ///< passwords by names; empty: everybody is served
    std::vector<CasterMount> mounts{};           ///< empty: one for each receiver that can send RTCM
    std::optional<CasterMount> virtual_mount{};  ///< one more, with virtual stations
    std::string told_at = "--caster: ";          ///< of `listen`, as CasterMount::told_at
};

struct Scenario {
    std::string name = "embedded defaults";
    std::string source;  ///< the text it was read from and the options laid over it, for a digest
    RunSettings run;
    SkySettings sky;
    TrajectorySettings trajectory = FixedSettings{};
    std::filesystem::path trajectory_file{};  ///< TOML that an option took it from; empty: none
    ModelSettings model;
    AtmosphereParameters atmosphere;
    std::filesystem::path tec_maps{};  ///< IONEX file of the atmosphere's electron content; empty: none
    SceneEntry scene;
    std::vector<std::string> atmosphere_keys;                              ///< those of [atmosphere] that were given
    std::vector<ReceiverEntry> receivers = std::vector<ReceiverEntry>(1);  ///< at least one
    std::vector<OutputSettings> outputs;                                   ///< what is told beside the receivers' wires
    CasterSettings caster;                                                 ///< who else hears the receivers' RTCM
    std::vector<FaultEntry> faults;
    std::vector<CommandEntry> commands;
    std::vector<Expectation> expectations;       ///< what the run is judged by
    std::optional<CampaignSettings> campaign{};  ///< many runs of it; one run passes over them
    std::vector<std::string> warnings;  ///< what a reader should be told, e.g. a level that is too large for a plane
    ToldPlaces told_at{};  ///< of keys that are judged after reading: run.speed, sky.navigation, scene.buildings, …
};

/// The timeline of a scenario: its faults, then its commands.
std::vector<TimelineEntry> timeline_of(const Scenario& scenario);

/// The path of the vehicle that a receiver rides on: its own, or the scenario's.
const TrajectorySettings& trajectory_of(const Scenario& scenario, std::size_t index);

/// What a sentence about a key of the scenario begins with: its place, or where no file has it `otherwise` and ": ".
std::string told_place(const Scenario& scenario, std::string_view key, std::string_view otherwise);

/// What messages call a receiver: its name, or receiver0 and so on by its place in the list.
std::string receiver_name(const Scenario& scenario, std::size_t index);
/// The same of all of them.
std::vector<std::string> receiver_names(const Scenario& scenario);

}  // namespace skyloop::inline run
