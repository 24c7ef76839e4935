/// A signal's way from a moving transmitter to a moving receiver on the turning Earth.
#pragma once

#include "base/core/units.hpp"
#include "base/geo/frames.hpp"

namespace skyloop {

/// A point and how it moves in the Earth-fixed frame.
struct EcefMotion {
    Position<Ecef> position;
    Velocity<Ecef> velocity;
};

/// A point in the ECEF frame of the transmission instant, in that of the reception instant `travel_time` later:
/// Rz(ω_e τ), MODELS.md 3.4.
Position<Ecef> in_reception_frame(const Position<Ecef>& at_transmission, Seconds travel_time);

/// The derivative, by the travel time τ, of the range |Rz(ω_e τ) r_s(t − τ) − r_r(t)|.
/// @param transmitter at t − τ, in the frame of that instant
/// @param receiver at t
MetresPerSecond light_time_slope(const EcefMotion& transmitter, const Position<Ecef>& receiver, Seconds travel_time);

/// The derivative, by reception time, of the light-time range ρ = |Rz(ω_e τ) r_s(t − τ) − r_r(t)| with τ = ρ/c.
/// @param transmitter at transmission, in the frame of that instant
/// @param receiver at reception
MetresPerSecond light_time_range_rate(const EcefMotion& transmitter, const EcefMotion& receiver, Seconds travel_time);

}  // namespace skyloop
