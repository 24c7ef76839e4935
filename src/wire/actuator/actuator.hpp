/// What cuts the power, or a line, of a real device, and puts it back.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "base/core/process.hpp"
#include "base/core/result.hpp"

namespace skyloop::inline wire {

/// What a device under test gets by way of an actuator.
enum class PowerState { on, cut };

/// One switch. Its functions may wait, for seconds when the hardware does not answer, and so are never called by the
/// thread of the loop. A destroyed actuator leaves the power as it is.
class Actuator {
public:
    virtual ~Actuator() = default;
    /// Both succeed only when the hardware took the order and, where it can be asked, says that it followed. Both may
    /// be called again in the state that they lead to. Fail with `outside` and a sentence that names the actuator.
    virtual Result<void> cut() = 0;
    virtual Result<void> restore() = 0;
    /// As the hardware tells; nothing where it cannot be asked. Fails with `outside`.
    virtual Result<std::optional<PowerState>> state() = 0;
    /// Whether an order to cut is still wanted may be asked while it is being carried out: one that takes long then
    /// ends early, and fails. Called before any order.
    virtual void ask_while_cutting(const std::function<bool()>& /*wanted*/) {}
    /// Where orders are carried out by other programs: whom to tell their process group when one begins, and nothing
    /// when it has been ended. Called before any order.
    virtual void tell_process_groups(const ProcessGroupListener& /*listener*/) {}
    /// For people: "relay 1 of USBRelay2 (16c0:05df at 1-1.2)".
    [[nodiscard]] virtual std::string description() const = 0;
    /// What is the same for all that open this switch, and for no other switch of the machine. Empty: nothing tells, or
    /// it is locked in another way.
    [[nodiscard]] virtual std::string lock_name() const { return {}; }
};

/// "on" or "cut".
inline const char* to_string(PowerState state) { return state == PowerState::on ? "on" : "cut"; }

}  // namespace skyloop::inline wire
