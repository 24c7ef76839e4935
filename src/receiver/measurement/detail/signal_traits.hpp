/// How a signal is modulated, as far as tracking it is concerned.
#pragma once

#include <string>
#include <string_view>

#include "receiver/measurement/tracking_jitter.hpp"
#include "world/gnss/satellite.hpp"
#include "world/gnss/signal.hpp"

namespace skyloop {

/// What sets a signal's tracking apart from that of GPS L1 C/A.
struct SignalTraits {
    double chip_rate_ratio = 1;  ///< to 1.023 Mchip/s
    double jitter_ratio = 1;     ///< of the code's noise to that of BPSK at the same chip rate
    bool boc = false;            ///< BOC(1,1): the peak of correlation is three times as steep, with side peaks
    bool pilot = false;          ///< tracked without data bits: the component named by rinex_signal_code()
};

/// Chip rates: IS-GPS-200 and 705, Galileo OS SIS ICD, BDS-SIS-ICD-2.1 (B1I and B2I), BeiDou B3I ICD, GLONASS ICD L1,
/// L2 (0.511 Mchip/s). BOC of Galileo E1: 0.6 (MODELS.md 7.9).
SignalTraits signal_traits(Constellation constellation, Signal signal);

/// The receiver's code loop on such a signal: its chip rate in proportion, and a front end that passes at least the
/// main lobe.
CodeLoop code_loop_for(const CodeLoop& loop, const SignalTraits& traits);

/// "code_noise.G07.L1": the stream of random numbers of one process of one signal.
std::string signal_stream_name(std::string_view process, SatelliteId satellite, Signal signal);

}  // namespace skyloop
