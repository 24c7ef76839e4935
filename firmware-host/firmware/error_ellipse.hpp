/// The horizontal error ellipse that a receiver reports.
#pragma once

#include <optional>
#include <span>

#include "base/core/units.hpp"
#include "world/flow/fix.hpp"

namespace skyloop::firmware {

/// One standard deviation of the horizontal position: its axes, and its parts along north and east.
struct ErrorEllipse {
    Metres semi_major;
    Metres semi_minor;
    Angle orientation;  ///< of the major axis from true north, 0 … 180°
    Metres north;
    Metres east;
};

/// Splits the fix's horizontal accuracy along north and east as its DOPs are, with the correlation that the directions
/// of the used satellites give (unit weights, position and one clock); without four of them, none. Nothing when the fix
/// has no horizontal DOP.
std::optional<ErrorEllipse> error_ellipse(const Fix& fix, std::span<const SatelliteStatus> used);

}  // namespace skyloop::firmware
