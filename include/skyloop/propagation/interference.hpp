/// What a jammer leaves of a signal.
#pragma once

#include "skyloop/base/units.hpp"

namespace skyloop {

/// How well a correlator rejects an interference (Kaplan and Hegarty, table of Q).
struct InterferenceRejection {
    double quality = 1.5;  ///< Q: 1 narrow-band, 1.5 matched to the signal's spectrum, 2.2 wide-band
    Hertz chip_rate{1.023e6};
};

/// Effective C/N0 under an interference J/S stronger than the signal:
/// −10 log10(10^(−C/N0/10) + 10^(J/S/10)/(Q R_c)) (Kaplan and Hegarty, Understanding GPS, chapter on interference;
/// MODELS.md 7.7).
DbHz cn0_under_interference(DbHz cn0, Decibels jammer_to_signal, const InterferenceRejection& rejection = {});

}  // namespace skyloop
