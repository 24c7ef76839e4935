/// What faults make of a receiver, as plain data; a sound one has none of it.
/// Kinds of a start by their names.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "base/core/units.hpp"
#include "firmware/core/navigation_state.hpp"
#include "receiver/protocol/ubx_frame.hpp"
#include "world/flow/receiver_settings.hpp"

namespace skyloop::firmware {

/// In the order of StartKind.
inline constexpr std::array<std::string_view, 3> start_kind_names{"cold", "warm", "hot"};

/// One of start_kind_names, as faults and commands name them; nothing for any other word.
inline std::optional<StartKind> start_kind(std::string_view word) {
    for (std::size_t i = 0; i < start_kind_names.size(); ++i)
        if (start_kind_names[i] == word) return static_cast<StartKind>(i);
    return std::nullopt;
}

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
    bool no_node_status = false;  ///< a CAN node sends no NodeStatus, whatever else it sends
    bool shares_node_id = false;  ///< another CAN node of its bus has the same node id
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
