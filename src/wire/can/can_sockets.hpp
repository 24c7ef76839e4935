/// CAN buses that the operating system has: SocketCAN, and ArduPilot's buses of UDP multicast.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/core/can_frame.hpp"
#include "base/core/result.hpp"

namespace skyloop::inline wire {

/// A socket on a bus, for reading and writing without waiting.
class CanSocket {
public:
    virtual ~CanSocket() = default;
    /// False where the system takes no frame now: it is lost.
    virtual bool send(const CanFrame& frame) = 0;
    /// Frames of others since the last call, at most some thousands.
    virtual std::vector<CanFrame> receive() = 0;
};

/// A raw socket on a CAN interface, "can0" or "vcan0" (linux/can.h). Fails with `outside`, naming the interface.
Result<std::unique_ptr<CanSocket>> open_socketcan(const std::string& interface);

/// The highest number of a bus of UDP multicast.
inline constexpr int most_multicast_bus = 255;
/// A bus as ArduPilot's SITL and pydronecan have it (AP_HAL_SITL and AP_Networking, CAN_Multicast.cpp; pydronecan,
/// driver/mcast.py): group 239.65.82.BUS, port 57732, one frame a datagram, from and to the loopback interface of this
/// machine alone. What was sent is not received. Fails with `outside`.
Result<std::unique_ptr<CanSocket>> open_multicast_bus(int bus);

/// A frame as one of those datagrams has it, little-endian: 0x2934, CRC-16-CCITT of all that follows, flags, id with
/// bit 31 for an extended one, data.
Bytes multicast_datagram(const CanFrame& frame);
/// Nothing for datagrams that are none, or that hold frames of CAN FD.
std::optional<CanFrame> parse_multicast_datagram(ByteSpan datagram);

}  // namespace skyloop::inline wire
