/// What echoes do to the loops that track a signal.
/// Where a code loop settles when echoes reach it beside the direct signal.
#pragma once

#include <span>

#include "base/core/units.hpp"
#include "receiver/measurement/tracking_jitter.hpp"
#include "world/flow/arrivals.hpp"

namespace skyloop::inline receiver {

/// An echo, against the direct signal.
struct SignalEcho {
    double amplitude = 0;    ///< relative, not negative
    double delay_chips = 0;  ///< later than the direct signal; below 0: earlier, where that is blocked
    Angle phase;             ///< of its carrier against that of the direct signal
};

/// The error of the code phase, chips, positive when ranges come out too long: the root nearest to zero of the coherent
/// early-minus-late discriminator on an ideal triangle of correlation (MODELS.md 7.10).
/// @param spacing_chips d, early to late, above 0
double multipath_code_error_chips(std::span<const SignalEcho> echoes, double spacing_chips);

/// The correlators that hear them.
struct EchoedSignal {
    CodeLoop code_loop;  ///< of this signal
    CarrierLoop phase_loop;
    Hertz carrier;
    bool boc = false;  ///< BOC(1,1)
};

/// All of it against the tracked ray alone.
struct CorrelatorMultipath {
    Metres code;        ///< positive when ranges come out too long
    Metres phase;       ///< of the carrier, the same sign; within half a wavelength
    Decibels strength;  ///< what the echoes add to C/N0 or take from it
    double distortion =
        0;  ///< (early − late)/(2 prompt) half a chip (BOC: a quarter) either side, in phase with the prompt correlator
};

/// From the composite correlation (MODELS.md 7.10): the code settles where the coherent early-minus-late discriminator
/// is zero; phase and strength are those of the phasor sum at that code phase.
///
/// An echo whose excess changes beats against the tracked ray with excess rate ∕ wavelength; each loop follows the beat
/// as a first-order low-pass of its noise bandwidth, 1 ∕ √(1 + (π f ∕ 2B)²), strength as the code does. Of very many
/// echoes the twelve strongest count, and those too late to be heard do not.
CorrelatorMultipath correlator_multipath(std::span<const Echo> echoes, const EchoedSignal& signal);

}  // namespace skyloop::inline receiver
