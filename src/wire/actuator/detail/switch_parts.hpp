/// The kinds of actuators, each from its address to its hardware.
#pragma once

#include <memory>
#include <string_view>

#include "wire/actuator/actuator_uri.hpp"

namespace skyloop::inline wire {

// Each finds its hardware and opens it, and fails with `outside` as open_actuator() does.
Result<std::unique_ptr<Actuator>> open_switch(const RelayAddress& address);
Result<std::unique_ptr<Actuator>> open_switch(const GpioAddress& address);
Result<std::unique_ptr<Actuator>> open_switch(const HubPortAddress& address);
Result<std::unique_ptr<Actuator>> open_switch(const ModemLineAddress& address);
Result<std::unique_ptr<Actuator>> open_switch(const SwitchCommands& commands);

/// Fails with `outside` where the switch can be asked and is in another state than `wanted`, as `otherwise` says: "the
/// board says it is drawn".
Result<void> check_followed(Actuator& one, PowerState wanted, std::string_view otherwise);

/// The level at which an output gives this state.
inline bool active_for(PowerState state, ActiveLevel active) {
    return (state == PowerState::cut) == (active == ActiveLevel::cuts);
}
/// What an output at this level gives.
inline PowerState state_at(bool active_now, ActiveLevel active) {
    return active_now == (active == ActiveLevel::cuts) ? PowerState::cut : PowerState::on;
}

}  // namespace skyloop::inline wire
