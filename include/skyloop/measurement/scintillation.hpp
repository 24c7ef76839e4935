/// What a scintillating ionosphere does to the loops that track a signal.
#pragma once

#include "skyloop/measurement/tracking_jitter.hpp"

namespace skyloop {

/// Amplitude scintillation index S4 from which the formulas below, and tracking with them, break down.
inline constexpr double strongest_scintillation = 0.707;

/// Parameter m = 1/S4² of the Nakagami distribution of the amplitude. @param s4 above 0
double nakagami_m(double s4);

/// Standard deviation of the code phase, chips (Conker, El-Arini, Hegarty and Hsiao 2003; MODELS.md 7.11).
/// @param s4 0 … 0.707 (exclusive)
double scintillating_code_jitter_chips(const CodeLoop& loop, CarrierToNoise cn0, double s4);

/// Standard deviation of the carrier phase by thermal noise; the scintillation of the phase itself comes on top (Conker
/// et al. 2003; MODELS.md 7.11).
Angle scintillating_phase_jitter(const CarrierLoop& loop, CarrierToNoise cn0, double s4);

}  // namespace skyloop
