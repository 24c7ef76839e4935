#include "wire/usb/usb_address.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "base/core/number_in.hpp"

namespace skyloop {
namespace {

constexpr std::size_t id_digits = 4;
constexpr std::size_t ids_size = 2 * id_digits + 1;

}  // namespace

bool is_usb_port_path(std::string_view text) {
    const std::size_t dash = text.find('-');
    if (dash == 0 || dash == std::string_view::npos || dash + 1 == text.size()) return false;
    const auto digits = [](std::string_view part) {
        return !part.empty() && std::all_of(part.begin(), part.end(), [](char c) { return c >= '0' && c <= '9'; });
    };
    if (!digits(text.substr(0, dash))) return false;
    for (std::string_view rest = text.substr(dash + 1);;) {
        const std::size_t dot = rest.find('.');
        if (!digits(rest.substr(0, dot))) return false;
        if (dot == std::string_view::npos) return true;
        rest = rest.substr(dot + 1);
    }
}

std::string to_string(UsbIds ids) { return fmt::format("{:04x}:{:04x}", ids.vendor, ids.product); }

std::optional<UsbIds> parse_usb_ids(std::string_view text) {
    if (text.size() != ids_size || text[id_digits] != ':') return std::nullopt;
    const auto vendor = hexadecimal_number_in<std::uint16_t>(text.substr(0, id_digits));
    const auto product = hexadecimal_number_in<std::uint16_t>(text.substr(id_digits + 1));
    if (!vendor || !product) return std::nullopt;
    return UsbIds{*vendor, *product};
}

bool UsbAddress::matches(const UsbDeviceInfo& device) const {
    return device.ids == ids && (serial.empty() || device.serial == serial) &&
           (port_path.empty() || device.port_path == port_path);
}

Result<UsbAddress> parse_usb_address(std::string_view text) {
    const auto ids = parse_usb_ids(text.substr(0, ids_size));
    const std::string_view rest = ids ? text.substr(ids_size) : std::string_view();
    if (ids && rest.empty()) return UsbAddress{*ids, {}, {}};
    if (ids && rest.size() > 1 && rest.front() == ':') return UsbAddress{*ids, std::string(rest.substr(1)), {}};
    if (ids && rest.front() == '@' && is_usb_port_path(rest.substr(1)))
        return UsbAddress{*ids, {}, std::string(rest.substr(1))};
    return fail(ErrorCode::usage,
                fmt::format("'{}' names no USB device; expected VID:PID, VID:PID:SERIAL or VID:PID@PORT, such as "
                            "1546:01a8 or 1546:01a8@1-1.2",
                            text));
}

std::string to_string(const UsbAddress& address) {
    if (!address.serial.empty()) return to_string(address.ids) + ':' + address.serial;
    if (!address.port_path.empty()) return to_string(address.ids) + '@' + address.port_path;
    return to_string(address.ids);
}

}  // namespace skyloop
