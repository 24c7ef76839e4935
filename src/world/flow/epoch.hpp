/// What a receiver has at one navigation epoch.
#pragma once

#include <optional>
#include <vector>

#include "world/flow/fix.hpp"
#include "world/flow/front_end.hpp"
#include "world/flow/observations.hpp"
#include "world/flow/relative_position.hpp"
#include "world/flow/subframe.hpp"

namespace skyloop {

/// One navigation epoch, free of the truth.
struct Epoch {
    Fix fix;
    Observations observations{};        ///< empty for models that measure nothing
    std::vector<Subframe> subframes{};  ///< received since the epoch before, when the settings ask for them
    FrontEnd front_end{};
    std::optional<RelativePosition> relative{};  ///< to the base antenna of a pair
};

}  // namespace skyloop
