/// How a careful client sets a u-blox receiver up.
#pragma once

#include <cstdint>
#include <vector>

#include "run/client/configuration_dialogue.hpp"

namespace skyloop {

/// What the careful client asks and tells: identification, port, rate, dynamic model, messages, and settings read back.
/// Where NAV-PVT is refused it takes the older messages, as PX4 and ArduPilot do.
std::vector<DialogueStep> ubx_configuration();

/// The period of solutions that the careful client asks for, ms: 5 Hz, the default of ArduPilot and INAV.
inline constexpr std::uint16_t ubx_client_period_ms = 200;

}  // namespace skyloop
