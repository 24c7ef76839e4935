#include "skyloop/transport/open_transport.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "skyloop/base/spelling.hpp"
#include "skyloop/transport/file.hpp"
#include "skyloop/transport/pty.hpp"
#include "skyloop/transport/rfc2217.hpp"
#include "skyloop/transport/tcp_client.hpp"

namespace skyloop {
namespace {

constexpr std::string_view offered =
    "pty[:LINK], serial:DEVICE[@BAUD], tcp:[HOST:]PORT, tcp-connect:HOST:PORT, rfc2217:[HOST:]PORT, file:PATH, "
    "client:NAME or -";
constexpr std::array<std::string_view, 6> known_schemes{"pty", "serial", "tcp", "tcp-connect", "rfc2217", "file"};
constexpr std::array<std::string_view, 3> later_schemes{"usbip", "usb", "hid"};

std::string_view missing_part(std::string_view scheme) {
    if (scheme == "tcp" || scheme == "rfc2217") return "a port";
    if (scheme == "tcp-connect") return "a host and its port";
    return scheme == "serial" ? "a device" : "a path";
}

std::optional<WireKind> network_kind(std::string_view scheme) {
    if (scheme == "tcp") return WireKind::tcp;
    if (scheme == "tcp-connect") return WireKind::tcp_connect;
    if (scheme == "rfc2217") return WireKind::rfc2217;
    return std::nullopt;
}

// @param rest of the URI, behind its scheme
Result<PortUri> network_uri(WireKind kind, std::string_view uri, std::string_view rest) {
    auto address = parse_tcp_address(rest);
    if (!address) return fail(address.error().code, fmt::format("port '{}': {}", uri, address.error().message));
    const bool calls = kind == WireKind::tcp_connect;
    if (calls && (rest.find(':') == std::string_view::npos || address->port == 0))
        return fail(ErrorCode::usage, fmt::format("port '{}': whom to call is missing; expected tcp-connect:HOST:PORT, "
                                                  "the port from 1 to 65535, an IPv6 address in brackets",
                                                  uri));
    return PortUri{kind, {}, std::move(*address), {}};
}

template <class Wire>
Result<std::unique_ptr<Transport>> as_transport(Result<std::unique_ptr<Wire>> wire) {
    if (!wire) return fail(wire.error());
    return std::unique_ptr<Transport>(std::move(*wire));
}

}  // namespace

Result<PortUri> parse_port_uri(std::string_view uri) {
    if (uri == "-") return PortUri{WireKind::standard_output, {}, {}, {}};
    const std::size_t colon = uri.find(':');
    const std::string_view scheme = uri.substr(0, colon);
    const bool has_rest = colon != std::string_view::npos;
    const std::string_view rest = has_rest ? uri.substr(colon + 1) : std::string_view();
    if (scheme == "pty" && !has_rest) return PortUri{WireKind::pty, {}, {}, {}};
    if (scheme == "pty" && !rest.empty()) return PortUri{WireKind::pty, std::string(rest), {}, {}};
    if (const auto kind = network_kind(scheme); kind && !rest.empty()) return network_uri(*kind, uri, rest);
    if (scheme == "serial" && !rest.empty()) {
        auto serial = parse_serial_address(rest);
        if (!serial) return fail(serial.error().code, fmt::format("port '{}': {}", uri, serial.error().message));
        return PortUri{WireKind::serial, {}, {}, std::move(*serial)};
    }
    if (scheme == "file" && !rest.empty()) return PortUri{WireKind::file, std::string(rest), {}, {}};
    if (std::find(known_schemes.begin(), known_schemes.end(), scheme) != known_schemes.end())
        return fail(ErrorCode::usage,
                    fmt::format("port '{}': {} is missing; expected {}", uri, missing_part(scheme), offered));
    if (has_rest && std::find(later_schemes.begin(), later_schemes.end(), scheme) != later_schemes.end())
        return fail(ErrorCode::usage,
                    fmt::format("port '{}': {}: is not supported by this version; expected {}", uri, scheme, offered));
    return fail(ErrorCode::usage, fmt::format("port '{}': no such kind of port{}; expected {}", uri,
                                              did_you_mean(scheme, known_schemes), offered));
}

Result<std::unique_ptr<Transport>> open_transport(std::string_view uri) {
    const auto port = parse_port_uri(uri);
    if (!port) return fail(port.error());
    switch (port->kind) {
        case WireKind::pty:
            return as_transport(port->path.empty() ? PtyTransport::open() : PtyTransport::open(port->path));
        case WireKind::serial:
            return as_transport(SerialTransport::open(port->serial));
        case WireKind::tcp:
            return as_transport(TcpTransport::listen(port->address));
        case WireKind::tcp_connect:
            return as_transport(TcpClientTransport::open(port->address));
        case WireKind::rfc2217:
            return as_transport(Rfc2217Transport::listen(port->address));
        case WireKind::file:
            return as_transport(FileTransport::open(port->path));
        case WireKind::standard_output:
            break;
    }
    return std::unique_ptr<Transport>(FileTransport::standard_output());
}

}  // namespace skyloop
