/// What the receiver believes.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "base/geo/geodetic.hpp"
#include "base/time/gps_time.hpp"
#include "world/flow/error_correlation.hpp"
#include "world/gnss/dop.hpp"
#include "world/gnss/satellite.hpp"

namespace skyloop {

/// Kinds of solution, as fixes.csv names them.
enum class FixType { none, dead_reckoning, fix_2d, fix_3d, dgnss, rtk_float, rtk_fixed, time_only };

/// "none", "2d", "3d", … as in fixes.csv.
constexpr std::string_view fix_type_name(FixType type) {
    switch (type) {
        case FixType::none:
            return "none";
        case FixType::dead_reckoning:
            return "dead_reckoning";
        case FixType::fix_2d:
            return "2d";
        case FixType::fix_3d:
            return "3d";
        case FixType::dgnss:
            return "dgnss";
        case FixType::rtk_float:
            return "rtk_float";
        case FixType::rtk_fixed:
            return "rtk_fixed";
        case FixType::time_only:
            return "time_only";
    }
    return "none";
}

/// Velocity over ground, metres per second.
struct VelocityNed {
    double north = 0, east = 0, down = 0;
};

/// One satellite as the receiver reports it.
struct SatelliteStatus {
    SatelliteId id;
    Angle azimuth;
    Angle elevation;
    std::optional<DbHz> cn0;  ///< nothing: in view, not tracked
    bool used = false;
    bool has_ephemeris = true;         ///< the receiver has a record of its orbit
    bool healthy = true;               ///< by that record, and by what it sends now
    std::optional<Metres> residual{};  ///< of the pseudorange after the solution
};

/// A position, velocity and time solution. Without a fix only `time`, `leap_seconds` and `satellites` mean something.
struct Fix {
    GpsTime time;
    FixType type = FixType::none;
    int leap_seconds = 18;  ///< GPST − UTC that the receiver believes, s
    Geodetic position;
    Metres geoid_undulation;  ///< of the receiver's own geoid at `position`
    VelocityNed velocity;
    MetresPerSecond speed;  ///< over ground
    Angle course;           ///< 0 … 360°
    Dop dop;
    Metres horizontal_accuracy;  ///< 1 σ estimate, horizontal
    Metres vertical_accuracy;
    MetresPerSecond speed_accuracy;                 ///< 1 σ estimate
    Angle course_accuracy;                          ///< 1 σ estimate
    Metres time_accuracy;                           ///< 1 σ estimate, times the speed of light
    std::optional<ErrorCorrelation> correlation{};  ///< of the errors that the accuracies are of; nothing: not known
    Metres clock_bias;                              ///< receiver clock − GPST as solved
    MetresPerSecond clock_drift;                    ///< of it
    std::vector<SatelliteStatus> satellites;        ///< all that the receiver knows of, ascending
    bool withheld = false;  ///< no fix, as what was solved lies beyond the dynamic model's limits

    [[nodiscard]] bool has_position() const { return type != FixType::none && type != FixType::time_only; }
    [[nodiscard]] int satellites_used() const {
        int count = 0;
        for (const SatelliteStatus& s : satellites)
            count += s.used ? 1 : 0;
        return count;
    }
};

}  // namespace skyloop
