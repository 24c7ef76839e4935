#include "wire/transport/usbip_messages.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace skyloop::inline wire {
namespace {

constexpr std::uint16_t request_import = 0x8003, request_list = 0x8005, reply_import = 0x0003, reply_list = 0x0005;
constexpr std::uint32_t command_submit = 1, command_unlink = 2, reply_submit = 3, reply_unlink = 4;
constexpr std::uint32_t full_speed = 2;  // enum usb_device_speed of Linux
constexpr std::size_t request_bytes = 8, path_bytes = 256, bus_id_bytes = 32;

std::uint32_t number_at(ByteSpan bytes, std::size_t at, std::size_t size) {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < size; ++i)
        value = value << 8 | bytes[at + i];
    return value;
}
std::uint32_t word_at(ByteSpan bytes, std::size_t at) { return number_at(bytes, at, 4); }

void put(Bytes& bytes, std::uint32_t value, std::size_t size) {
    for (std::size_t i = size; i-- > 0;)
        bytes.push_back(static_cast<std::uint8_t>(value >> 8 * i & 0xFF));
}
void put_word(Bytes& bytes, std::uint32_t value) { put(bytes, value, 4); }

// Zeros behind the text, at least one.
void put_text(Bytes& bytes, std::string_view text, std::size_t size) {
    text = text.substr(0, size - 1);
    bytes.insert(bytes.end(), text.begin(), text.end());
    bytes.insert(bytes.end(), size - text.size(), 0);
}

void put_device(Bytes& bytes, const UsbipDevice& device) {
    put_text(bytes, device.path, path_bytes);
    put_text(bytes, device.bus_id, bus_id_bytes);
    put_word(bytes, device.bus);
    put_word(bytes, device.number);
    put_word(bytes, full_speed);
    put(bytes, device.ids.vendor, 2);
    put(bytes, device.ids.product, 2);
    put(bytes, device.release, 2);
    bytes.insert(bytes.end(), device.device_class.begin(), device.device_class.end());
    bytes.push_back(device.configuration);
    bytes.push_back(1);  // configurations
    bytes.push_back(static_cast<std::uint8_t>(device.interfaces.size()));
}

Bytes reply_header(std::uint16_t code, std::uint32_t status) {
    Bytes bytes;
    put(bytes, usbip_version, 2);
    put(bytes, code, 2);
    put_word(bytes, status);
    return bytes;
}

// The fields that every reply to a command begins with; device, direction and endpoint are zero in replies.
Bytes command_reply(std::uint32_t code, std::uint32_t sequence, UsbipStatus status) {
    Bytes bytes;
    put_word(bytes, code);
    put_word(bytes, sequence);
    bytes.resize(20, 0);
    put_word(bytes, static_cast<std::uint32_t>(status));
    return bytes;
}

template <class Message>
UsbipParsed<Message> mistaken(std::string mistake) {
    return {std::nullopt, 0, std::move(mistake)};
}

UsbipParsed<UsbipCommand> parse_submit(ByteSpan bytes) {
    UsbipSubmit submit;
    submit.sequence = word_at(bytes, 4);
    submit.device = word_at(bytes, 8);
    submit.to_host = word_at(bytes, 12) == 1;
    submit.endpoint = word_at(bytes, 16);
    submit.length = word_at(bytes, 24);
    submit.packets = static_cast<std::int32_t>(word_at(bytes, 32));
    if (submit.packets != 0 && submit.packets != -1)
        return mistaken<UsbipCommand>(
            fmt::format("a transfer of {} isochronous packets; expected none", word_at(bytes, 32)));
    if (submit.length > 0x7FFFFFFF || (!submit.to_host && submit.length > usbip_most_data))
        return mistaken<UsbipCommand>(
            fmt::format("a transfer of {} bytes; expected at most {}", submit.length, usbip_most_data));
    const std::size_t size = usbip_header_bytes + (submit.to_host ? 0 : submit.length);
    if (bytes.size() < size) return {};
    std::array<std::uint8_t, 8> setup{};
    std::copy_n(bytes.begin() + 40, setup.size(), setup.begin());
    submit.setup = parse_usb_setup(setup);
    submit.data.assign(bytes.begin() + usbip_header_bytes, bytes.begin() + static_cast<std::ptrdiff_t>(size));
    return {UsbipCommand(std::move(submit)), size, {}};
}

}  // namespace

UsbipParsed<UsbipRequest> parse_usbip_request(ByteSpan bytes) {
    // What is wrong already need not be waited for.
    if (bytes.size() >= 2 && number_at(bytes, 0, 2) != usbip_version)
        return mistaken<UsbipRequest>(
            fmt::format("version {:#06x}; expected {:#06x} of USB/IP", number_at(bytes, 0, 2), usbip_version));
    if (bytes.size() < 4) return {};
    const std::uint32_t code = number_at(bytes, 2, 2);
    if (code != request_list && code != request_import)
        return mistaken<UsbipRequest>(fmt::format("request {:#06x}; expected {:#06x} (list) or {:#06x} (import)", code,
                                                  request_list, request_import));
    const std::size_t size = request_bytes + (code == request_import ? bus_id_bytes : 0);
    if (bytes.size() < size) return {};
    if (code == request_list) return {UsbipRequest{UsbipRequest::Kind::device_list, {}}, size, {}};
    const ByteSpan id = bytes.subspan(request_bytes, bus_id_bytes);
    return {UsbipRequest{UsbipRequest::Kind::import, std::string(id.begin(), std::find(id.begin(), id.end(), 0))},
            size,
            {}};
}

UsbipParsed<UsbipCommand> parse_usbip_command(ByteSpan bytes) {
    if (bytes.size() < 4) return {};
    const std::uint32_t code = word_at(bytes, 0);
    if (code != command_submit && code != command_unlink)
        return mistaken<UsbipCommand>(
            fmt::format("command {:#010x}; expected 1 (submit) or 2 (unlink)", word_at(bytes, 0)));
    if (bytes.size() < usbip_header_bytes) return {};
    if (const std::uint32_t direction = word_at(bytes, 12); direction > 1)
        return mistaken<UsbipCommand>(fmt::format("direction {}; expected 0 (out) or 1 (in)", direction));
    if (code == command_submit) return parse_submit(bytes);
    return {
        UsbipCommand(UsbipUnlink{word_at(bytes, 4), word_at(bytes, 8), word_at(bytes, 20)}), usbip_header_bytes, {}};
}

Bytes usbip_device_list(const UsbipDevice* device) {
    Bytes bytes = reply_header(reply_list, 0);
    put_word(bytes, device == nullptr ? 0 : 1);
    if (device == nullptr) return bytes;
    put_device(bytes, *device);
    for (const auto& interface : device->interfaces) {
        bytes.insert(bytes.end(), interface.begin(), interface.end());
        bytes.push_back(0);
    }
    return bytes;
}

Bytes usbip_import_reply(UsbipImport result, const UsbipDevice& device) {
    Bytes bytes = reply_header(reply_import, static_cast<std::uint32_t>(result));
    if (result == UsbipImport::granted) put_device(bytes, device);
    return bytes;
}

Bytes usbip_submit_reply(const UsbipSubmit& submit, UsbipStatus status, std::uint32_t moved, ByteSpan data) {
    Bytes bytes = command_reply(reply_submit, submit.sequence, status);
    put_word(bytes, moved);
    put_word(bytes, 0);  // start frame
    put_word(bytes, static_cast<std::uint32_t>(submit.packets));
    bytes.resize(usbip_header_bytes, 0);
    bytes.insert(bytes.end(), data.begin(), data.end());
    return bytes;
}

Bytes usbip_unlink_reply(const UsbipUnlink& unlink, UsbipStatus status) {
    Bytes bytes = command_reply(reply_unlink, unlink.sequence, status);
    bytes.resize(usbip_header_bytes, 0);
    return bytes;
}

}  // namespace skyloop::inline wire
