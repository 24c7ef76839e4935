/// The vector from a base station that a receiver tells.
#pragma once

#include <optional>

#include "firmware/core/navigation_state.hpp"

namespace skyloop::firmware {

/// From a base to this antenna, and by what it was solved.
struct ToldBaseline {
    RelativePosition vector;
    CorrectionState solution = CorrectionState::differential;  ///< differential: by codes
};

/// The vector of a pair of receivers, or that from the station of the corrections. Where the solution has no vector of
/// its own it leads from where the station says it stands to the reported position, and has that one's accuracies.
/// Nothing without a position, and while no corrections of a station with a place are in the solution.
std::optional<ToldBaseline> told_baseline(const NavigationState& state);

}  // namespace skyloop::firmware
