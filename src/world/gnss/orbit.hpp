/// Where a satellite is, how it moves, and what its clock shows.
/// The Earth's rotation while a signal travels.
/// Orbits of almanacs at another reference time.
/// GLONASS records brought near the present, so that a look at a satellite integrates seconds and not minutes.
#pragma once

#include <Eigen/Core>

#include <map>

#include "base/geo/frames.hpp"
#include "world/gnss/constants.hpp"
#include "world/gnss/ephemeris.hpp"

namespace skyloop::inline world {

/// Rz(ω_e τ): a vector in the ECEF frame of τ seconds ago as today's frame has it (MODELS.md 3.4). The series are exact
/// to double precision for |τ| < 1 s.
inline Eigen::Vector3d turned_by(const Eigen::Vector3d& v, double travel_time_s) {
    const double angle = earth_rotation_rate * travel_time_s;
    const double s = angle * (1 - angle * angle / 6);
    const double c = 1 - angle * angle / 2;
    return {v.x() * c + v.y() * s, -v.x() * s + v.y() * c, v.z()};
}

/// State of a satellite at one instant, in the ECEF frame of that same instant.
struct SatelliteState {
    Position<Ecef> position;
    Velocity<Ecef> velocity;
    double clock_bias = 0;         ///< satellite clock − GPST, s, relativity included, group delay not
    double clock_drift = 0;        ///< s/s, relativity included
    double relativistic_bias = 0;  ///< the eccentricity term alone, s; 0 where the broadcast clock holds it
};

/// Orbit and clock by the user algorithm of IS-GPS-200 (20.3.3.4.3.1 and 20.3.3.3.3.1) with the constants of the
/// record's system, velocity by its derivative (Remondi 2004). Geostationary BeiDou satellites by the B1I ICD 3.0,
/// table 5-11. Rates of axis and mean motion as those of modern messages (IS-GPS-200N, table 30-II).
/// @param offset added to `time`, s, for transmission times finer than a nanosecond
SatelliteState satellite_state(const KeplerEphemeris& ephemeris, GpsTime time, Seconds offset = Seconds(0));

/// The simplified equations of motion of the ICD L1, L2 GLONASS 5.1, A.3.1.2, by the classical Runge-Kutta method in
/// steps of at most 60 s; good within half an hour of toe. The clock is linear.
SatelliteState satellite_state(const GlonassEphemeris& ephemeris, GpsTime time, Seconds offset = Seconds(0));

/// A parabola in time (DO-229, A.4.4.11).
SatelliteState satellite_state(const SbasEphemeris& ephemeris, GpsTime time, Seconds offset = Seconds(0));

/// The same for a record of any system.
SatelliteState satellite_state(const Ephemeris& ephemeris, GpsTime time, Seconds offset = Seconds(0));

/// The same orbit and clock with `time` as its reference time where that makes near instants cheap: GLONASS records are
/// integrated once. Others come back as they are.
Ephemeris carried_to(const Ephemeris& ephemeris, GpsTime time);

/// The same orbit and clock, told from another time of reference on: `toe` and `toc` become `time`, and what changes
/// with them is carried along (IS-GPS-200, 20.3.3.4.3.1). Of GPS and QZSS, without harmonic and quadratic terms.
KeplerEphemeris carried_almanac(const KeplerEphemeris& record, GpsTime time);

/// How far apart the reference times of ephemeris_of_almanac() are.
inline constexpr std::chrono::hours ephemeris_spacing{2};
/// An almanac of GPS or QZSS as the ephemeris that the satellite would send at that time: the reference time is the
/// nearest whole multiple of ephemeris_spacing, each with an issue of its own, and the accuracy a usual one.
KeplerEphemeris ephemeris_of_almanac(const KeplerEphemeris& almanac, GpsTime time);

/// Gives for each GLONASS record the same orbit at the last whole minute from its toe towards an instant. Whole minutes
/// are the steps of the integration itself, so that carrying changes no bit of it.
///
/// State: the last result for each satellite. It hangs on record and minute alone: no answer depends on what was asked
/// before.
class CarriedRecords {
public:
    const GlonassEphemeris& at(const GlonassEphemeris& record, GpsTime time);

private:
    struct Carried {
        GlonassEphemeris origin;
        GlonassEphemeris record;
    };
    std::map<SatelliteId, Carried> carried_;
};

}  // namespace skyloop::inline world
