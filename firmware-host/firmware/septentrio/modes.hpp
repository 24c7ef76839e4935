/// What a Septentrio receiver is told of its solution: modes, motion, signals (mosaic-X5 reference guide,
/// firmware 4.14, chapter 3; PolaRx5TR reference guide, firmware 5.5, setPVTMode and setReceiverDynamics).
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "firmware/navigation_state.hpp"
#include "firmware/septentrio/settings.hpp"

namespace skyloop::firmware {

/// The most of the corrections at hand that PVTMode allows to be used.
CorrectionState allowed_corrections(const SeptentrioSettings& settings, CorrectionState at_hand);

/// Takes a solution of a kind that PVTMode does not allow for none.
void withhold_forbidden(const SeptentrioSettings& settings, NavigationState& state);

/// What stands where it was told (PVTMode Static) and solves the time alone has that place for its position.
void tell_given_place(NavigationState& state);

/// CFG-NAVSPG-DYNMODEL for a motion of ReceiverDynamics; nothing for a word that is not known.
std::optional<std::uint64_t> model_of_motion(std::string_view motion);

/// A signal's name, such as GPSL2C; empty for one without.
std::string_view signal_name(SystemSignal signal);

/// Whether a list of words by + has this one, or "all".
bool lists(std::string_view words, std::string_view word);

}  // namespace skyloop::firmware
