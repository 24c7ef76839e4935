/// A USB device that puts bytes on a serial line, driven from user space.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/core/bytes.hpp"
#include "base/core/line_format.hpp"
#include "wire/usb/usb_address.hpp"

namespace skyloop {

/// The line behind a bridge.
struct BridgeLine {
    std::uint32_t baud = 0;  ///< bit/s
    SerialFormat format{};
    [[nodiscard]] std::int64_t byte_ns() const { return format.byte_ns(baud); }
};

/// A bridge that is open. A thread of its own talks to the device; none of these functions waits for it. To destroy it
/// does: up to 0.2 s for the last bytes, and until the device has answered or is gone.
class SerialBridge {
public:
    virtual ~SerialBridge() = default;
    /// Gives how many bytes it took; the others find its buffer full.
    virtual std::size_t write(ByteSpan bytes) = 0;
    virtual Bytes read() = 0;
    /// The line has this speed, bit/s, once all bytes that were written before have left it.
    virtual void set_baud(std::uint32_t baud) = 0;
    /// The device has been unplugged, or answers no more. It never comes back to this bridge.
    [[nodiscard]] virtual bool gone() const = 0;
    /// What has happened since the last call and its owner should hear, in sentences.
    virtual std::vector<std::string> take_news() = 0;
    [[nodiscard]] virtual const UsbDeviceInfo& info() const = 0;
};

}  // namespace skyloop
