/// What a receiver, or the autopilot behind it, has written down: epochs of one form, whatever the log was.
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

namespace skyloop {

/// A satellite that the receiver tracked.
struct LoggedSatellite {
    SatelliteId id;
    double cn0_dbhz = 0;  ///< of its strongest signal
    std::optional<int> elevation_deg{};
};

/// What some logs tell of the motion beside, or instead of, a whole place and velocity. NMEA tells it so.
struct LogMotion {
    std::optional<Angle> latitude{}, longitude{};  ///< whatever the type of the fix, with or without a height
    std::optional<Metres> altitude{};              ///< above mean sea level
    std::optional<Metres> separation{};            ///< of the geoid above the ellipsoid, as the log says
    std::optional<MetresPerSecond> ground_speed{}, climb{};
    std::optional<Angle> course{};  ///< from true north
    std::optional<Angle> heading{}, roll{}, pitch{};
};

/// One epoch of a log.
struct LogEpoch {
    GpsTime time;
    FixType type = FixType::none;
    std::optional<Geodetic> place{};
    std::optional<VelocityNed> velocity{};
    std::optional<Attitude> attitude{};  ///< as receivers with inertial sensors tell it
    std::optional<int> satellites_used{};
    std::optional<Metres> horizontal_accuracy{}, vertical_accuracy{};  ///< as the receiver estimates them
    bool lists_satellites = false;              ///< the log says of this epoch which satellites were tracked
    std::vector<LoggedSatellite> satellites{};  ///< ascending
    LogMotion motion{};

    /// Neither of the signals now: none, the time alone, or reckoned on without them.
    [[nodiscard]] bool is_lost() const {
        return type == FixType::none || type == FixType::time_only || type == FixType::dead_reckoning;
    }
};

/// A log as it was read. Epochs are ascending in time, each time once, but as they stand in the file for a track.
struct ReceiverLog {
    std::string name;      ///< of the file
    std::string format;    ///< "UBX", "NMEA", "ULog" or "DataFlash"
    std::string receiver;  ///< what the log says of the receiver; may be empty
    std::string board;     ///< the profile that this suggests; empty: none
    std::vector<LogEpoch> epochs;
    bool dated = true;               ///< false: no date in it, and the first epoch is of the day, or week, 1980-01-06
    std::vector<std::string> notes;  ///< what was left out and why, a sentence each
};

/// How a log is read.
struct LogReading {
    const Geoid* geoid = nullptr;  ///< for heights above sea level where the log does not tell the undulation
    std::size_t receiver = 0;      ///< of several in one log, from 0
    /// The way alone is wanted: NMEA without a date and UBX without a week are read too, no note tells of heights, and
    /// UBX and NMEA epochs are not put in order, which clean_track() does.
    bool for_track = false;
};

/// Reads a log of any of the four kinds, told by its content. Fails with `input` and one sentence that begins with the
/// name: when it is none of them, when nothing in it has a time, or when the asked receiver is not in it.
Result<ReceiverLog> read_receiver_log(ByteSpan bytes, const std::string& name, const LogReading& reading);

}  // namespace skyloop
