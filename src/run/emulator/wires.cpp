#include "run/emulator/wires.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>

#include "base/core/words.hpp"
#include "run/client/open_client.hpp"
#include "wire/actuator/actuator_uri.hpp"
#include "wire/ntrip/ntrip_address.hpp"
#include "wire/transport/open_transport.hpp"

namespace skyloop::inline run {
namespace {

using firmware::BoardProfile;
using firmware::PortId;

std::vector<std::string_view> names_of(const std::vector<PortId>& ports) {
    std::vector<std::string_view> names;
    for (const PortId port : ports)
        names.push_back(firmware::port_names[static_cast<std::size_t>(port)]);
    return names;
}

// Where the name of the port ends; npos: there is none. A path may hold "=" too: it stands behind the colon of its
// scheme.
std::size_t end_of_name(std::string_view text) {
    const std::size_t equals = text.find('=');
    return equals != std::string_view::npos && text.substr(0, equals).find(':') == std::string_view::npos
               ? equals
               : std::string_view::npos;
}

// Without the name of its port.
std::string uri_of(const std::string& wire) {
    const std::size_t name = end_of_name(wire);
    return name == std::string::npos ? wire : wire.substr(name + 1);
}

bool leads_to_client(const std::string& wire) { return client_of_uri(uri_of(wire)).has_value(); }

// Devices such as /dev/null may be written to by all.
std::string place_of_file(const std::string& path) {
    if (path.empty() || path.starts_with("/dev/")) return {};
    return path == "-" ? path : std::filesystem::absolute(path).lexically_normal().string();
}

std::string place_of_server(const TcpAddress& address) {
    return address.port == 0 ? std::string() : fmt::format("{}:{}", address.host, address.port);
}

}  // namespace

WireEnd end_of_wire(const std::string& owner, const std::string& uri) {
    WireEnd end{owner, uri, {}};
    const auto parsed = parse_port_uri(uri);
    if (!parsed) return end;
    switch (parsed->kind) {
        case WireKind::pty:
        case WireKind::file:
            end.place = place_of_file(parsed->path);
            break;
        case WireKind::standard_output:
            end.place = "-";
            break;
        case WireKind::serial:
            end.place = place_of_device(parsed->serial.device).string();
            break;
        case WireKind::tcp:
        case WireKind::rfc2217:
        case WireKind::usbip:
            end.place = place_of_server(parsed->address);
            break;
        case WireKind::can:          // several nodes share a bus
        case WireKind::tcp_connect:  // a server may take several
        case WireKind::usb:          // of several alike, each takes its own
        case WireKind::hid:
            break;
    }
    return end;
}

WireEnd end_of_power(const std::string& owner, const std::string& uri) {
    WireEnd end{owner, uri, {}};
    const auto parsed = parse_actuator_uri(uri);
    if (!parsed) return end;
    if (const auto* line = std::get_if<ModemLineAddress>(&*parsed)) end.place = place_of_device(line->device).string();
    return end;
}

WireEnd end_of_output(const OutputSettings& output) {
    WireEnd end{"output", output.uri, {}};
    if (output.way == OutputWay::file) end.place = place_of_file(output.path);
    if (output.way == OutputWay::tcp_server) end.place = place_of_server(output.address);
    return end;
}

WireEnd end_of_state(const std::string& owner, const std::filesystem::path& file) {
    return {owner, file.string(), place_of_file(file.string())};
}

Result<void> check_ends(const std::vector<WireEnd>& ends) {
    for (std::size_t i = 0; i < ends.size(); ++i)
        for (std::size_t k = 0; k < i; ++k)
            if (!ends[i].place.empty() && ends[i].place == ends[k].place)
                return fail(ErrorCode::usage,
                            fmt::format("{}{} '{}' is where {} '{}' goes; expected another place", ends[i].told_at,
                                        ends[i].owner, ends[i].uri, ends[k].owner, ends[k].uri));
    return {};
}

firmware::PortId default_port(const BoardProfile& board) {
    const bool has_uart1 = std::find(board.ports.begin(), board.ports.end(), PortId::uart1) != board.ports.end();
    return has_uart1 || board.ports.empty() ? PortId::uart1 : board.ports.front();
}

UsbFace usb_face(const BoardProfile& board, PortId port) {
    if (port != PortId::usb || !board.usb) return {};
    const firmware::UsbDescription& usb = *board.usb;
    return {{usb.vendor_id, usb.product_id}, usb.release, usb.manufacturer, usb.product, usb.serial};
}

Result<PortId> port_of_board(std::string_view name, const BoardProfile& board) {
    const auto names = names_of(board.ports);
    const auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end())
        return fail(ErrorCode::usage, fmt::format("{} has no port '{}'{}; expected {}", board.name, name,
                                                  did_you_mean(name, names), fmt::join(names, ", ")));
    return board.ports[static_cast<std::size_t>(found - names.begin())];
}

Result<WireRequest> parse_wire(std::string_view text, const BoardProfile& board) {
    const std::size_t equals = end_of_name(text);
    const bool named = equals != std::string_view::npos;
    WireRequest wire{default_port(board), std::string(named ? text.substr(equals + 1) : text)};
    if (named) {
        const auto port = port_of_board(text.substr(0, equals), board);
        if (!port) return fail(ErrorCode::usage, fmt::format("port '{}': {}", text, port.error().message));
        wire.port = *port;
    }
    if (const auto client = client_of_uri(wire.uri)) {
        if (const auto known = check_client(*client); !known) return fail(known.error());
        return wire;
    }
    const auto uri = parse_port_uri(wire.uri);
    if (!uri) return fail(uri.error());
    if (uri->kind == WireKind::can && !board.name.empty() && board.maker != firmware::MakerKind::dronecan)
        return fail(ErrorCode::usage, fmt::format("port '{}': {} is not a node of a CAN bus; expected a board such as "
                                                  "dronecan-generic",
                                                  text, board.name));
    if (uri->baud && wire.port != PortId::uart1)
        return fail(ErrorCode::usage, fmt::format("port '{}': {} takes no speed; expected @BAUD at uart1 alone", text,
                                                  firmware::port_names[static_cast<std::size_t>(wire.port)]));
    const bool has_usb = std::find(board.ports.begin(), board.ports.end(), PortId::usb) != board.ports.end();
    if (uri->kind == WireKind::usbip && !named && has_usb) wire.port = PortId::usb;
    return wire;
}

Result<std::vector<WireRequest>> wires_of(const ReceiverEntry& entry, const BoardProfile& board) {
    std::vector<WireRequest> wires;
    if (entry.ports.empty()) wires.push_back({default_port(board), "pty"});
    for (const std::string& text : entry.ports) {
        auto wire = parse_wire(text, board);
        if (!wire) return fail(wire.error());
        wires.push_back(std::move(*wire));
    }
    return wires;
}

Result<std::optional<WireRequest>> corrections_of(const ReceiverEntry& entry, const BoardProfile& board) {
    if (entry.corrections.empty()) return std::nullopt;
    const std::size_t equals = end_of_name(entry.corrections);
    const bool named = equals != std::string::npos;
    WireRequest wire{default_port(board), uri_of(entry.corrections), true};
    if (const auto address = parse_ntrip_uri(wire.uri); !address)
        return fail(ErrorCode::usage, "corrections " + address.error().message);
    if (named) {
        const auto port = port_of_board(std::string_view(entry.corrections).substr(0, equals), board);
        if (!port) return fail(ErrorCode::usage, "corrections: " + port.error().message);
        wire.port = *port;
    }
    return wire;
}

std::optional<std::uint32_t> speed_of_wires(const ReceiverEntry& entry) {
    for (const std::string& wire : entry.ports)
        if (const auto uri = parse_port_uri(uri_of(wire)); uri && uri->baud) return uri->baud;
    return std::nullopt;
}

bool has_scripted_client(const Scenario& scenario) {
    return std::any_of(scenario.receivers.begin(), scenario.receivers.end(), [](const ReceiverEntry& receiver) {
        return std::any_of(receiver.ports.begin(), receiver.ports.end(), leads_to_client);
    });
}

void keep_scripted_clients(Scenario& scenario) {
    for (ReceiverEntry& receiver : scenario.receivers) {
        if (const auto speed = speed_of_wires(receiver)) receiver.baud = speed;
        std::erase_if(receiver.ports, [](const std::string& port) { return !leads_to_client(port); });
        if (receiver.ports.empty()) receiver.ports = {"file:/dev/null"};
    }
}

}  // namespace skyloop::inline run
