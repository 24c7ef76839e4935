/// From what a user types as `power` to an actuator.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "base/core/result.hpp"
#include "wire/actuator/actuator.hpp"
#include "wire/usb/usb_device.hpp"

namespace skyloop::inline wire {

/// What the active level of an output does: a relay drawn, a pin high, a modem line asserted.
enum class ActiveLevel { cuts, powers };

/// `relay:VID:PID[:SERIAL|@PORT_PATH]/N`: a relay of a HID relay board, counted from 1.
struct RelayAddress {
    UsbAddress board;
    int number = 1;
    ActiveLevel active = ActiveLevel::cuts;
};
/// `gpio:VID:PID[:SERIAL|@PORT_PATH]/N`: pin GP0 … GP3 of an MCP2221A.
struct GpioAddress {
    UsbAddress board;
    int number = 0;
    ActiveLevel active = ActiveLevel::cuts;
};
/// `hub:PORT_PATH`: the power of the port of a hub that the path ends at, "1-1.4".
struct HubPortAddress {
    std::string port_path;
};
/// `line:DEVICE/rts` or `line:DEVICE/dtr`: a modem line of a serial device.
struct ModemLineAddress {
    std::filesystem::path device;
    enum class Line { rts, dtr } line = Line::rts;
    ActiveLevel active = ActiveLevel::cuts;
};
/// `command:CUT|RESTORE` or `command:CUT|RESTORE|STATE`: programs of the host, each a program and its arguments. The
/// third prints "on" or "cut".
struct SwitchCommands {
    std::vector<std::string> cut, restore, state;
};
using ActuatorUri = std::variant<RelayAddress, GpioAddress, HubPortAddress, ModemLineAddress, SwitchCommands>;

/// Relay, GPIO and line take `,active=cut` (default) or `,active=power` at their end. Words of a command are parted by
/// spaces; '…' and "…" hold words together, a backslash takes the next character as it is, outside of '…'. No shell
/// sees them. Fails with `usage` and a sentence that quotes the URI.
Result<ActuatorUri> parse_actuator_uri(std::string_view uri);

/// Whether both may lead to one switch, whatever level cuts there. A board that is named by its ids alone may be any of
/// them; what one names by its serial number and the other by its port is taken for two.
bool may_be_one_switch(const ActuatorUri& a, const ActuatorUri& b);

/// Finds the hardware and opens it; switches nothing. Fails with `usage` as parse_actuator_uri(), with `outside` when
/// the hardware is not there, is another one than it was taken for, or may not be used.
Result<std::unique_ptr<Actuator>> open_actuator(std::string_view uri);

}  // namespace skyloop::inline wire
