#include "detail/fields.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>

#include "base/core/number_text.hpp"
#include "base/time/utc_time.hpp"

namespace skyloop::inline world::rinex {

namespace {

// Years of epochs: those of GPS time which 64-bit nanoseconds hold whole, so that all that a run writes is read back.
constexpr bool is_epoch_year(int year) { return year >= 1980 && year <= 2269; }

}  // namespace

std::optional<Line> LineReader::next() {
    if (rest_.empty()) return std::nullopt;
    const std::size_t end = rest_.find('\n');
    std::string_view line = rest_.substr(0, end);
    rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
    if (line.ends_with('\r')) line.remove_suffix(1);
    return Line{line, ++number_};
}

std::optional<Line> LineReader::next_filled(std::string_view blanks) {
    std::optional<Line> line = next();
    while (line && trimmed(line->text, blanks).empty())
        line = next();
    return line;
}

std::string_view columns(std::string_view line, std::size_t first, std::size_t width) {
    return first < line.size() ? line.substr(first, width) : std::string_view{};
}

std::vector<std::string_view> words_of(std::string_view line) {
    std::vector<std::string_view> words;
    for (std::size_t at = 0; at < line.size();) {
        const std::size_t first = line.find_first_not_of(" \t", at);
        if (first == std::string_view::npos) break;
        at = std::min(line.find_first_of(" \t", first), line.size());
        words.push_back(line.substr(first, at - first));
    }
    return words;
}

std::string_view without_byte_order_mark(std::string_view text) {
    constexpr std::string_view mark = "\xEF\xBB\xBF";
    return text.starts_with(mark) ? text.substr(mark.size()) : text;
}

std::optional<double> real_field(std::string_view field) {
    field = trimmed(field);
    if (field.empty()) return 0.0;
    if (field.starts_with('+')) field.remove_prefix(1);
    std::array<char, 40> digits;
    if (field.empty() || field.size() > digits.size()) return std::nullopt;
    // Before the digits and the sign of the exponent.
    std::size_t letter = field.size() - 1;
    while (letter > 0 && field[letter] <= '9' && field[letter] != '.')
        --letter;
    if (field[letter] == 'D' || field[letter] == 'd') {
        std::copy(field.begin(), field.end(), digits.begin());
        digits[letter] = 'e';
        field = {digits.data(), field.size()};
    }
    return number_in<double>(field);
}

std::optional<int> whole_field(std::string_view field) {
    field = trimmed(field);
    return field.empty() ? 0 : number_in<int>(field);
}

std::optional<GpsTime> calendar_epoch(const CalendarFields& fields, const ClockLimits& most) {
    const auto& [year, month, day, hour, minute, second] = fields;
    if (!year || !month || !day || !hour || !minute || !second) return std::nullopt;
    // std::chrono keeps months and days modulo 256.
    if (!is_epoch_year(*year) || *month < 1 || *month > 12 || *day < 1 || *day > 31 ||
        !(std::chrono::year(*year) / *month / *day).ok())
        return std::nullopt;
    if (*hour < 0 || *hour > most.hour || *minute < 0 || *minute > most.minute || *second < 0 || *second > most.second)
        return std::nullopt;
    return gps_calendar_time(*year, static_cast<unsigned>(*month), static_cast<unsigned>(*day),
                             static_cast<unsigned>(*hour), static_cast<unsigned>(*minute), *second);
}

GpsTime epoch_in_gpst(GpsTime written, std::string_view time_system) {
    constexpr std::chrono::seconds tai_lead{19};
    if (time_system == "BDT") return written + bdt_lag;
    if (time_system == "TAI") return written - tai_lead;
    if (time_system != "GLO" && time_system != "UTC") return written;
    const LeapSeconds& leap = LeapSeconds::announced();
    return written + std::chrono::seconds(leap.offset(written + std::chrono::seconds(leap.offset(written))));
}

tl::expected<std::optional<int>, std::string> announced_leap_seconds(std::string_view line) {
    // Columns 25-27 may name the time scale; BDT counts leap seconds from another epoch.
    const std::string_view field = columns(line, 0, 6);
    if (is_blank(field) || columns(line, 24, 3) == "BDS") return std::nullopt;
    const std::optional<int> value = whole_field(field);
    if (!value || *value < 0 || *value >= 1000) return tl::make_unexpected(in_quotes(field));
    return value;
}

Result<VersionLine> read_version_line(LineReader& lines, std::string_view name, std::string_view wanted,
                                      std::string_view or_else) {
    const std::optional<Line> line = lines.next_filled();
    if (!line) return refused(name, lines.number(), "an empty file", wanted);
    if (header_label(line->text) != "RINEX VERSION / TYPE")
        return refused(name, line->number, in_quotes(line->text),
                       fmt::format("a RINEX header, its label 'RINEX VERSION / TYPE' in columns 61-80{}", or_else));
    const std::string_view field = columns(line->text, 0, 20);
    const double version = real_field(field).value_or(0);
    const bool supported = (version >= 2.0 && version < 2.125) || (version >= 3.0 && version < 3.055) ||
                           (version >= 4.0 && version < 4.025);
    if (!supported) return refused(name, line->number, fmt::format("RINEX version {}", in_quotes(field)), wanted);
    return VersionLine{*line, version};
}

void DefectTally::warn(std::vector<std::string>& warnings, std::string_view outcome) const {
    if (count == 0) return;
    warnings.push_back(
        fmt::format("{}; {}{}", first, outcome, count > 1 ? fmt::format(", and {} more likewise", count - 1) : ""));
}

std::string at_line(std::string_view name, int line, std::string_view found, std::string_view expected) {
    return fmt::format("{}:{}: found {}; expected {}", name, line, found, expected);
}

tl::unexpected<Error> refused(std::string_view name, int line, std::string_view found, std::string_view expected) {
    return fail(ErrorCode::input, at_line(name, line, found, expected));
}

std::string in_quotes(std::string_view text) {
    constexpr std::size_t longest = 40;
    text = trimmed(text);
    std::string result = "'";
    for (const char c : text.substr(0, longest))
        result += c >= ' ' && c <= '~' ? c : '?';
    return result + (text.size() > longest ? "…'" : "'");
}

}  // namespace skyloop::inline world::rinex
