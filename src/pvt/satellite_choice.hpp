/// Which satellites a receiver solves with that has no time for all of them.
#pragma once

#include "skyloop/flow/observations.hpp"
#include "skyloop/flow/receiver_settings.hpp"

namespace skyloop {

/// Leaves `settings.most_satellites` satellites with pseudoranges, those whose strongest signal is; the others stay
/// tracked. Of equally strong ones those that come first.
void keep_strongest(Observations& observations, const ReceiverSettings& settings);

}  // namespace skyloop
