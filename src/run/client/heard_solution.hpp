/// What a scripted client has understood of one epoch, whatever protocol told it.
#pragma once

#include <array>
#include <optional>

#include "base/time/gps_time.hpp"
#include "receiver/observed/observed_log.hpp"

namespace skyloop {

/// A solution as a client hears it. Angles are in degrees, as on the wire.
struct HeardSolution {
    GpsTime heard{};         ///< by the client's own clock
    bool valid = false;      ///< the receiver says that this is a fix
    bool has_place = false;  ///< a latitude and a longitude were told
    bool three_dimensional = false;
    int satellites = 0;              ///< used
    double latitude_deg = 0;         ///< north positive
    double longitude_deg = 0;        ///< east positive
    std::optional<double> height_m;  ///< above whatever surface the protocol uses
    std::optional<double> horizontal_accuracy_m, vertical_accuracy_m, speed_accuracy_mps;  ///< 1 σ, as told
    std::optional<double> hdop;
    std::optional<std::array<double, 3>> velocity_mps{};  ///< north, east, down; down is 0 where it is not told
    bool has_vertical_velocity = false;
    std::optional<double> seconds;  ///< of the GPS week (UBX), or of the UTC day (NMEA)
    double seconds_wrap = 604800;   ///< at which `seconds` begins anew
    std::optional<double> utc_s;    ///< since 1970, without leap seconds, where date and time are told as known
    std::optional<double> gps_s;    ///< since the GPS epoch, from week and time of week, where both are told as known
    bool counts_gps_weeks = false;  ///< `seconds` are of the GPS week
};

/// What an epoch tells, without its times of day and of the receiver's GPS week. A place at 0°, 0° is one.
HeardSolution heard_solution(const ObservedEpoch& epoch, GpsTime heard);

/// `a − b` on a circle of `wrap`, from −wrap/2 to wrap/2.
double wrapped_difference(double a, double b, double wrap);

}  // namespace skyloop
