/// The seam of all sensor models that add errors to the truth instead of measuring and solving.
#pragma once

#include "world/flow/arrivals.hpp"
#include "world/flow/fix.hpp"
#include "world/flow/sky_view.hpp"
#include "world/flow/truth_state.hpp"

namespace skyloop {

/// A sensor model of the literature: from what is true and what arrives to what the receiver reports.
class ErrorModel {
public:
    virtual ~ErrorModel() = default;
    /// The fix of one epoch; epochs come in ascending time. Its satellites are those of `sky`, in its order.
    virtual Fix fix(const TruthState& truth, const SkyView& sky, const Arrivals& arrivals) = 0;
};

}  // namespace skyloop
