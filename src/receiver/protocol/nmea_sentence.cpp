#include "receiver/protocol/nmea_sentence.hpp"

#include <fmt/compile.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/core/number_text.hpp"

namespace skyloop::inline receiver {
namespace {

bool printable(char c) { return c >= 0x20 && c <= 0x7e; }

// The value of a hexadecimal digit, or −1.
int hex_digit(char c) {
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'A' && c <= 'F') return c - 'A' + 10;
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    return -1;
}

// What may be shown of a line that is in error.
std::string quoted(std::string_view line) {
    std::string shown;
    for (const char c : line.substr(0, 40))
        shown += printable(c) ? c : '?';
    return "'" + shown + (line.size() > 40 ? "…'" : "'");
}

}  // namespace

std::uint8_t nmea_checksum(std::string_view body) {
    std::uint8_t sum = 0;
    for (const char c : body)
        sum = static_cast<std::uint8_t>(sum ^ static_cast<std::uint8_t>(c));
    return sum;
}

std::string fixed_decimals(double value, int decimals) {
    if (!std::isfinite(value)) return {};
    std::string text;
    append_fixed(text, value, decimals);
    if (text.front() == '-' && text.find_first_of("123456789") == std::string::npos) text.erase(0, 1);
    return text;
}

Sentence& Sentence::text(std::string_view field) {
    body_ += ',';
    body_ += field;
    return *this;
}

Sentence& Sentence::number(int value, int digits) {
    body_ += ',';
    append_padded(body_, value, digits);
    return *this;
}

Sentence& Sentence::empty(int count) {
    body_.append(static_cast<std::size_t>(count), ',');
    return *this;
}

std::string Sentence::finish() const { return fmt::format(FMT_COMPILE("${}*{:02X}\r\n"), body_, nmea_checksum(body_)); }

std::string_view SentenceView::talker() const { return address.substr(0, address.starts_with('P') ? 1 : 2); }

std::string_view SentenceView::formatter() const {
    return address.substr(std::min<std::size_t>(address.size(), address.starts_with('P') ? 1 : 2));
}

std::string_view SentenceView::field(std::size_t index) const {
    return index < fields.size() ? fields[index] : std::string_view();
}

Result<SentenceView> parse_sentence(std::string_view line) {
    if (line.ends_with('\n')) line.remove_suffix(1);
    while (line.ends_with('\r'))
        line.remove_suffix(1);
    while (line.ends_with(' '))
        line.remove_suffix(1);
    if (!line.starts_with('$') && !line.starts_with('!'))
        return fail(ErrorCode::input, fmt::format("{} does not start with '$'", quoted(line)));
    if (!std::all_of(line.begin(), line.end(), printable))
        return fail(ErrorCode::input, fmt::format("{} has a character that is not printable", quoted(line)));
    const std::size_t star = line.size() >= 4 ? line.size() - 3 : 0;
    if (star == 0 || line[star] != '*' || hex_digit(line[star + 1]) < 0 || hex_digit(line[star + 2]) < 0)
        return fail(ErrorCode::input, fmt::format("{} does not end in a checksum", quoted(line)));
    std::string_view body = line.substr(1, star - 1);
    const int stated = hex_digit(line[star + 1]) * 16 + hex_digit(line[star + 2]);
    const int found = nmea_checksum(body);
    if (stated != found)
        return fail(ErrorCode::input, fmt::format("{} states the checksum {:02X}; its characters give {:02X}",
                                                  quoted(line), stated, found));
    SentenceView sentence;
    std::size_t comma = body.find(',');
    sentence.address = body.substr(0, comma);
    while (comma != std::string_view::npos) {
        body.remove_prefix(comma + 1);
        comma = body.find(',');
        sentence.fields.push_back(body.substr(0, comma));
    }
    return sentence;
}

}  // namespace skyloop::inline receiver
