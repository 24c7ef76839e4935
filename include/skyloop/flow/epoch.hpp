/// What a receiver has at one navigation epoch.
#pragma once

#include "skyloop/flow/fix.hpp"
#include "skyloop/flow/observations.hpp"

namespace skyloop {

/// One navigation epoch, free of the truth.
struct Epoch {
    Fix fix;
    Observations observations{};  ///< empty for models that measure nothing
};

}  // namespace skyloop
