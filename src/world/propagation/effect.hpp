/// One cause of delay or loss between a satellite and the antenna.
#pragma once

#include "world/flow/arrivals.hpp"
#include "world/flow/sky_view.hpp"
#include "world/flow/truth_state.hpp"

namespace skyloop {

/// Changes what arrives. Effects are applied in a fixed order; each writes only the fields of its own cause.
class PropagationEffect {
public:
    virtual ~PropagationEffect() = default;
    /// @param arrivals one for each satellite of `sky`, in its order
    virtual void apply(Arrivals& arrivals, const SkyView& sky, const TruthState& truth) = 0;
};

}  // namespace skyloop
