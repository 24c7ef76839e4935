#include "wire/ntrip/ntrip_address.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "base/core/number_text.hpp"

namespace skyloop::inline wire {
namespace {

constexpr std::string_view shape = "ntrip://[USER:PASSWORD@]HOST[:PORT]/MOUNT";

// Nothing for a "%" without two hexadecimal digits behind it.
std::optional<std::string> percent_decoded(std::string_view text) {
    std::string decoded;
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (text[i] != '%') {
            decoded += text[i];
            continue;
        }
        const std::string_view digits = text.substr(i + 1, 2);
        const auto byte = hexadecimal_number_in<unsigned>(digits);
        if (digits.size() != 2 || !byte) return std::nullopt;
        decoded += static_cast<char>(*byte);
        i += 2;
    }
    return decoded;
}

// All but what RFC 3986, section 2.3, leaves as it is.
std::string percent_encoded(std::string_view text) {
    std::string encoded;
    for (const char c : text) {
        const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                           std::string_view("-._~").find(c) != std::string_view::npos;
        encoded += plain ? std::string(1, c) : fmt::format("%{:02X}", static_cast<unsigned char>(c));
    }
    return encoded;
}

// What would end a line or a word of a request.
bool fits_a_header(std::string_view text) {
    return std::all_of(text.begin(), text.end(),
                       [](char c) { return static_cast<unsigned char>(c) >= 0x20 && c != 0x7F; });
}

bool fits_a_target(std::string_view text) {
    return std::all_of(text.begin(), text.end(), [](char c) { return c > 0x20 && c < 0x7F && c != '/' && c != ';'; });
}

// Where user and password end: the last "@" before the path. npos: there are none.
std::size_t end_of_secrets(std::string_view authority) { return authority.rfind('@'); }

Result<void> read_user(std::string_view text, NtripAddress& address) {
    const std::size_t colon = text.find(':');
    const auto user = percent_decoded(text.substr(0, colon));
    const auto password =
        colon == std::string_view::npos ? std::optional<std::string>("") : percent_decoded(text.substr(colon + 1));
    if (!user || !password) return fail(ErrorCode::usage, "user or password has a '%' without two hexadecimal digits");
    if (user->empty() || user->find(':') != std::string::npos || !fits_a_header(*user) || !fits_a_header(*password))
        return fail(ErrorCode::usage,
                    "user or password cannot be sent; expected a user without ':' and no control characters");
    address.user = *user;
    address.password = *password;
    return {};
}

Result<void> read_host(std::string_view text, NtripAddress& address) {
    std::string_view host = text;
    const std::size_t bracket = text.rfind(']');
    const std::size_t colon = text.rfind(':');
    if (colon != std::string_view::npos && (bracket == std::string_view::npos || colon > bracket)) {
        host = text.substr(0, colon);
        const auto port = number_in<std::uint16_t>(text.substr(colon + 1));
        if (!port || *port == 0) return fail(ErrorCode::usage, "the port is no number from 1 to 65535");
        address.caster.port = *port;
    }
    if (host.size() > 2 && host.front() == '[' && host.back() == ']') host = host.substr(1, host.size() - 2);
    if (host.empty() || !fits_a_target(host)) return fail(ErrorCode::usage, "the host is missing");
    address.caster.host = host;
    return {};
}

}  // namespace

std::string without_secrets(std::string_view uri) {
    const std::size_t scheme = uri.find("://");
    const std::size_t begin = scheme == std::string_view::npos ? 0 : scheme + 3;
    const std::size_t at = end_of_secrets(uri.substr(begin));
    if (at == std::string_view::npos) return std::string(uri);
    return std::string(uri.substr(0, begin)) + std::string(uri.substr(begin + at + 1));
}

std::string shown_uri(const NtripAddress& address) {
    return fmt::format("{}://{}/{}", address.tls ? "ntrips" : "ntrip", shown_address(address.caster),
                       percent_encoded(address.mount));
}

Result<NtripAddress> parse_ntrip_uri(std::string_view text) {
    const auto refused = [&](std::string_view what) {
        return fail(ErrorCode::usage, fmt::format("'{}': {}; expected {}", without_secrets(text), what, shape));
    };
    NtripAddress address;
    constexpr std::string_view plain = "ntrip://", secure = "ntrips://";
    address.tls = text.starts_with(secure);
    if (!address.tls && !text.starts_with(plain)) return refused("is no address of a caster");
    if (address.tls) address.caster.port = ntrips_port;
    std::string_view rest = text.substr(address.tls ? secure.size() : plain.size());
    const std::size_t at = end_of_secrets(rest);
    if (at != std::string_view::npos) {
        if (const auto read = read_user(rest.substr(0, at), address); !read) return refused(read.error().message);
        rest.remove_prefix(at + 1);
    }
    const std::size_t slash = rest.find('/');
    if (const auto read = read_host(rest.substr(0, slash), address); !read) return refused(read.error().message);
    const auto mount = percent_decoded(slash == std::string_view::npos ? std::string_view() : rest.substr(slash + 1));
    if (!mount || mount->empty()) return refused("the mount point is missing");
    if (!fits_a_target(*mount)) return refused("the mount point cannot be sent");
    address.mount = *mount;
    return address;
}

}  // namespace skyloop::inline wire
