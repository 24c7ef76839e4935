#include "wire/ntrip/ntrip_messages.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/parser.hpp>

#include "base/core/number_text.hpp"
#include "base/core/words.hpp"

namespace skyloop::inline wire {
namespace {

namespace http = boost::beast::http;

constexpr std::string_view alphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
constexpr std::string_view product = "NTRIP skyloop/1.0";  // both versions ask for "NTRIP" at the begin

void read_authorisation(std::string_view header, NtripRequest& request) {
    constexpr std::string_view basic = "basic ";
    const std::string_view text = trimmed(header);
    if (lower_case(text.substr(0, basic.size())) != basic) return;
    const auto pair = base64_decoded(trimmed(text.substr(basic.size())));
    const std::size_t colon = pair ? pair->find(':') : std::string::npos;
    if (colon == std::string::npos) return;
    request.user = pair->substr(0, colon);
    request.password = pair->substr(colon + 1);
}

std::string plain_head(std::string_view status_line, std::string_view type, std::size_t length) {
    return fmt::format("{}\r\nServer: {}\r\nContent-Type: {}\r\nContent-Length: {}\r\nConnection: close\r\n",
                       status_line, product, type, length);
}

}  // namespace

std::string base64(std::string_view bytes) {
    std::string text;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        unsigned group = 0;
        for (std::size_t k = 0; k < 3; ++k)
            group = group << 8U | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0U);
        for (std::size_t k = 0; k < 4; ++k)
            text += i + k > bytes.size() ? '=' : alphabet[group >> (18 - 6 * k) & 63U];
    }
    return text;
}

std::optional<std::string> base64_decoded(std::string_view text) {
    if (text.size() % 4 != 0) return std::nullopt;
    std::size_t padding = 0;
    while (padding < 2 && text.ends_with('=')) {
        text.remove_suffix(1);
        ++padding;
    }
    std::string bytes;
    unsigned group = 0, bits = 0;
    for (const char c : text) {
        const std::size_t value = alphabet.find(c);
        if (value == std::string_view::npos) return std::nullopt;
        group = (group << 6U | static_cast<unsigned>(value)) & 0xFFFFFFU;
        bits += 6;
        if (bits < 8) continue;
        bits -= 8;
        bytes += static_cast<char>(group >> bits & 0xFFU);
    }
    return bytes;
}

std::string ntrip_request_text(const NtripAddress& address, std::string_view mount, int version, std::string_view gga) {
    std::string text = fmt::format("GET /{} HTTP/1.{}\r\n", mount, version >= 2 ? 1 : 0);
    if (version >= 2) text += fmt::format("Host: {}\r\nNtrip-Version: Ntrip/2.0\r\n", shown_address(address.caster));
    text += fmt::format("User-Agent: {}\r\n", product);
    if (!address.user.empty())
        text += fmt::format("Authorization: Basic {}\r\n", base64(address.user + ":" + address.password));
    if (version >= 2 && !gga.empty()) text += fmt::format("Ntrip-GGA: {}\r\n", gga);
    return text + "Connection: close\r\n\r\n";
}

std::optional<NtripRequest> parse_ntrip_request(std::string_view head) {
    http::request_parser<http::empty_body> parser;
    parser.header_limit(longest_ntrip_head);
    parser.skip(true);  // what follows the head is lines that tell where a client is
    boost::system::error_code error;
    parser.put(boost::asio::buffer(head), error);
    if (error || !parser.is_header_done()) return std::nullopt;
    const auto& message = parser.get();
    NtripRequest request;
    request.method = std::string(message.method_string());
    const std::string_view target(message.target().data(), message.target().size());
    if (!target.starts_with('/')) return std::nullopt;
    request.mount = target.substr(1, target.find('?') == std::string_view::npos ? target.size() : target.find('?') - 1);
    const auto value = [&](std::string_view name) {
        const auto found = message[boost::string_view(name.data(), name.size())];
        return std::string_view(found.data(), found.size());
    };
    request.version = lower_case(trimmed(value("Ntrip-Version"))) == "ntrip/2.0" ? 2 : 1;
    request.chunked = request.version == 2 && message.version() >= 11;
    request.gga = trimmed(value("Ntrip-GGA"));
    read_authorisation(value("Authorization"), request);
    return request;
}

std::string ntrip_stream_answer(const NtripRequest& request) {
    if (request.version < 2) return "ICY 200 OK\r\n\r\n";
    return fmt::format(
        "HTTP/1.1 200 OK\r\nNtrip-Version: Ntrip/2.0\r\nServer: {}\r\nCache-Control: no-store\r\nPragma: no-cache\r\n"
        "Connection: close\r\nContent-Type: gnss/data\r\n{}\r\n",
        product, request.chunked ? "Transfer-Encoding: chunked\r\n" : "");
}

std::string ntrip_table_answer(const NtripRequest& request, std::string_view table) {
    std::string head = request.version < 2 ? plain_head("SOURCETABLE 200 OK", "text/plain", table.size())
                                           : plain_head("HTTP/1.1 200 OK", "gnss/sourcetable", table.size());
    if (request.version >= 2) head += "Ntrip-Version: Ntrip/2.0\r\n";
    return head + "\r\n" + std::string(table);
}

std::string ntrip_missing_answer(const NtripRequest& request, std::string_view table) {
    return request.version < 2
               ? ntrip_table_answer(request, table)
               : ntrip_refusal(404, "Not Found", "no such mount point; GET / lists those that there are");
}

std::string ntrip_password_answer(const NtripRequest& request) {
    constexpr std::string_view sentence = "ERROR - Bad Password\r\n";
    std::string head = plain_head(request.version < 2 ? "HTTP/1.0 401 Unauthorized" : "HTTP/1.1 401 Unauthorized",
                                  "text/plain", sentence.size());
    if (request.version >= 2) head += "Ntrip-Version: Ntrip/2.0\r\n";
    return head + "WWW-Authenticate: Basic realm=\"skyloop\"\r\n\r\n" + std::string(sentence);
}

std::string ntrip_refusal(int status, std::string_view reason, std::string_view sentence) {
    const std::string body = fmt::format("ERROR - {}\r\n", sentence);
    return plain_head(fmt::format("HTTP/1.1 {} {}", status, reason), "text/plain", body.size()) +
           "Ntrip-Version: Ntrip/2.0\r\n\r\n" + body;
}

std::string ntrip_chunk(std::string_view bytes) { return fmt::format("{:x}\r\n{}\r\n", bytes.size(), bytes); }

bool same_password(std::string_view given, std::string_view wanted) {
    auto difference = static_cast<unsigned>(given.size() != wanted.size());
    for (std::size_t i = 0; i < given.size(); ++i)
        difference |= static_cast<unsigned char>(given[i] ^ (wanted.empty() ? '\0' : wanted[i % wanted.size()]));
    return difference == 0;
}

bool is_position_sentence(std::string_view line) {
    constexpr std::size_t shortest = 10, id_end = 6;
    if (line.size() < shortest || line.front() != '$' || line.substr(3, 3) != "GGA") return false;
    const std::size_t star = line.rfind('*');
    if (star == std::string_view::npos || star < id_end) return false;
    unsigned sum = 0;
    for (const char c : line.substr(1, star - 1))
        sum ^= static_cast<unsigned char>(c);
    const std::string_view digits = line.substr(star + 1);
    if (digits.size() != 2 || hexadecimal_number_in<unsigned>(digits) != sum) return false;
    // $..GGA,time,latitude,N,longitude,E,…
    std::array<std::string_view, 6> fields;
    std::string_view rest = line.substr(0, star);
    for (std::string_view& field : fields) {
        const std::size_t comma = rest.find(',');
        field = rest.substr(0, comma);
        rest.remove_prefix(comma == std::string_view::npos ? rest.size() : comma + 1);
    }
    return std::none_of(fields.begin() + 2, fields.end(), [](std::string_view field) { return field.empty(); });
}

}  // namespace skyloop::inline wire
