/// A USB device with one virtual serial line, as receivers with a USB port of their own are: what it says of itself and
/// how it answers its host's requests. No wire and no clock.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/core/bytes.hpp"
#include "wire/usb/usb_device.hpp"

namespace skyloop::inline wire {

/// What a virtual device says it is. The default is the generic serial device of Linux' own USB gadgets, of no maker of
/// receivers.
struct UsbFace {
    UsbIds ids{0x0525, 0xa4a7};
    std::uint16_t release = 0x0100;  ///< bcdDevice: 0x0301 is 3.01
    std::string manufacturer = "skyloop";
    std::string product = "GNSS receiver";
    std::string serial;  ///< empty: the device has none
};

/// The eight bytes that begin a control transfer (USB 2.0, table 9-2).
struct UsbSetup {
    std::uint8_t type = 0;  ///< bmRequestType; bit 7: towards the host
    std::uint8_t request = 0;
    std::uint16_t value = 0, index = 0, length = 0;
    [[nodiscard]] bool to_host() const { return (type & 0x80) != 0; }
};
/// From the wire: numbers of two bytes have their low byte first.
UsbSetup parse_usb_setup(const std::array<std::uint8_t, 8>& bytes);

/// How the host has set the line (USB CDC PSTN 1.2, table 17).
struct UsbLineCoding {
    std::uint32_t baud = 9600;   ///< dwDTERate, bit/s
    std::uint8_t stop_bits = 0;  ///< bCharFormat: 0 is 1, 1 is 1.5, 2 is 2
    std::uint8_t parity = 0;     ///< bParityType: none, odd, even, mark, space
    std::uint8_t data_bits = 8;
};
/// "115200 8N1".
std::string to_string(const UsbLineCoding& coding);

/// The device of USB CDC's abstract control model (CDC 1.2 and PSTN 1.2): interface 0 with its interrupt endpoint,
/// interface 1 with two bulk endpoints, full speed, powered by itself. The layout is that of a u-blox 8.
///
/// State: what the host has configured.
class CdcAcmDevice {
public:
    static constexpr std::uint8_t data_out = 1, data_in = 2, notify_in = 3;  ///< endpoint numbers
    static constexpr std::size_t packet_bytes = 64;                          ///< of every endpoint (wMaxPacketSize)

    explicit CdcAcmDevice(const UsbFace& face);

    /// Answers a control request.
    /// @param data what came with a request away from the host
    /// @return what goes to the host, empty where nothing does; nothing at all: the request stalls (USB 2.0, 8.5.3.4)
    std::optional<Bytes> control(const UsbSetup& setup, ByteSpan data);

    [[nodiscard]] const Bytes& device_descriptor() const { return device_; }
    [[nodiscard]] const Bytes& configuration_descriptor() const { return configuration_; }
    [[nodiscard]] bool configured() const { return configured_; }
    /// Halted by SET_FEATURE; its transfers stall until the host clears it.
    /// @param endpoint its number, without the direction
    [[nodiscard]] bool halted(std::uint8_t endpoint) const { return endpoint <= notify_in && halted_[endpoint]; }
    /// What the host has set; nothing while it has not.
    [[nodiscard]] const std::optional<UsbLineCoding>& line_coding() const { return coding_; }
    [[nodiscard]] bool dtr() const { return (lines_ & 1) != 0; }
    [[nodiscard]] bool rts() const { return (lines_ & 2) != 0; }
    /// The break that the host asked for since the last call: ms, 0xFFFF until further notice, 0 its end.
    std::optional<std::uint16_t> take_break();
    /// The next SERIAL_STATE (PSTN 1.2, 6.5.4) for the interrupt endpoint: carrier and DSR, which this device always
    /// has.
    std::optional<Bytes> take_notification();
    /// Bytes for the host were discarded: the next notification says so once (bOverRun).
    void note_overrun() { overrun_ = notify_ = true; }

private:
    std::optional<Bytes> standard(const UsbSetup& setup);
    std::optional<Bytes> of_class(const UsbSetup& setup, ByteSpan data);
    [[nodiscard]] std::optional<Bytes> descriptor(const UsbSetup& setup) const;
    [[nodiscard]] std::optional<Bytes> status(const UsbSetup& setup) const;
    bool set_halt(const UsbSetup& setup, bool halted);
    bool begin_anew(std::uint16_t interface);
    bool configure(std::uint16_t value);

    Bytes device_, configuration_;
    std::vector<Bytes> strings_;  // descriptors, by their index; 0 lists the languages
    bool configured_ = false;
    std::array<bool, notify_in + 1> halted_{};
    std::optional<UsbLineCoding> coding_;
    std::uint16_t lines_ = 0;  // of SET_CONTROL_LINE_STATE
    std::optional<std::uint16_t> break_;
    bool notify_ = false, overrun_ = false;
};

}  // namespace skyloop::inline wire
