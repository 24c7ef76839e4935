/// One run, as plain data: what a scenario file and the command line say.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "firmware/board_profile.hpp"
#include "skyloop/error_model/model_kind.hpp"
#include "skyloop/error_model/parameters.hpp"
#include "skyloop/geo/level_frame.hpp"
#include "skyloop/gnss/navigation_source.hpp"
#include "skyloop/propagation/atmosphere_parameters.hpp"
#include "skyloop/propagation/link_budget_parameters.hpp"
#include "skyloop/propagation/whole_path_parameters.hpp"
#include "skyloop/trajectory/geometric_paths.hpp"

namespace skyloop {

struct RunSettings {
    std::optional<GpsTime> start;  ///< nothing: now, or the first epoch of the navigation data
    bool start_now = false;
    std::optional<Seconds> duration;  ///< nothing: until stopped
    std::uint64_t seed = 1;
    double speed = 1;  ///< simulated seconds per second
};

struct SkySettings {
    std::vector<std::filesystem::path> navigation;  ///< empty: the nominal constellation
    bool rebase_navigation = false;                 ///< move the data to the start time, keeping its time of day
    std::vector<Constellation> constellations;      ///< empty: all in the data
    Angle elevation_mask = Angle::degrees(5);
    std::optional<EphemerisRule> ephemeris_rule;  ///< nothing: the model's own rule
    Seconds ephemeris_validity{7200};
};

/// Paths are kept as what was asked for; they become a Trajectory when the start time is known.
struct FixedSettings {
    Geodetic at = Geodetic::degrees(46.4774, 30.7326, 77);
};
struct WaypointSettings {
    std::vector<Waypoint> corners;
};
struct CircleSettings {
    Circle::Shape shape;
};
using TrajectorySettings = std::variant<FixedSettings, WaypointSettings, CircleSettings>;

/// Which sensor model makes the fix, and the numbers of all of them.
struct ModelSettings {
    ErrorModelKind kind = ErrorModelKind::baseline;
    BaselineParameters baseline;
    LinkBudgetParameters link;
    ConstantSigmaParameters constant_sigma;
    SatelliteCountParameters satellite_count;
    WholePathParameters whole_path;
    RefractionParameters refraction;
};

/// One emulated receiver and its wires.
struct ReceiverEntry {
    std::string board = "ublox-m8";
    std::vector<std::string> ports;                 ///< URIs; empty: one pty
    std::optional<double> rate_hz;                  ///< nothing: the board's
    std::optional<std::uint32_t> baud;              ///< nothing: the board's
    std::vector<firmware::NmeaSentence> sentences;  ///< empty: the board's
};

struct Scenario {
    std::string name = "embedded defaults";
    std::string source;  ///< the text it was read from and the options laid over it, for a digest
    RunSettings run;
    SkySettings sky;
    TrajectorySettings trajectory = FixedSettings{};
    ModelSettings model;
    AtmosphereParameters atmosphere;
    ReceiverEntry receiver;
    std::vector<std::string> warnings;  ///< what a reader should be told, e.g. a level that is too large for a plane
};

}  // namespace skyloop
