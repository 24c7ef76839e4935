// Requests, and who may ask: the checks before anything of one is done.
#include "run/control/control_request.hpp"

#include <fmt/format.h>
#include <boost/asio/ip/address_v6.hpp>

#include <algorithm>

#include "base/core/words.hpp"
#include "detail/control_json.hpp"

namespace skyloop::inline run {
namespace {

bool same_header(std::string_view a, std::string_view b) {
    return a.size() == b.size() && lower_case(a) == lower_case(b);
}

}  // namespace

std::optional<std::string_view> ControlRequest::header(std::string_view name) const {
    std::optional<std::string_view> found;
    for (const auto& [key, value] : headers) {
        if (!same_header(key, name)) continue;
        if (found) return std::nullopt;
        found = value;
    }
    return found.value_or(std::string_view());
}

void ControlRequest::take_absolute_form() {
    constexpr std::string_view scheme = "http://";
    if (lower_case(std::string_view(target).substr(0, scheme.size())) != scheme) return;
    const std::size_t end = std::min(target.find_first_of("/?", scheme.size()), target.size());
    std::string host = target.substr(scheme.size(), end - scheme.size());
    target.erase(0, end);
    if (!target.starts_with('/')) target.insert(0, "/");
    std::erase_if(headers, [](const auto& one) { return same_header(one.first, "Host"); });
    headers.emplace_back("Host", std::move(host));
}

std::string_view ControlRequest::path() const { return std::string_view(target).substr(0, target.find('?')); }

std::optional<std::string_view> ControlRequest::query(std::string_view key) const {
    const std::size_t mark = target.find('?');
    if (mark == std::string::npos) return std::nullopt;
    std::string_view left = std::string_view(target).substr(mark + 1);
    while (!left.empty()) {
        const std::string_view pair = left.substr(0, left.find('&'));
        left.remove_prefix(std::min(pair.size() + 1, left.size()));
        const std::size_t equals = pair.find('=');
        if (pair.substr(0, equals) == key)
            return equals == std::string_view::npos ? std::string_view() : pair.substr(equals + 1);
    }
    return std::nullopt;
}

ControlResponse error_response(int status, std::string_view sentence, HeaderList headers) {
    ControlResponse response;
    response.status = status;
    response.body = json_text({{"error", sentence}});
    response.headers = std::move(headers);
    return response;
}

namespace {

// "[::1]:8080" is "[::1]".
std::string_view without_port(std::string_view host) {
    if (host.starts_with('[')) return host.substr(0, host.find(']') + 1);
    return host.substr(0, host.find(':'));
}

bool is_ipv4(std::string_view host) {
    return !host.empty() && std::count(host.begin(), host.end(), '.') == 3 &&
           std::all_of(host.begin(), host.end(), [](char c) { return c == '.' || (c >= '0' && c <= '9'); });
}

// However it is written: [::1], [0:0:0:0:0:0:0:1].
bool is_ipv6_loopback(std::string_view host) {
    if (!host.starts_with('[') || !host.ends_with(']')) return false;
    boost::system::error_code no_address;
    const std::string inside(host.substr(1, host.size() - 2));
    return boost::asio::ip::make_address_v6(inside, no_address).is_loopback();
}

// A name can be made to lead anywhere by whoever owns it; an address cannot. Case and the dot of the root change no
// name (RFC 9110, section 4.2.3; RFC 1034, section 3.1).
bool host_is_ours(std::string_view header, const AccessRules& rules) {
    std::string host = lower_case(without_port(header));
    if (host.size() > 1 && host.ends_with('.')) host.pop_back();
    if (host.empty()) return false;
    if (host == "localhost" || is_ipv6_loopback(host) || (is_ipv4(host) && host.starts_with("127."))) return true;
    if (host == lower_case(rules.host)) return true;
    return !rules.loopback && (is_ipv4(host) || (host.starts_with('[') && host.ends_with(']')));
}

// As long for a wrong token as for the right one, wherever the first difference stands.
bool same_secret(std::string_view given, std::string_view wanted) {
    if (given.size() != wanted.size()) return false;
    unsigned difference = 0;
    for (std::size_t i = 0; i < given.size(); ++i)
        difference |= static_cast<unsigned char>(given[i] ^ wanted[i]);
    return difference == 0;
}

bool shows_token(const ControlRequest& request, const std::string& token) {
    constexpr std::string_view bearer = "bearer ", subprotocol = "bearer.";
    const std::string_view authorization = without_blanks(request.header("Authorization").value_or(""));
    if (lower_case(authorization.substr(0, bearer.size())) == bearer)
        return same_secret(without_blanks(authorization.substr(bearer.size())), token);
    std::string_view list = request.header("Sec-WebSocket-Protocol").value_or("");
    while (!list.empty()) {
        std::string_view word = list.substr(0, list.find(','));
        list.remove_prefix(std::min(word.size() + 1, list.size()));
        while (word.starts_with(' '))
            word.remove_prefix(1);
        if (word.starts_with(subprotocol)) return same_secret(word.substr(subprotocol.size()), token);
    }
    return false;
}

// Off loopback a machine has names of its own. A page of a foreign one that leads here does not know the token, and
// what is not below /api is no secret.
bool any_name_will_do(const ControlRequest& request, const AccessRules& rules) {
    if (rules.loopback || rules.token.empty()) return false;
    return !request.path().starts_with("/api/") || shows_token(request, rules.token);
}

}  // namespace

std::optional<ControlResponse> refusal(const ControlRequest& request, const AccessRules& rules) {
    const auto host = request.header("Host");
    if (!host) return error_response(400, "the request has several headers Host; expected one");
    // HTTP/1.0 has none, and no browser speaks that.
    if (host->empty() && request.version >= 11)
        return error_response(400, "the request has no header Host; expected one");
    if (!host->empty() && !host_is_ours(*host, rules) && !any_name_will_do(request, rules))
        return error_response(421, fmt::format("the request is for host '{}'; expected {}", *host,
                                               rules.loopback ? "127.0.0.1 or localhost"
                                                              : "an address, " + rules.host + " or the token"));
    const auto origin = request.header("Origin");
    if (!origin || (!origin->empty() && *origin != fmt::format("http://{}", *host)))
        return error_response(403, fmt::format("a page of '{}' may not ask; expected one of http://{}",
                                               origin.value_or("several"), *host));
    if (rules.token.empty() || !request.path().starts_with("/api/") || shows_token(request, rules.token))
        return std::nullopt;
    return error_response(401, "no token, or a wrong one; expected the header 'Authorization: Bearer TOKEN'",
                          {{"WWW-Authenticate", "Bearer"}});
}

}  // namespace skyloop::inline run
