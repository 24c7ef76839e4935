/// A USB device that puts bytes on a serial line, driven from user space.
/// What lies between a loop that never waits and the thread that drives a bridge.
#pragma once

#include <cstdint>
#include <deque>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "base/core/bytes.hpp"
#include "wire/usb/usb_device.hpp"

namespace skyloop::inline wire {

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

/// Bytes of both directions, bounded, with the changes of speed in their place. Its functions hold a lock while they
/// copy, and for nothing else. State: as said.
class BridgeBuffers {
public:
    /// Bytes that are to leave at a speed, bit/s. Without bytes: only the speed is to change.
    struct Piece {
        std::uint32_t baud = 0;
        Bytes bytes;
    };
    /// As much as a pseudo-terminal holds that nobody reads.
    static constexpr std::size_t most_output = 16384, most_input = 65536;

    explicit BridgeBuffers(std::uint32_t baud) : given_baud_(baud), pieces_{{baud, {}}} {}

    /// The loop's side. How many bytes were taken.
    std::size_t offer(ByteSpan bytes);
    void ask_speed(std::uint32_t baud);
    Bytes take_input();
    std::vector<std::string> take_news();
    [[nodiscard]] bool gone() const;

    /// The driver's side. What is to leave next, up to `most` bytes of one speed; nothing when all has left.
    std::optional<Piece> next_output(std::size_t most);
    [[nodiscard]] bool output_waits() const;
    void put_input(ByteSpan bytes);
    /// No more should be asked of the device until the loop has read.
    [[nodiscard]] bool input_full() const;
    void tell(std::string news);
    void set_gone();

private:
    mutable std::mutex mutex_;
    std::uint32_t given_baud_;  // of the last piece that was given out
    std::deque<Piece> pieces_;  // never empty: the last one takes what is offered
    std::size_t output_size_ = 0;
    Bytes input_;
    std::vector<std::string> news_;
    bool gone_ = false;
};

}  // namespace skyloop::inline wire
