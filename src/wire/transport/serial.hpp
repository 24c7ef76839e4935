/// A serial line of the machine: a UART, a USB adapter, a board's own USB port.
#pragma once

#include <cstdint>
#include <deque>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/core/bytes.hpp"
#include "base/core/result.hpp"
#include "wire/transport/device_search.hpp"
#include "wire/transport/serial_system.hpp"
#include "wire/transport/transport.hpp"

namespace skyloop::inline wire {

/// A line as it was asked for.
struct SerialAddress {
    std::filesystem::path device;
    std::optional<std::uint32_t> baud;  ///< of the line until a client changes the receiver's; bit/s
    SerialFormat format{};
};
/// Reads "DEVICE[@BAUD][,8N1][,rtscts]"; the format is 7 or 8, N, E or O, 1 or 2. BAUD is 50 to 12000000. Fails with
/// `usage` and a sentence that quotes the text.
Result<SerialAddress> parse_serial_address(std::string_view text);

/// The same for all names of a device, whatever links lead to it; where these cannot be followed, the name itself.
std::filesystem::path place_of_device(const std::filesystem::path& device);

/// What the other end and the adapter put on the modem lines (TIOCMGET).
struct ModemLines {
    bool cts = false, dsr = false, dcd = false, ring = false;
};

class SerialLine;

/// A serial line, held for the program alone.
///
/// It is connected for as long as its device is there: a line does not tell whether somebody listens. It has the
/// receiver's speed and takes up each change of it, after all earlier bytes have left the UART (WIRES.md section 6);
/// with a speed in the address it has that one until the receiver's changes. The speed of the other end is unknown:
/// a mismatch garbles by itself. A device that is unplugged is looked for every 500 ms, in another thread, and taken
/// again where it comes back. The settings that it had before are put back at the end.
///
/// State: bytes that wait for a change of speed.
class SerialTransport : public Transport {
public:
    /// Fails with `outside` when the device is absent, is no terminal line, is held by another program or refuses its
    /// speed.
    static Result<std::unique_ptr<SerialTransport>> open(
        const SerialAddress& address, std::shared_ptr<SerialSystem> system = std::make_shared<SerialSystem>());
    ~SerialTransport() override;
    SerialTransport(const SerialTransport&) = delete;
    SerialTransport& operator=(const SerialTransport&) = delete;

    std::size_t write(ByteSpan bytes) override;
    Bytes read() override;
    LineState line() override;
    void set_receiver_baud(std::uint32_t baud) override;
    std::vector<std::string> take_news() override;
    [[nodiscard]] std::string notice() const override;
    /// "/dev/ttyUSB0 (serial)".
    [[nodiscard]] std::string description() const override;

    /// Nothing where the device has none, or is not there.
    std::optional<ModemLines> modem_lines();
    /// The line's present speed, bit/s.
    [[nodiscard]] std::uint32_t baud() const { return baud_; }

private:
    // Bytes that leave at a speed which the line does not have yet.
    struct Segment {
        std::uint32_t baud = 0;
        Bytes bytes;
    };
    using Search = DeviceSearch<SerialLine>;

    SerialTransport(SerialAddress address, std::shared_ptr<SerialSystem> system);
    void adopt(std::unique_ptr<SerialLine> line);
    void follow();
    void lose();
    void search();
    void send_waiting();
    void ask_speed(std::uint32_t baud);
    bool change_speed(std::uint32_t baud);
    std::size_t put(ByteSpan bytes);

    SerialAddress address_;
    std::shared_ptr<SerialSystem> system_;
    std::unique_ptr<SerialLine> line_;          // none while the device is away
    std::optional<UsbIdentity> identity_;       // of a USB device, where it was last, remembered for the search
    std::uint32_t baud_;                        // of the line
    std::optional<std::uint32_t> told_baud_{};  // the receiver's
    std::deque<Segment> waiting_;
    std::size_t waiting_bytes_ = 0;
    std::int64_t change_asked_ns_ = 0;
    Search search_;
    std::vector<std::string> news_;
    std::uint64_t held_back_ = 0;  // bytes refused while CTS was low
};

}  // namespace skyloop::inline wire
