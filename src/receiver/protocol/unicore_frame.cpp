#include "receiver/protocol/unicore_frame.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "base/core/number_text.hpp"

namespace skyloop::inline receiver {
namespace {

constexpr std::uint8_t unicore_status_fine = 160, unicore_status_unknown = 20;

void put_little_endian(Bytes& to, std::uint32_t value, std::size_t bytes) {
    for (std::size_t i = 0; i < bytes; ++i)
        to.push_back(static_cast<std::uint8_t>(value >> (8 * i) & 0xFF));
}

std::uint32_t little_endian_at(ByteSpan from, std::size_t at, std::size_t bytes) {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < bytes; ++i)
        value |= std::uint32_t{from[at + i]} << (8 * i);
    return value;
}

std::string_view without_unicore_line_end(std::string_view line) {
    return line.substr(0, line.find_last_not_of("\r\n") + 1);
}

// Commas between quotation marks separate nothing.
std::vector<std::string_view> unicore_fields_of(std::string_view text) {
    std::vector<std::string_view> fields;
    bool quoted = false;
    std::size_t begin = 0;
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (text[i] == '"') quoted = !quoted;
        if (text[i] != ',' || quoted) continue;
        fields.push_back(text.substr(begin, i - begin));
        begin = i + 1;
    }
    fields.push_back(text.substr(begin));
    return fields;
}

std::optional<UnicoreHeader> unicore_header_of(const std::vector<std::string_view>& head) {
    if (head.size() != 9) return std::nullopt;
    const auto idle = number_in<int>(head[0]), week = number_in<int>(head[3]), leap = number_in<int>(head[7]),
               delay = number_in<int>(head[8]);
    const auto tow = number_in<std::uint32_t>(head[4]), version = number_in<std::uint32_t>(head[5]);
    if (!idle || !week || !leap || !delay || !tow || !version) return std::nullopt;
    return UnicoreHeader{*idle, head[2] == "FINE", *week, *tow, *version, *leap, *delay};
}

// Whether what follows the star is right: a CRC of what is between the first character and the star, or a checksum.
bool unicore_check_holds(std::string_view line, std::size_t star) {
    const std::string_view digits = line.substr(star + 1);
    constexpr std::size_t crc_digits = 8, checksum_digits = 2;
    const auto said = hexadecimal_number_in<std::uint32_t>(digits);
    if (!said) return false;
    if (digits.size() == checksum_digits) return unicore_answer_checksum(line.substr(0, star)) == *said;
    if (digits.size() != crc_digits || line.front() != '#') return false;
    const std::string_view covered = line.substr(1, star - 1);
    return unicore_crc({reinterpret_cast<const std::uint8_t*>(covered.data()), covered.size()}) == *said;
}

}  // namespace

std::uint32_t unicore_crc(ByteSpan bytes) {
    std::uint32_t crc = 0;
    for (const std::uint8_t byte : bytes) {
        crc ^= byte;
        for (int bit = 0; bit < 8; ++bit)
            crc = (crc & 1u) != 0 ? crc >> 1 ^ 0xEDB8'8320u : crc >> 1;
    }
    return crc;
}

std::uint8_t unicore_answer_checksum(std::string_view answer) {
    std::uint8_t sum = 0;
    for (const char c : answer)
        sum = static_cast<std::uint8_t>(sum ^ static_cast<std::uint8_t>(c));
    return sum;
}

std::string unicore_log_line(std::string_view name, const UnicoreHeader& header, std::string_view body) {
    const std::string text = fmt::format("{},{},GPS,{},{},{},{},0,{},{};{}", name, header.cpu_idle_percent,
                                         header.time_known ? "FINE" : "UNKNOWN", header.week, header.tow_ms,
                                         header.version, header.leap_seconds, header.delay_ms, body);
    const std::uint32_t crc = unicore_crc({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
    return fmt::format("#{}*{:08x}\r\n", text, crc);
}

std::string unicore_answer_line(std::string_view answer) {
    return fmt::format("{}*{:02X}\r\n", answer, unicore_answer_checksum(answer));
}

Bytes encode_unicore_frame(std::uint16_t id, const UnicoreHeader& header, ByteSpan payload) {
    if (payload.size() > 0xFFFF) return {};
    Bytes frame{unicore_sync_1, unicore_sync_2, unicore_sync_3, static_cast<std::uint8_t>(header.cpu_idle_percent)};
    frame.reserve(unicore_head_size + payload.size() + unicore_crc_size);
    put_little_endian(frame, id, 2);
    put_little_endian(frame, static_cast<std::uint32_t>(payload.size()), 2);
    put_little_endian(frame, 0, 1);  // times are those of GPS
    put_little_endian(frame, header.time_known ? unicore_status_fine : unicore_status_unknown, 1);
    put_little_endian(frame, static_cast<std::uint32_t>(header.week), 2);
    put_little_endian(frame, header.tow_ms, 4);
    put_little_endian(frame, header.version, 4);
    put_little_endian(frame, 0, 1);
    put_little_endian(frame, static_cast<std::uint32_t>(header.leap_seconds), 1);
    put_little_endian(frame, static_cast<std::uint32_t>(header.delay_ms), 2);
    frame.insert(frame.end(), payload.begin(), payload.end());
    put_little_endian(frame, unicore_crc(frame), unicore_crc_size);
    return frame;
}

std::optional<std::size_t> unicore_frame_size(ByteSpan bytes) {
    if (bytes.size() < unicore_head_size || bytes[0] != unicore_sync_1 || bytes[1] != unicore_sync_2 ||
        bytes[2] != unicore_sync_3)
        return std::nullopt;
    return unicore_head_size + little_endian_at(bytes, 6, 2) + unicore_crc_size;
}

std::optional<UnicoreFrameView> parse_unicore_frame(ByteSpan bytes) {
    const auto size = unicore_frame_size(bytes);
    if (!size || *size != bytes.size()) return std::nullopt;
    const std::size_t covered = bytes.size() - unicore_crc_size;
    if (unicore_crc(bytes.first(covered)) != little_endian_at(bytes, covered, unicore_crc_size)) return std::nullopt;
    UnicoreFrameView view;
    view.id = static_cast<std::uint16_t>(little_endian_at(bytes, 4, 2));
    view.header = {.cpu_idle_percent = bytes[3],
                   .time_known = bytes[9] == unicore_status_fine,
                   .week = static_cast<int>(little_endian_at(bytes, 10, 2)),
                   .tow_ms = little_endian_at(bytes, 12, 4),
                   .version = little_endian_at(bytes, 16, 4),
                   .leap_seconds = bytes[21],
                   .delay_ms = static_cast<int>(little_endian_at(bytes, 22, 2))};
    view.payload = bytes.subspan(unicore_head_size, covered - unicore_head_size);
    return view;
}

std::optional<UnicoreLineView> parse_unicore_line(std::string_view line) {
    line = without_unicore_line_end(line);
    const std::size_t star = line.rfind('*');
    if (line.size() < 4 || (line[0] != '#' && line[0] != '$') || star == std::string_view::npos) return std::nullopt;
    if (!unicore_check_holds(line, star)) return std::nullopt;
    const std::string_view text = line.substr(1, star - 1);
    UnicoreLineView view;
    view.lead = line[0];
    const std::size_t body = view.lead == '#' ? text.find(';') : std::string_view::npos;
    std::vector<std::string_view> head = unicore_fields_of(text.substr(0, std::min(body, text.size())));
    view.name = head.front();
    head.erase(head.begin());
    if (view.lead == '$') {
        constexpr std::array<std::string_view, 3> answers{"command", "CONFIG", "devicename"};
        if (std::ranges::find(answers, view.name) == answers.end()) return std::nullopt;
        view.fields = std::move(head);
        return view;
    }
    if (body == std::string_view::npos) return std::nullopt;
    view.head = std::move(head);
    view.header = unicore_header_of(view.head);
    view.fields = unicore_fields_of(text.substr(body + 1));
    return view;
}

}  // namespace skyloop::inline receiver
