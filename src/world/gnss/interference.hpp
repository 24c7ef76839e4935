/// What a jammer leaves of a signal.
#pragma once

#include "base/core/units.hpp"

namespace skyloop {

/// A jammer's spectrum against that of the signal: how well a correlator rejects it (MODELS.md 7.7, Q).
enum class JammerKind {
    narrow_band,  ///< Q 1
    matched,      ///< Q 1.5: the spectrum of the signal
    wide_band,    ///< Q 2.2
};
/// Its Q.
double rejection_quality(JammerKind kind);

/// Power of a signal in an isotropic antenna that J/S refers to (MODELS.md 7.7).
inline constexpr DecibelWatts nominal_signal_power{-157};

/// How well a correlator rejects an interference (Kaplan and Hegarty, table of Q).
struct InterferenceRejection {
    double quality = 1.5;  ///< Q, rejection_quality()
    Hertz chip_rate{1.023e6};
};

/// Effective C/N0 under an interference J/S stronger than the signal:
/// −10 log10(10^(−C/N0/10) + 10^(J/S/10)/(Q R_c)) (Kaplan and Hegarty, Understanding GPS, chapter on interference;
/// MODELS.md 7.7).
DbHz cn0_under_interference(DbHz cn0, Decibels jammer_to_signal, const InterferenceRejection& rejection = {});

}  // namespace skyloop
