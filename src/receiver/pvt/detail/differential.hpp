/// What a receiver makes of the corrections of a base station.
#pragma once

#include "world/flow/observations.hpp"
#include "world/flow/receiver_settings.hpp"

namespace skyloop {

/// Takes the corrections off the pseudoranges. With fixed ambiguities the carrier's range stands in their place; with
/// float ones that range with a share of the code's error, which is what the average of many codes leaves in the
/// ambiguities. Signals whose phase does not serve lose their pseudorange, as all without a correction.
/// @return what came out of it: differential, where fewer than five satellites have phases that serve
CorrectionState correct(Observations& observations, CorrectionState wanted);

}  // namespace skyloop
