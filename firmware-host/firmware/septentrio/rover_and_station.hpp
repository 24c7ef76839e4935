/// What a Septentrio receiver is told of its solution: modes, motion, signals (mosaic-X5 reference guide,
/// firmware 4.14, chapter 3; PolaRx5TR reference guide, firmware 5.5, setPVTMode and setReceiverDynamics).
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "base/core/bytes.hpp"
#include "base/geo/geodetic.hpp"
#include "firmware/core/navigation_state.hpp"
#include "firmware/septentrio/settings.hpp"

namespace skyloop::firmware {

/// The most of the corrections at hand that PVTMode allows to be used.
CorrectionState allowed_corrections(const SeptentrioSettings& settings, CorrectionState at_hand);

/// Takes a solution of a kind that PVTMode does not allow for none.
void withhold_forbidden(const SeptentrioSettings& settings, NavigationState& state);

/// The number of the dynamic model (dynamic_model_of()) for a motion of ReceiverDynamics; nothing for a word that is
/// not known.
std::optional<std::uint64_t> model_of_motion(std::string_view motion);

/// A signal and its name, such as GPSL2C.
struct NamedSignal {
    SystemSignal signal;
    std::string_view name;
};
std::span<const NamedSignal> septentrio_signals();

/// Whether a list of words by + has this one, or "all".
bool lists(std::string_view words, std::string_view word);

/// Whether a port sends a protocol: "SBF", "NMEA", "RTCMv3".
bool lets_through(const SeptentrioSettings& settings, std::string_view port, std::string_view protocol);

/// Where it stands, when PVTMode says that it does and the position of which it speaks has been set.
std::optional<Position<Ecef>> told_place(const SeptentrioSettings& settings);

}  // namespace skyloop::firmware
