/// A floor for models that divide by sin e.
#pragma once

#include <algorithm>

#include "base/core/units.hpp"

namespace skyloop {

/// The elevation, or 0.01° below it: a satellite on the very horizon has a large delay, not an infinite one.
inline Angle above_horizon(Angle elevation) { return std::max(elevation, Angle::degrees(0.01)); }

}  // namespace skyloop
