/// Which signals the parameters of a fault choose.
#pragma once

#include "skyloop/fault/parameters.hpp"
#include "skyloop/gnss/satellite.hpp"
#include "skyloop/gnss/signal.hpp"

namespace skyloop {

/// Whether a fault with these checked parameters is for a signal, wherever in the sky its satellite stands. One that
/// chooses no satellites and signals is for all.
bool is_for(const Parameters& parameters, SatelliteId satellite, Signal signal);

}  // namespace skyloop
