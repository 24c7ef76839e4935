/// The power of one port of a USB hub.
#pragma once

#include <optional>
#include <string>

#include "base/core/bytes.hpp"
#include "base/core/result.hpp"
#include "wire/usb/usb_device.hpp"

namespace skyloop::inline wire {

/// A port of a hub that is plugged in.
class HubPort {
public:
    /// @param port_path of what is, or would be, plugged into it: "1-1.4" is port 4 of the hub at 1-1, "1-2" port 2 of
    /// the root hub of bus 1. Fails with `usage` for another text, with `outside`: no such hub, no such port, no
    /// permission, or the hub does not switch its ports one by one (USB 2.0, table 11-13: wHubCharacteristics).
    static Result<HubPort> open(const std::string& port_path);

    /// Set or clear PORT_POWER (USB 2.0, sections 11.24.2.2 and 11.24.2.13). Fails with `outside`.
    Result<void> set_power(bool on);
    /// As the hub tells in the status of the port (USB 2.0, table 11-21; USB 3.2, table 10-13). Fails with `outside`.
    Result<bool> powered();
    [[nodiscard]] std::string description() const;
    /// Of the hub.
    [[nodiscard]] const UsbDeviceInfo& hub() const { return info_; }
    /// Counted from 1.
    [[nodiscard]] int number() const { return port_; }

private:
    HubPort(UsbHandle hub, UsbDeviceInfo info, int port, bool superspeed)
        : hub_(std::move(hub)), info_(std::move(info)), port_(port), superspeed_(superspeed) {}

    UsbHandle hub_;
    UsbDeviceInfo info_;
    int port_;
    bool superspeed_;
};

/// What the descriptor of a hub says of its ports.
struct HubPorts {
    int count = 0;
    bool switched_one_by_one = false;
};
/// Nothing for what is no hub descriptor (USB 2.0, table 11-13; USB 3.2, table 10-3).
std::optional<HubPorts> hub_ports(ByteSpan descriptor);

}  // namespace skyloop::inline wire
