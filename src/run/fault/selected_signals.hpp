/// Which signals the parameters of a fault choose.
#pragma once

#include "run/fault/parameters.hpp"
#include "world/gnss/satellite.hpp"
#include "world/gnss/signal.hpp"

namespace skyloop {

/// Whether a fault with these checked parameters is for a signal, wherever in the sky its satellite stands. One that
/// chooses no satellites and signals is for all.
bool is_for(const Parameters& parameters, SatelliteId satellite, Signal signal);

}  // namespace skyloop
