/// RINEX observation files as they are read.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/core/result.hpp"
#include "base/geo/frames.hpp"
#include "world/flow/observations.hpp"

namespace skyloop::inline world {

/// How much of an observation file was passed over, by reason.
struct SkippedObservations {
    int epochs = 0;      ///< their first line cannot be read
    int unordered = 0;   ///< epochs not later than the one before
    int incomplete = 0;  ///< epochs with fewer satellites than they announce; what is there is kept
    int satellites = 0;  ///< records of satellites that are unknown, repeated, or of a system without declared types
    int fields = 0;      ///< single observations that are no number or lie outside what a receiver can measure
    bool operator==(const SkippedObservations&) const = default;
};

/// Of the antenna reference point against the marker.
struct AntennaDelta {
    Metres height, east, north;
};

/// What an observation file holds.
struct ObservationFile {
    double version = 0;
    std::string marker, receiver, antenna;
    std::optional<Position<Ecef>> approximate_position;  ///< of the marker; nothing when blank or 0
    AntennaDelta antenna_delta;
    std::optional<Seconds> interval;
    std::optional<int> leap_seconds;      ///< GPST − UTC, s
    std::map<int, int> glonass_channels;  ///< frequency channel by slot, where the file tells
    std::string time_system = "GPS";      ///< in which the file writes its epochs; here they are GPST
    /// Those with flag 0 or 1. lock_time counts from the first epoch in which the phase is seen, or from a slip.
    std::vector<Observations> epochs;
    int events = 0;  ///< epochs with flags 2 to 5
    SkippedObservations skipped;
    std::vector<std::string> warnings;  ///< one line for each kind of thing passed over, naming file and first line
};

/// Reads the text of a RINEX 2.00–2.12, 3.00–3.05 or 4.00–4.02 observation file of any system.
///
/// Of each system the emulated signals are kept (emulated_signals()). Of several codes of a signal, each epoch takes
/// the first with a pseudorange in the order C, P, W, … of L1, L, X, S, W, … of L2, pilot before data of others; of
/// version 2, C1 before P1 and P2 before C2. Phases that change their code are marked as slipped, as are those after a
/// power failure (flag 1) or a cycle slip record (flag 6). A value that is blank or 0 is not measured (RINEX 3.05,
/// 6.7). C/N0 is the observation S where there is one, else the middle of the strength digit's step, else 0. The
/// carrier of a GLONASS satellite without a declared channel is that of channel 0.
/// Texts in Hatanaka's compact form (.crx, .YYd; versions 1.0 and 3.0) are restored first; messages about what was
/// restored count its lines. Fails with `input` when the text is of another kind or version, or compact and damaged or
/// cut, when the header declares no observation types, or when no epoch can be read.
/// @param name of the file, for messages
Result<ObservationFile> read_observations(std::string_view text, std::string_view name);

/// The same for a file, packed or not. Fails as read_text_file and read_observations do.
Result<ObservationFile> read_observation_file(const std::filesystem::path& path);

}  // namespace skyloop::inline world
