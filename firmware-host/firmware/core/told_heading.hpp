/// The heading that a receiver tells, and how fast it turns.
#pragma once

#include <optional>

#include "base/core/units.hpp"
#include "base/time/gps_time.hpp"
#include "firmware/core/board_profile.hpp"
#include "firmware/core/navigation_state.hpp"

namespace skyloop::firmware {

/// From true north, clockwise, and what measured it.
struct ToldHeading {
    Angle heading;
    HeadingSource from = HeadingSource::antennas;
};

/// That of a pair of antennas, where one is measured.
/// @param otherwise what takes its place; nothing while that has none
std::optional<ToldHeading> told_heading(const NavigationState& state, HeadingSource otherwise);

/// How fast a heading turns from epoch to epoch. State: the last one, and when it was.
class TurnRate {
public:
    /// Degrees per minute, positive clockwise; nothing for the first heading, and for one of another source than the
    /// last. Headings that are more than two seconds apart may be of more than a turn.
    std::optional<double> follow(const std::optional<ToldHeading>& told, GpsTime time);

private:
    std::optional<ToldHeading> last_;
    GpsTime when_{};
};

}  // namespace skyloop::firmware
