/// What a receiver, or the autopilot behind it, has said: epochs of one form, whatever the protocol or the file was.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "base/core/bytes.hpp"
#include "base/core/result.hpp"
#include "base/geo/attitude.hpp"
#include "base/geo/geoid.hpp"
#include "world/flow/fix.hpp"

namespace skyloop::inline receiver {

/// A signal that the receiver tracked.
struct ObservedSignal {
    SatelliteId id;
    double cn0_dbhz = 0;
    std::optional<int> elevation_deg{};  ///< of the satellite
    int number = 0;  ///< of the signal, as GSV counts them; 0: not told, or the strongest of the satellite
};

/// What is told of the motion beside, or instead of, a whole place and velocity. NMEA tells it so.
struct ObservedMotion {
    std::optional<Angle> latitude{}, longitude{};  ///< whatever the type of the fix, with or without a height
    std::optional<Metres> altitude{};              ///< above mean sea level
    std::optional<Metres> separation{};            ///< of the geoid above the ellipsoid, as the receiver says
    std::optional<MetresPerSecond> ground_speed{}, climb{};
    std::optional<Angle> course{};  ///< from true north
    std::optional<Angle> heading{}, roll{}, pitch{};
};

/// One epoch.
struct ObservedEpoch {
    GpsTime time;
    bool timed = true;         ///< false: the receiver told no time
    bool dated = true;         ///< false: it told none of the week or day, which is counted from the beginning
    std::size_t line = 0;      ///< of a file of text that has one for each; 0: it has not
    bool is_solution = false;  ///< a message of a solution came, whatever it said
    FixType type = FixType::none;
    std::optional<bool> claims_fix{};  ///< by RMC, beside what GGA or GNS says
    std::optional<int> quality{};      ///< of the fix, as GGA numbers it
    std::optional<Geodetic> place{};
    std::optional<VelocityNed> velocity{};
    std::optional<Attitude> attitude{};  ///< as receivers with inertial sensors tell it
    std::optional<int> satellites_used{};
    std::optional<Metres> horizontal_accuracy{}, vertical_accuracy{};  ///< as the receiver estimates them
    std::optional<MetresPerSecond> speed_accuracy{};
    std::optional<double> hdop{};
    std::optional<double> utc_s{};          ///< since 1970, without leap seconds, where the receiver knows them
    bool lists_satellites = false;          ///< it is told which satellites were tracked
    std::vector<ObservedSignal> signals{};  ///< by satellite and number
    ObservedMotion motion{};

    /// Neither of the signals now: none, the time alone, or reckoned on without them.
    [[nodiscard]] bool is_lost() const {
        return type == FixType::none || type == FixType::time_only || type == FixType::dead_reckoning;
    }
};

/// A file as it was read.
struct ObservedLog {
    std::string name;      ///< of the file
    std::string format;    ///< "UBX", "NMEA", "SBF", "ULog", "DataFlash" or "RTKLIB solution"
    std::string receiver;  ///< what the file says of the receiver; may be empty
    std::string board;     ///< the profile that this suggests; empty: none
    std::vector<ObservedEpoch> epochs;
    bool dated = true;               ///< false: no date in it, and the first epoch is of the day, or week, 1980-01-06
    std::vector<std::string> notes;  ///< what was left out or assumed and why, a sentence each
};

/// What epochs are wanted for.
enum class ObservedUse {
    events,  ///< ascending in time, each time once, all of them dated
    track,   ///< as they stand in the file, dated or not; no note tells of heights
    fixes,   ///< the same, those without a place or time among them: each that has a solution, or says that it has none
};

/// How a file is read.
struct ObservedReading {
    const Geoid* geoid = nullptr;  ///< for heights above sea level where the file does not tell the undulation
    std::size_t receiver = 0;      ///< of several in one log, from 0
    ObservedUse use = ObservedUse::events;
};

/// Whether a whole message of UBX or SBF with a place is in it.
bool holds_messages(ByteSpan bytes);
/// Whether a whole sentence of those that are read is a line, or the end of one, in the first 64 KiB.
bool holds_sentences(ByteSpan bytes);
/// Whether it begins as solutions of RTKLIB do: with comments of which one names the columns, or with such a row.
bool is_rtklib_solution(ByteSpan bytes);

/// Whether it is one of these, or the beginning of a ULog or DataFlash file.
bool is_observed(ByteSpan bytes);

/// Reads receivers' output of any kind, told by its content. Fails with `input` and one sentence that begins with the
/// name: when it is of no kind, when nothing in it has a time, or when the asked receiver is not in it.
Result<ObservedLog> read_observed(ByteSpan bytes, const std::string& name, const ObservedReading& reading);

}  // namespace skyloop::inline receiver
