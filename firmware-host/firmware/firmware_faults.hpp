/// What faults make of a receiver, as plain data; a sound one has none of it.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <set>
#include <string>
#include <variant>
#include <vector>

#include "base/core/units.hpp"
#include "firmware/navigation_state.hpp"
#include "receiver/protocol/ubx_frame.hpp"
#include "world/flow/receiver_settings.hpp"

namespace skyloop::firmware {

/// How a receiver is broken at one instant. Sentences are named by their message ids (class F0, F1), as u-blox does.
struct FirmwareFaults {
    bool deaf = false;                       ///< it hears nothing
    bool mute = false;                       ///< it sends nothing: no epochs, no answers, no texts
    bool unanswering = false;                ///< it executes what it hears and answers nothing
    std::set<UbxMessageId> unanswered{};     ///< it executes these and does not answer them
    std::set<UbxMessageId> refused{};        ///< it answers these with ACK-NAK, sentences not at all; nothing else
    std::set<std::uint32_t> refused_keys{};  ///< it refuses every CFG-VALSET that holds one of these
    std::set<UbxMessageId> withheld{};       ///< it does not send these with its epochs, whatever is configured
    std::optional<std::string> software{};   ///< swVersion of MON-VER
    std::optional<std::vector<std::string>> extensions{};  ///< of MON-VER
    Seconds answer_delay{0};                               ///< more before each answer
    Seconds solution_delay{0};                             ///< more from the epoch to its first byte
    /// Its interference monitor (MON-HW, MON-RF) stays at "unknown", as firmware does that has it off.
    bool jamming_hidden = false;
};

/// It starts anew: banner, stored configuration and speed, navigation as after a start of that kind.
struct Reboot {
    StartKind kind = StartKind::hot;
    bool banner = true;
    bool loses_battery = false;  ///< the battery-backed memory was without supply, too: what it held is lost
};
/// Its navigation starts anew; configuration, ports and texts stay.
struct RestartNavigation {
    StartKind kind = StartKind::hot;
};
/// RAM, battery-backed memory and flash are as at the factory, speed and messages among it; navigation goes on.
struct ForgetConfiguration {};
/// The speed of its first UART is another one, as after a mistaken command of somebody else.
struct ForceBaud {
    std::uint32_t baud = 9600;  ///< 0: that of before, unless it has been given another or was rebooted since
    bool given_back = false;    ///< the speed was forced before, too: on the same condition as 0
};
/// What happens to a receiver once.
using ReceiverEvent = std::variant<Reboot, RestartNavigation, ForgetConfiguration, ForceBaud>;

/// Changes what a receiver is about to report of an epoch.
using ReportEdit = std::function<void(NavigationState&)>;

}  // namespace skyloop::firmware
