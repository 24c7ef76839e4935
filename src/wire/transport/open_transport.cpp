#include "wire/transport/open_transport.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "base/core/words.hpp"
#include "detail/line_settings.hpp"
#include "wire/hid/cp2110.hpp"
#include "wire/transport/file.hpp"
#include "wire/transport/pty.hpp"
#include "wire/transport/rfc2217.hpp"
#include "wire/transport/tcp_client.hpp"
#include "wire/transport/usbip_server.hpp"
#include "wire/usb/cdc_acm.hpp"

namespace skyloop::inline wire {
namespace {

struct Scheme {
    std::string_view name;
    WireKind kind;
    std::string_view shape;  // as it is offered
    std::string_view rest;   // what stands behind the colon
};
constexpr std::array<Scheme, 10> schemes{
    {{"pty", WireKind::pty, "pty[:LINK]", "a path"},
     {"serial", WireKind::serial, "serial:DEVICE[@BAUD]", "a device"},
     {"usb", WireKind::usb, "usb:VID:PID[:SERIAL]", "a device"},
     {"hid", WireKind::hid, "hid:VID:PID[:SERIAL]", "a device"},
     {"usbip", WireKind::usbip, "usbip:[HOST:]PORT", "a port"},
     {"tcp", WireKind::tcp, "tcp:[HOST:]PORT[@BAUD]", "a port"},
     {"tcp-connect", WireKind::tcp_connect, "tcp-connect:HOST:PORT[@BAUD]", "a host and its port"},
     {"rfc2217", WireKind::rfc2217, "rfc2217:[HOST:]PORT", "a port"},
     {"dronecan", WireKind::can, "dronecan:BUS", "a bus"},
     {"file", WireKind::file, "file:PATH", "a path"}}};

std::string offered() {
    std::string text;
    for (const Scheme& scheme : schemes)
        text += fmt::format("{}, ", scheme.shape);
    return text + "client:NAME or -";
}

// What is meant by an address without its kind: a device, a port of TCP, the name of a pseudo-terminal. Empty: nobody
// can tell.
std::string with_its_scheme(std::string_view text) {
    constexpr std::string_view digits = "0123456789", devices = "/dev/";
    const std::size_t colon = text.rfind(':');
    const std::string_view host = text.substr(0, colon == std::string_view::npos ? 0 : colon);
    const std::string_view port = text.substr(colon == std::string_view::npos ? 0 : colon + 1);
    if (text.empty()) return {};
    if (text.starts_with(devices)) return fmt::format("serial:{}", text);
    if (text.starts_with("tty")) return fmt::format("serial:{}{}", devices, text);
    const bool is_port = !port.empty() && port.find_first_not_of(digits) == std::string_view::npos;
    const bool is_host = host.empty() || host == "localhost" || host.find('.') != std::string_view::npos;
    if (is_port && is_host) return fmt::format("tcp:{}", host.empty() ? port : text);
    return colon == std::string_view::npos ? fmt::format("pty:{}", text) : std::string();
}

Error no_such_kind(std::string_view uri, std::string_view name) {
    std::array<std::string_view, schemes.size()> names;
    std::transform(schemes.begin(), schemes.end(), names.begin(), [](const Scheme& known) { return known.name; });
    const std::string near_by = did_you_mean(name, names), whole = with_its_scheme(uri);
    const std::string problem = fmt::format("port '{}': no such kind of port", uri);
    if (near_by.empty() && !whole.empty())
        return {ErrorCode::usage, fmt::format("{}; did you mean '{}'?", problem, whole)};
    return {ErrorCode::usage, fmt::format("{}{}; expected {}", problem, near_by, offered())};
}

// The control model of USB knows no RTS/CTS; a device that has it decides for itself.
Result<UsbBridgeAddress> parse_bridge(WireKind kind, std::string_view rest) {
    auto bridge = parse_usb_bridge_address(rest);
    if (bridge && kind == WireKind::usb && bridge->format.rtscts)
        return fail(ErrorCode::usage, "a CDC-ACM device takes no rtscts");
    return bridge;
}

Result<TcpAddress> parse_network(WireKind kind, std::string_view rest) {
    auto address = parse_tcp_address(rest);
    if (address && kind == WireKind::tcp_connect && (rest.find(':') == std::string_view::npos || address->port == 0))
        return fail(
            ErrorCode::usage,
            "whom to call is missing; expected tcp-connect:HOST:PORT, the port from 1 to 65535, an IPv6 address "
            "in brackets");
    return address;
}

// A socket has no speed; what stands behind the address is the one that the receiver has been given.
Result<std::optional<std::uint32_t>> split_speed(std::string_view& address) {
    const std::size_t at = address.rfind('@');
    if (at == std::string_view::npos) return std::optional<std::uint32_t>();
    const std::string_view text = address.substr(at + 1);
    address = address.substr(0, at);
    if (const auto baud = read_baud(text)) return baud;
    return fail(ErrorCode::usage, fmt::format("the speed '{}' is not understood; expected ADDRESS@BAUD, {} to {}", text,
                                              lowest_baud, highest_baud));
}

template <class Part>
Result<void> take(Result<Part> read, Part& part) {
    if (!read) return fail(read.error());
    part = std::move(*read);
    return {};
}

// @param rest of the URI, behind its scheme; not empty
Result<void> read_rest(std::string_view rest, PortUri& port) {
    switch (port.kind) {
        case WireKind::serial:
            return take(parse_serial_address(rest), port.serial);
        case WireKind::usb:
        case WireKind::hid:
            return take(parse_bridge(port.kind, rest), port.bridge);
        case WireKind::tcp:
        case WireKind::tcp_connect:
            if (auto baud = take(split_speed(rest), port.baud); !baud) return baud;
            [[fallthrough]];
        case WireKind::usbip:
        case WireKind::rfc2217:
            return take(parse_network(port.kind, rest), port.address);
        case WireKind::can:
            return take(parse_can_address(rest), port.can);
        case WireKind::pty:
        case WireKind::file:
        case WireKind::standard_output:
            break;
    }
    port.path = rest;
    return {};
}

template <class Wire>
Result<std::unique_ptr<Transport>> as_transport(Result<std::unique_ptr<Wire>> wire) {
    if (!wire) return fail(wire.error());
    return std::unique_ptr<Transport>(std::move(*wire));
}

Result<std::unique_ptr<Transport>> open_node(const CanAddress& address, std::string_view uri, CanBuses* buses) {
    CanBuses own;
    auto bus = (buses == nullptr ? own : *buses).open(address, std::string(uri));
    if (!bus) return fail(bus.error());
    return std::unique_ptr<Transport>(std::make_unique<CanTransport>(std::move(*bus)));
}

}  // namespace

std::vector<std::string_view> port_shapes() {
    std::vector<std::string_view> shapes;
    for (const Scheme& scheme : schemes)
        shapes.push_back(scheme.shape);
    return shapes;
}

Result<PortUri> parse_port_uri(std::string_view uri) {
    PortUri port;
    if (uri == "-") return port.kind = WireKind::standard_output, port;
    const std::size_t colon = uri.find(':');
    const std::string_view name = uri.substr(0, colon);
    const auto scheme =
        std::find_if(schemes.begin(), schemes.end(), [&](const Scheme& known) { return known.name == name; });
    if (scheme == schemes.end()) return fail(no_such_kind(uri, name));
    port.kind = scheme->kind;
    if (colon == std::string_view::npos && port.kind == WireKind::pty) return port;
    const std::string_view rest = colon == std::string_view::npos ? std::string_view() : uri.substr(colon + 1);
    if (rest.empty())
        return fail(ErrorCode::usage,
                    fmt::format("port '{}': {} is missing; expected {}", uri, scheme->rest, offered()));
    if (const auto read = read_rest(rest, port); !read)
        return fail(read.error().code, fmt::format("port '{}': {}", uri, read.error().message));
    return port;
}

Result<std::unique_ptr<Transport>> open_transport(std::string_view uri, const UsbFace& face, CanBuses* buses) {
    const auto port = parse_port_uri(uri);
    if (!port) return fail(port.error());
    switch (port->kind) {
        case WireKind::pty:
            return as_transport(port->path.empty() ? PtyTransport::open() : PtyTransport::open(port->path));
        case WireKind::serial:
            return as_transport(SerialTransport::open(port->serial));
        case WireKind::usb:
            return as_transport(UsbBridgeTransport::open(port->bridge, open_cdc_acm, "usb"));
        case WireKind::hid:
            return as_transport(UsbBridgeTransport::open(
                port->bridge, [](const auto& device, const auto& line) { return open_cp2110(device, line); }, "hid"));
        case WireKind::usbip:
            return as_transport(UsbipTransport::listen(port->address, face));
        case WireKind::tcp:
            return as_transport(TcpTransport::listen(port->address));
        case WireKind::tcp_connect:
            return as_transport(TcpClientTransport::open(port->address));
        case WireKind::rfc2217:
            return as_transport(Rfc2217Transport::listen(port->address));
        case WireKind::can:
            return open_node(port->can, uri, buses);
        case WireKind::file:
            return as_transport(FileTransport::open(port->path));
        case WireKind::standard_output:
            break;
    }
    return std::unique_ptr<Transport>(FileTransport::standard_output());
}

}  // namespace skyloop::inline wire
