/// What a scintillating ionosphere does to the loops that track a signal.
#pragma once

#include "receiver/measurement/tracking_jitter.hpp"

namespace skyloop {

/// Amplitude scintillation index S4 from which the formulas below, and tracking with them, break down.
inline constexpr double strongest_scintillation = 0.707;

/// Parameter m = 1/S4² of the Nakagami distribution of the amplitude. @param s4 above 0
double nakagami_m(double s4);

/// Power of a signal over its mean, of which a strong part arrives as it is and the rest scattered: Rice's distribution
/// with the moments that Nakagami's has for this S4, K = √(m² − m)/(m − √(m² − m)) (MODELS.md 7.11; Rice 1948).
/// @param s4 0 … 1; above as at 1 @param in_phase of the scattered part, as quadrature of a normal distribution of unit
/// deviation
double scintillating_power(double s4, double in_phase, double quadrature);

/// Standard deviation of the code phase, chips (Conker, El-Arini, Hegarty and Hsiao 2003; MODELS.md 7.11).
/// @param s4 0 … 0.707 (exclusive)
double scintillating_code_jitter_chips(const CodeLoop& loop, CarrierToNoise cn0, double s4);

/// Standard deviation of the carrier phase by thermal noise; the scintillation of the phase itself comes on top (Conker
/// et al. 2003; MODELS.md 7.11).
Angle scintillating_phase_jitter(const CarrierLoop& loop, CarrierToNoise cn0, double s4);

}  // namespace skyloop
