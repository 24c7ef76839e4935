/// The seam of all sensor models that add errors to the truth instead of measuring and solving.
#pragma once

#include "skyloop/flow/arrivals.hpp"
#include "skyloop/flow/fix.hpp"
#include "skyloop/flow/sky_view.hpp"
#include "skyloop/flow/truth_state.hpp"

namespace skyloop {

/// A sensor model of the literature: from what is true and what arrives to what the receiver reports.
class ErrorModel {
public:
    virtual ~ErrorModel() = default;
    /// The fix of one epoch; epochs come in ascending time. Its satellites are those of `sky`, in its order.
    virtual Fix fix(const TruthState& truth, const SkyView& sky, const Arrivals& arrivals) = 0;
};

}  // namespace skyloop
