/// A serial line behind a USB device that this program drives itself: CDC-ACM over libusb, CP2110 over hidapi.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/core/result.hpp"
#include "wire/transport/device_search.hpp"
#include "wire/transport/transport.hpp"
#include "wire/usb/serial_bridge.hpp"

namespace skyloop::inline wire {

/// A bridge as it was asked for.
struct UsbBridgeAddress {
    UsbAddress device;
    std::optional<std::uint32_t> baud;  ///< of the line until a client changes the receiver's; bit/s
    SerialFormat format{};
};
/// Reads "VID:PID[:SERIAL|@PORT][,BAUD][,8N1][,rtscts]", as parse_usb_address and a serial line's options. A comma ends
/// the serial number. Fails with `usage` and a sentence that quotes the text.
Result<UsbBridgeAddress> parse_usb_bridge_address(std::string_view text);

/// A bridge of either kind as a wire.
///
/// It is connected for as long as its device is there, and has the receiver's speed as a SerialTransport has it. A
/// device that is unplugged is looked for every 500 ms, in another thread, and taken again: at its old port, or by its
/// serial number as the only one that was plugged in elsewhere since (cheap devices share one).
class UsbBridgeTransport : public Transport {
public:
    /// Opens a device of this address; called from other threads, too, one call at a time.
    using Opener = std::function<Result<std::unique_ptr<SerialBridge>>(const UsbAddress&, const BridgeLine&)>;
    /// Gives every USB device that is plugged in; called as an Opener is.
    using Lister = std::function<std::vector<UsbDeviceInfo>()>;
    /// `kind` is for people: "usb", "hid". Without a lister libusb lists. Fails as `opener` does.
    static Result<std::unique_ptr<UsbBridgeTransport>> open(const UsbBridgeAddress& address, Opener opener,
                                                            std::string_view kind, Lister lister = {});

    std::size_t write(ByteSpan bytes) override;
    Bytes read() override;
    LineState line() override;
    void set_receiver_baud(std::uint32_t baud) override;
    std::vector<std::string> take_news() override;
    /// "1546:01a8 (usb)".
    [[nodiscard]] std::string description() const override;

private:
    using Search = DeviceSearch<SerialBridge>;

    UsbBridgeTransport(UsbBridgeAddress address, Opener opener, std::string_view kind, Lister lister);
    void follow();
    void lose();
    void search();
    [[nodiscard]] std::function<Search::Ports()> ports_of_its_kind() const;
    static Search::Attempt attempt(const Opener& opener, const std::vector<UsbAddress>& places, const BridgeLine& line);

    UsbBridgeAddress address_;
    Opener opener_;
    std::string kind_;
    Lister lister_;
    std::unique_ptr<SerialBridge> bridge_{};  // none while the device is away
    UsbDeviceInfo known_{};
    std::uint32_t baud_;                        // of the line
    std::optional<std::uint32_t> told_baud_{};  // the receiver's
    Search search_{};
    std::vector<std::string> news_{};
};

}  // namespace skyloop::inline wire
