/// The messages of USB/IP 1.1.1, and nothing that acts on them. Layouts: Linux kernel,
/// Documentation/usb/usbip_protocol. All numbers have their high byte first.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "base/core/bytes.hpp"
#include "wire/transport/cdc_acm_device.hpp"

namespace skyloop::inline wire {

inline constexpr std::uint16_t usbip_version = 0x0111;
/// Longer data of one transfer are taken for a mistake. Linux sends at most 16 kB at once to a virtual serial line.
inline constexpr std::uint32_t usbip_most_data = 262144;
inline constexpr std::size_t usbip_header_bytes = 48;

/// How a transfer or its cancelling ended, as Linux numbers its errors.
enum class UsbipStatus : std::int32_t {
    success = 0,
    no_memory = -12,  ///< ENOMEM
    stalled = -32,    ///< EPIPE
    unlinked = -104   ///< ECONNRESET
};

/// What a client may ask for before it has imported a device.
struct UsbipRequest {
    enum class Kind { device_list, import };
    Kind kind = Kind::device_list;
    std::string bus_id;  ///< of the device to import
};

/// USBIP_CMD_SUBMIT: a transfer.
struct UsbipSubmit {
    std::uint32_t sequence = 0;
    std::uint32_t device = 0;  ///< bus << 16 | number of the device
    bool to_host = false;
    std::uint32_t endpoint = 0;
    std::uint32_t length = 0;   ///< most bytes to the host, or as many as `data` has
    std::int32_t packets = -1;  ///< isochronous ones; −1 or 0 for none: told back as it came
    UsbSetup setup{};           ///< of endpoint 0
    Bytes data{};
};
/// USBIP_CMD_UNLINK: cancels a transfer.
struct UsbipUnlink {
    std::uint32_t sequence = 0;
    std::uint32_t device = 0;
    std::uint32_t target = 0;  ///< its sequence number
};
using UsbipCommand = std::variant<UsbipSubmit, UsbipUnlink>;

/// What stands at the beginning of some bytes: a message and its size; or a mistake; or neither, when bytes are
/// missing.
template <class Message>
struct UsbipParsed {
    std::optional<Message> message;
    std::size_t size = 0;
    std::string mistake;
};
UsbipParsed<UsbipRequest> parse_usbip_request(ByteSpan bytes);
/// Isochronous transfers, which a serial device has none of, and data longer than usbip_most_data are mistakes.
UsbipParsed<UsbipCommand> parse_usbip_command(ByteSpan bytes);

/// How a device is listed.
struct UsbipDevice {
    std::string path, bus_id;  ///< at most 255 and 31 characters
    std::uint32_t bus = 1, number = 2;
    UsbIds ids;
    std::uint16_t release = 0;
    std::array<std::uint8_t, 3> device_class{};  ///< class, subclass, protocol
    std::uint8_t configuration = 0;              ///< in force; 0: none
    std::vector<std::array<std::uint8_t, 3>> interfaces;
    /// As commands name it.
    [[nodiscard]] std::uint32_t id() const { return bus << 16 | number; }
};
/// OP_REP_DEVLIST with one device, or with none.
Bytes usbip_device_list(const UsbipDevice* device);

/// Why a device cannot be imported (tools/usb/usbip of the kernel).
enum class UsbipImport : std::uint32_t { granted = 0, busy = 2, no_such_device = 4 };
/// OP_REP_IMPORT; the device is told when it is granted.
Bytes usbip_import_reply(UsbipImport result, const UsbipDevice& device);
/// USBIP_RET_SUBMIT.
/// @param moved bytes of the transfer; those to the host are `data`
Bytes usbip_submit_reply(const UsbipSubmit& submit, UsbipStatus status, std::uint32_t moved, ByteSpan data);
/// USBIP_RET_UNLINK.
Bytes usbip_unlink_reply(const UsbipUnlink& unlink, UsbipStatus status);

}  // namespace skyloop::inline wire
