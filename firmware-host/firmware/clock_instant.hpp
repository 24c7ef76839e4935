/// The instants of a receiver's own clock.
#pragma once

#include "firmware/navigation_state.hpp"

namespace skyloop::firmware {

/// How far the receiver's clock is ahead of GPS time, whole milliseconds aside, as NAV-CLOCK's clkB: ±0.5 ms. Nothing
/// before it has been solved.
Nanoseconds clock_ahead(const NavigationState& state);

/// Carries the position, which was solved for a whole millisecond of GPS time, to the one of the receiver's clock, for
/// which it is reported.
void carry_to_clock_instant(NavigationState& state);

/// Carries what was measured `past` a whole millisecond of the receiver's clock back to that, by the Doppler: ranges by
/// centimetres, to better than a millimetre. Receivers measure at whole milliseconds of their clocks (rcvTow of 4568
/// epochs of ZED-F9T, M8P and M8T).
Observation carried(const Observation& measured, Seconds past);

/// Where one comes from there with that velocity.
Geodetic carried(const Geodetic& from, const VelocityNed& velocity, Seconds time);

}  // namespace skyloop::firmware
