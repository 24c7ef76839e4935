#include "detail/record_fields.hpp"

#include <fmt/format.h>

#include <chrono>
#include <cmath>

#include "base/time/utc_time.hpp"

namespace skyloop::rinex {
namespace {

constexpr std::size_t field_width = 19;

bool valid_date(int year, int month, int day) {
    if (month < 1 || day < 1 || !is_epoch_year(year)) return false;
    return (std::chrono::year(year) / month / day).ok();
}

// Some writers round up to hour 24, minute 60 or second 60.
bool valid_clock(int hour, int minute, double second) {
    return hour >= 0 && hour <= 24 && minute >= 0 && minute <= 60 && second >= 0 && second <= 60;
}

}  // namespace

RecordFields::RecordFields(std::span<const Line> lines, int major) : lines_(lines), major_(major) {}

std::size_t RecordFields::text_column(std::size_t line, std::size_t column) const {
    if (line == 0) return (major_ == 2 ? 22 : 23) + field_width * (column - 1);
    return (major_ == 2 ? 3 : 4) + field_width * column;
}

std::string_view RecordFields::field(std::size_t line, std::size_t column) const {
    if (line >= lines_.size()) return {};
    return columns(lines_[line].text, text_column(line, column), field_width);
}

bool RecordFields::blank(std::size_t line, std::size_t column) const { return is_blank(field(line, column)); }

double RecordFields::number(const FieldRule& rule) {
    const std::string_view text = field(rule.line, rule.column);
    const std::optional<double> value = real_field(text);
    if (!value || (rule.required && is_blank(text)))
        refuse(rule.line, rule.column, is_blank(text) ? "a blank field" : in_quotes(text),
               fmt::format("a number, {}", rule.name));
    else if (*value < rule.least || *value > rule.most)
        refuse(rule.line, rule.column, in_quotes(text),
               fmt::format("{} between {} and {}", rule.name, rule.least, rule.most));
    return defect_ ? 0 : *value;
}

int RecordFields::whole(const FieldRule& rule) { return static_cast<int>(std::llround(number(rule))); }

GpsTime RecordFields::epoch() {
    const std::size_t first = major_ == 2 ? 3 : 4;
    const std::string_view text = columns(lines_[0].text, first, field_width);
    const std::size_t year_width = major_ == 2 ? 2 : 4;
    const auto part = [&](std::size_t i) { return whole_field(columns(text, year_width + 1 + 3 * (i - 1), 2)); };
    std::optional<int> year = whole_field(text.substr(0, year_width));
    if (year && major_ == 2) year = *year + (*year >= 80 ? 1900 : 2000);
    const auto month = part(1), day = part(2), hour = part(3), minute = part(4);
    const std::optional<double> second = real_field(columns(text, year_width + 12, text.size()));
    if (!year || !month || !day || !hour || !minute || !second || !valid_date(*year, *month, *day) ||
        !valid_clock(*hour, *minute, *second)) {
        if (!defect_)
            defect_ = Defect{lines_[0].number, static_cast<int>(first) + 1, in_quotes(text),
                             "a calendar epoch from 1980 to 2269"};
        return {};
    }
    return gps_calendar_time(*year, static_cast<unsigned>(*month), static_cast<unsigned>(*day),
                             static_cast<unsigned>(*hour), static_cast<unsigned>(*minute), *second);
}

void RecordFields::refuse(std::size_t line, std::size_t column, std::string found, std::string expected) {
    if (defect_) return;
    const int at = line < lines_.size() ? lines_[line].number : lines_.back().number;
    defect_ = Defect{at, static_cast<int>(text_column(line, column)) + 1, std::move(found), std::move(expected)};
}

}  // namespace skyloop::rinex
