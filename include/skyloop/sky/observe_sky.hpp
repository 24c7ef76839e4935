/// From orbits and a place to what stands in the sky.
#pragma once

#include "skyloop/flow/sky_view.hpp"
#include "skyloop/flow/truth_state.hpp"
#include "skyloop/gnss/navigation_source.hpp"

namespace skyloop {

/// Every satellite of `source` above the horizon at `truth.time`, with light time iterated and the Earth's rotation
/// during it (MODELS.md 3.4). Satellites without a valid record are absent.
SkyView observe_sky(const TruthState& truth, const NavigationSource& source);

}  // namespace skyloop
