/// What a receiver has at one navigation epoch.
#pragma once

#include "skyloop/flow/fix.hpp"

namespace skyloop {

/// One navigation epoch, free of the truth.
struct Epoch {
    Fix fix;
};

}  // namespace skyloop
