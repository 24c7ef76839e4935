#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "base/core/number_text.hpp"
#include "base/core/words.hpp"
#include "run/feed/truth_feed.hpp"

namespace skyloop::inline run {
namespace {

// What stands behind a scheme's colon.
enum class AddressForm { listen, connect, device, relay };

// One kind of source.
struct FeedScheme {
    std::string_view name, dialect;
    FeedWire wire;
    AddressForm form;
    std::uint16_t port = 0;  // where none is given; zero: one must be
    std::uint32_t baud = 0;  // likewise
    bool from_target = false;
    std::uint16_t own_port = 0;
};

// Ports: FEEDS.md 3.3 to 3.13.
constexpr FeedScheme feed_schemes[] = {
    {"udp-json", "json", FeedWire::udp_listen, AddressForm::listen, 29990},
    {"tcp-json", "json", FeedWire::tcp_listen, AddressForm::listen, 29990},
    {"json-to", "json", FeedWire::tcp_connect, AddressForm::connect},
    {"flightgear", "flightgear", FeedWire::udp_listen, AddressForm::listen, 5503},
    {"flightgear-generic", "flightgear-generic", FeedWire::udp_listen, AddressForm::listen, 5561},
    // X-Plane answers from another port than it hears at ("port we send from", 49001).
    {"xplane", "xplane", FeedWire::udp_request, AddressForm::connect, 49000, 0, false, 49005},
    {"mavlink-udp", "mavlink", FeedWire::udp_listen, AddressForm::listen, 14550},
    {"mavlink-udpout", "mavlink", FeedWire::udp_connect, AddressForm::connect},
    {"mavlink-tcp", "mavlink", FeedWire::tcp_connect, AddressForm::connect, 5760},
    {"mavlink-serial", "mavlink", FeedWire::serial, AddressForm::device, 0, 57600},
    {"ardupilot-json", "ardupilot-json", FeedWire::udp_relay, AddressForm::relay, 0, 0, true},
    {"px4", "px4", FeedWire::tcp_relay, AddressForm::relay, 0, 0, true},
    {"betaflight", "betaflight", FeedWire::udp_relay, AddressForm::relay, 0, 0, false},
    {"gpsd", "gpsd", FeedWire::tcp_connect, AddressForm::connect, 2947},
    {"nmea-udp", "nmea", FeedWire::udp_listen, AddressForm::listen},
    {"nmea-tcp", "nmea", FeedWire::tcp_connect, AddressForm::connect},
    {"nmea-serial", "nmea", FeedWire::serial, AddressForm::device},
    {"ubx-udp", "ubx", FeedWire::udp_listen, AddressForm::listen},
    {"ubx-tcp", "ubx", FeedWire::tcp_connect, AddressForm::connect},
    {"ubx-serial", "ubx", FeedWire::serial, AddressForm::device},
    {"jsbsim", "jsbsim", FeedWire::tcp_listen, AddressForm::listen, 1138},
    {"jsbsim-udp", "jsbsim", FeedWire::udp_listen, AddressForm::listen, 1138},
};

std::string expected_form(const FeedScheme& scheme) {
    const std::string name(scheme.name);
    switch (scheme.form) {
        case AddressForm::listen:
            return name + (scheme.port != 0 ? ":[[HOST:]PORT]" : ":[HOST:]PORT");
        case AddressForm::connect:
            return name + (scheme.port != 0 ? ":HOST[:PORT]" : ":HOST:PORT");
        case AddressForm::device:
            return name + (scheme.baud != 0 ? ":DEVICE[@BAUD]" : ":DEVICE@BAUD");
        case AddressForm::relay:
            break;
    }
    return name + ":[HOST:]PORT,HOST:PORT";
}

struct HostPort {
    std::string host;
    std::optional<std::uint16_t> port;
};

// Letters, digits and what names, addresses and scopes have besides: no blanks, no control characters.
bool is_host(std::string_view text) {
    constexpr std::size_t longest = 253;  // of a name, RFC 1035 section 2.3.4
    return !text.empty() && text.size() <= longest && std::all_of(text.begin(), text.end(), [](char c) {
        return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '.' || c == '-' ||
               c == '_' || c == ':' || c == '%';
    });
}

// "HOST", "HOST:PORT", "[IPV6]", "[IPV6]:PORT"; "PORT" alone where `lone_port`.
std::optional<HostPort> host_and_port(std::string_view text, bool lone_port) {
    HostPort found;
    std::string_view host = text, port;
    bool has_port = false;
    if (text.starts_with('[')) {
        const std::size_t end = text.find(']');
        if (end == std::string_view::npos) return std::nullopt;
        host = text.substr(1, end - 1);
        const std::string_view rest = text.substr(end + 1);
        if (!rest.empty() && rest.front() != ':') return std::nullopt;
        has_port = !rest.empty();
        if (has_port) port = rest.substr(1);
    } else if (const std::size_t colon = text.find(':'); colon != std::string_view::npos) {
        host = text.substr(0, colon);
        port = text.substr(colon + 1);
        has_port = true;
    } else if (lone_port) {
        host = {};
        port = text;
        has_port = true;
    }
    if (has_port) found.port = number_in<std::uint16_t>(port);
    if (has_port && !found.port) return std::nullopt;
    const bool host_missing = host.empty() && !(lone_port && text.find(':') == std::string_view::npos);
    if (host_missing || (!host.empty() && !is_host(host))) return std::nullopt;
    found.host = host;
    return found;
}

bool read_listener(std::string_view text, std::uint16_t standard_port, FeedAddress& address) {
    address.port = standard_port;
    if (text.empty()) return standard_port != 0;
    const auto found = host_and_port(text, true);
    if (!found) return false;
    if (!found->host.empty()) address.host = found->host;
    if (!found->port && standard_port == 0) return false;
    address.port = found->port.value_or(standard_port);
    return true;
}

bool read_device(std::string_view text, std::uint32_t standard_baud, FeedAddress& address) {
    constexpr std::uint32_t slowest = 50, fastest = 12'000'000;  // as other serial addresses
    const std::size_t sign = text.rfind('@');
    address.host = text.substr(0, sign);
    address.baud = standard_baud;
    if (sign != std::string_view::npos) address.baud = number_in<std::uint32_t>(text.substr(sign + 1)).value_or(0);
    return !address.host.empty() && address.baud >= slowest && address.baud <= fastest &&
           std::none_of(address.host.begin(), address.host.end(), [](unsigned char c) { return c < ' '; });
}

bool read_rest(const FeedScheme& scheme, std::string_view text, FeedAddress& address) {
    switch (scheme.form) {
        case AddressForm::listen:
            return read_listener(text, scheme.port, address);
        case AddressForm::device:
            return read_device(text, scheme.baud, address);
        case AddressForm::connect: {
            const auto found = host_and_port(text, false);
            if (!found) return false;
            address.host = found->host;
            address.port = found->port.value_or(scheme.port);
            return address.port != 0;
        }
        case AddressForm::relay:
            break;
    }
    const std::size_t comma = text.find(',');
    if (comma == std::string_view::npos || !read_listener(text.substr(0, comma), 0, address)) return false;
    const auto target = host_and_port(text.substr(comma + 1), false);
    if (!target || target->port.value_or(0) == 0) return false;
    address.to_host = target->host;
    address.to_port = *target->port;
    return true;
}

// The addresses of a host, as far as no name server is needed.
std::vector<std::string> known_addresses(std::string_view called) {
    const std::string host = lower_case(called);
    if (host == "localhost" || host == "localhost.localdomain" || host.ends_with(".localhost"))
        return {"127.0.0.1", "::1"};
    if (host == "ip6-localhost" || host == "ip6-loopback") return {"::1"};
    return {host};
}

// Whether a listener at one address hears who calls the other, at the same port. A call to no address in particular
// goes to loopback; listeners at none in particular hear all, those of IPv6 both families.
bool hears_calls_to(const std::string& own, const std::string& called) {
    const bool four = called.starts_with("127.") || called == "0.0.0.0", six = called == "::1" || called == "::";
    if (own == called) return true;
    if (own == "0.0.0.0") return four;
    if (own == "::") return four || six;
    return (own == "127.0.0.1" && called == "0.0.0.0") || (own == "::1" && called == "::");
}

bool relays_to_itself(const FeedAddress& address) {
    if (address.to_host.empty() || address.to_port != address.port) return false;
    const std::vector<std::string> own = known_addresses(address.host), called = known_addresses(address.to_host);
    return std::any_of(own.begin(), own.end(), [&](const std::string& mine) {
        return std::any_of(called.begin(), called.end(),
                           [&](const std::string& theirs) { return hears_calls_to(mine, theirs); });
    });
}

// One line, whatever was written.
std::string quotable(std::string_view text) {
    constexpr std::size_t longest = 80;
    std::string shown(text.substr(0, longest));
    std::replace_if(
        shown.begin(), shown.end(), [](unsigned char c) { return c < ' ' || c > '~'; }, '?');
    return shown;
}

}  // namespace

Result<FeedAddress> parse_feed_address(std::string_view text) {
    const std::size_t colon = text.find(':');
    const std::string_view name = text.substr(0, colon);
    std::vector<std::string_view> names;
    for (const FeedScheme& scheme : feed_schemes) {
        names.push_back(scheme.name);
        if (scheme.name != name) continue;
        FeedAddress address;
        address.text = text;
        address.dialect = scheme.dialect;
        address.wire = scheme.wire;
        address.own_port = scheme.own_port;
        address.hears_target = scheme.from_target;
        const std::string_view rest = colon == std::string_view::npos ? std::string_view() : text.substr(colon + 1);
        const bool read = read_rest(scheme, rest, address);
        if (read && relays_to_itself(address))
            return fail(ErrorCode::usage,
                        fmt::format("'{}' relays to itself: it listens at port {}, to which it sends; "
                                    "expected another port or host behind the comma",
                                    quotable(text), address.port));
        if (read) return address;
        return fail(ErrorCode::usage, fmt::format("'{}' is no address of a live source; expected {}", quotable(text),
                                                  expected_form(scheme)));
    }
    const std::string meant = did_you_mean(name, names);
    return fail(ErrorCode::usage,
                fmt::format("'{}' is no kind of live source{}; expected SCHEME:ADDRESS with one of {}", quotable(name),
                            meant, fmt::join(names, ", ")));
}

}  // namespace skyloop::inline run
