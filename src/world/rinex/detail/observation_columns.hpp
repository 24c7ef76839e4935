/// Where the observations of each signal stand in the records of an observation file.
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "world/gnss/signal.hpp"

namespace skyloop::rinex {

/// The fields of one observation code; absent ones are -1.
struct CodeColumns {
    int pseudorange = -1, phase = -1, doppler = -1, strength = -1;
};

/// The codes of one signal, the best first.
struct SignalColumns {
    Signal signal = Signal::l1;
    std::vector<CodeColumns> codes;
};

/// The signals of a system that can be found among its observation types, in the order of Signal.
/// @param types "C1C", "L1C", … in the order of the fields; of version 2 "C1", "P2", …
/// @param version of RINEX: 3.02 calls B1I "1I" where all others call it "2I"
std::vector<SignalColumns> signal_columns(Constellation system, std::span<const std::string> types, double version);

}  // namespace skyloop::rinex
