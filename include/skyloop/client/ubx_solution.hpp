/// What a client understands of u-blox's solutions.
#pragma once

#include <vector>

#include "skyloop/client/configuration_dialogue.hpp"
#include "skyloop/client/heard_solution.hpp"
#include "skyloop/protocol/ubx_nav.hpp"

namespace skyloop {

/// NAV-PVT as a solution, without `heard` and `gps_s`. UTC counts only when the receiver says that it is fully
/// resolved (valid bits 0 to 2), as PX4 asks (RECEIVER.md 6.1).
HeardSolution heard_solution(const NavPvt& pvt);

/// What the careful client asks and tells: identification, port, rate, dynamic model, messages, and settings read back.
std::vector<DialogueStep> ubx_configuration();

/// The period of solutions that the careful client asks for, ms: 5 Hz, the default of ArduPilot and INAV.
inline constexpr std::uint16_t ubx_client_period_ms = 200;

}  // namespace skyloop
