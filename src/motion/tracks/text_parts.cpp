// Numbers, lines, cells and times of text files.

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "base/core/number_text.hpp"
#include "base/core/words.hpp"
#include "detail/text_track.hpp"

namespace skyloop::inline motion {
namespace {

// Digits at the front of `text`, which they are taken from; nothing unless there are `count`.
std::optional<unsigned> take_digits(std::string_view& text, std::size_t count) {
    if (text.size() < count) return std::nullopt;
    unsigned value = 0;
    for (const char digit : text.substr(0, count)) {
        if (digit < '0' || digit > '9') return std::nullopt;
        value = value * 10 + static_cast<unsigned>(digit - '0');
    }
    text.remove_prefix(count);
    return value;
}

bool take_char(std::string_view& text, std::string_view any_of) {
    if (text.empty() || any_of.find(text.front()) == std::string_view::npos) return false;
    text.remove_prefix(1);
    return true;
}

// The fraction of a second, when there is one: nanoseconds. False: a point without digits.
bool take_fraction(std::string_view& text, std::uint32_t& nanosecond) {
    if (!take_char(text, ".,")) return true;
    std::uint32_t unit = 100'000'000;
    bool any = false;
    for (; !text.empty() && text.front() >= '0' && text.front() <= '9'; text.remove_prefix(1)) {
        nanosecond += unit * static_cast<std::uint32_t>(text.front() - '0');
        unit /= 10;
        any = true;
    }
    return any;
}

bool could_be(const UtcTime& local) {
    using namespace std::chrono;
    return year_month_day(year(local.year), month(local.month), day(local.day)).ok() && local.hour < 24 &&
           local.minute < 60 && local.second <= 60;
}

}  // namespace

std::string one_line_of(std::string text) {
    for (char& letter : text)
        if (static_cast<unsigned char>(letter) < 0x20) letter = ' ';
    return text;
}

std::optional<double> text_number(std::string_view text) { return signed_number_in<double>(trimmed_cell(text)); }

bool TextLines::next() {
    if (rest_.empty()) return false;
    constexpr std::size_t longest = 65536;
    const std::size_t end = std::min(rest_.find('\n'), rest_.size());
    line_ = rest_.substr(0, std::min(end, longest));
    if (line_.ends_with('\r')) line_.remove_suffix(1);
    rest_.remove_prefix(std::min(end + 1, rest_.size()));
    ++number_;
    return true;
}

std::optional<IsoTime> parse_iso_time(std::string_view text) {
    text = trimmed_cell(text);
    UtcTime local;
    const auto year = take_digits(text, 4);
    const bool first = take_char(text, "-/");
    const auto month = take_digits(text, 2);
    const bool second = take_char(text, "-/");
    const auto day = take_digits(text, 2);
    const bool between = take_char(text, "Tt ");
    const auto hour = take_digits(text, 2);
    const bool third = take_char(text, ":");
    const auto minute = take_digits(text, 2);
    const bool with_seconds = take_char(text, ":");
    const auto whole = with_seconds ? take_digits(text, 2) : std::optional(0U);
    if (!year || !month || !day || !hour || !minute || !whole) return std::nullopt;
    if (!first || !second || !between || !third) return std::nullopt;
    local = {static_cast<int>(*year), *month, *day, *hour, *minute, *whole, 0};
    if (with_seconds && !take_fraction(text, local.nanosecond)) return std::nullopt;
    text = trimmed_cell(text);
    const auto zone = zone_minutes(text);
    if (!zone || !could_be(local)) return std::nullopt;
    const auto since = utc_since_1980(utc_of_local(local, *zone));
    return IsoTime{GpsTime(since.value_or(Nanoseconds(0))), !text.empty(), since.has_value()};
}

std::optional<Nanoseconds> utc_since_1980(const UtcTime& utc) {
    if (!is_calendar_time(utc)) return std::nullopt;
    return to_gps_time(utc, LeapSeconds::announced()).time_since_epoch();
}

Attitude attitude_of_flu_in_enu(const Eigen::Quaterniond& body_to_enu) {
    // Both pairs of axes turn into one another by half a turn about an axis between them.
    const double half = std::sqrt(0.5);
    const Eigen::Quaterniond enu_to_ned(0, half, half, 0), frd_to_flu(0, 1, 0, 0);
    return Attitude(enu_to_ned * body_to_enu.normalized() * frd_to_flu);
}

bool TableCells::next() {
    while (lines_.next()) {
        const std::string_view plain = trimmed_cell(lines_.line());
        if (plain.empty() || comments_.find(plain.front()) != std::string::npos) continue;
        split_table_line(lines_.line(), separator_, cells_);
        return true;
    }
    return false;
}

void TableCells::take_names() {
    names_.clear();
    for (const std::string_view cell : cells_)
        names_.push_back(lower_case(cell));
}

Result<void> TableCells::check_width() const {
    if (const auto mistake = width_mistake(cells_, names_.size())) return refusal(*mistake);
    return {};
}

std::optional<std::size_t> TableCells::column(std::string_view name) const {
    const auto at = std::find(names_.begin(), names_.end(), lower_case(name));
    return at == names_.end() ? std::nullopt : std::optional(static_cast<std::size_t>(at - names_.begin()));
}

std::string_view TableCells::cell(std::optional<std::size_t> column) const {
    return column && *column < cells_.size() ? cells_[*column] : std::string_view();
}

Result<std::optional<double>> TableCells::number(std::optional<std::size_t> column) const {
    const std::string_view text = cell(column);
    if (text.empty() || lower_case(text) == "nan") return std::nullopt;
    const auto value = text_number(text);
    if (value) return value;
    const std::string what = *column < names_.size() ? names_[*column] : fmt::format("cell {}", *column + 1);
    return refusal(fmt::format("{:.40} is '{:.40}'; expected a number with a decimal point", what, text));
}

Result<std::optional<double>> TableCells::coordinate(std::optional<std::size_t> column, Coordinate which) const {
    auto plain = number(column);
    if (plain) return plain;
    const auto written = written_degrees(cell(column), which);
    return written ? written : std::move(plain);
}

Result<std::optional<std::array<double, 2>>> TableCells::place(std::array<std::string_view, 2> names) {
    const std::array columns{column(names[0]), column(names[1])};
    const auto latitude = coordinate(columns[0], Coordinate::latitude),
               longitude = coordinate(columns[1], Coordinate::longitude);
    if (!latitude) return fail(latitude.error());
    if (!longitude) return fail(longitude.error());
    if (!*latitude || !*longitude) return std::nullopt;
    if (!places_) {
        places_ = {*columns[0], *columns[1]};
        hemispheres_ = HemisphereColumns(names_, *places_);
    }
    const auto place = hemispheres_.place(cells_, {**latitude, **longitude}, line());
    if (!place) return refusal(place.error());
    return *place;
}

Result<std::vector<double>> TableCells::numbers(std::size_t first, std::size_t count) const {
    std::vector<double> values;
    for (std::size_t i = first; i < first + count; ++i) {
        const auto value = number(i);
        if (!value) return fail(value.error());
        if (!*value)
            return refusal(fmt::format("cell {} is '{}'; expected {} numbers in a row", i + 1, cell(i), first + count));
        values.push_back(**value);
    }
    return values;
}

tl::unexpected<Error> TableCells::refusal(const std::string& what) const {
    return fail(ErrorCode::input, fmt::format("{}:{}: {}", name_, line(), one_line_of(what)));
}

std::optional<Nanoseconds> posix_since_1980(std::string_view seconds) {
    const std::size_t point = std::min(seconds.find('.'), seconds.size());
    const auto whole = number_in<std::int64_t>(seconds.substr(0, point));
    constexpr std::int64_t latest = 7258118400;  // 2200-01-01
    if (!whole || *whole < gps_epoch_posix_s || *whole >= latest) return std::nullopt;
    const auto fraction = point < seconds.size() ? text_number(seconds.substr(point)) : std::optional(0.0);
    if (!fraction || *fraction < 0 || *fraction >= 1) return std::nullopt;
    const Nanoseconds since_1970 = std::chrono::seconds(*whole) + Nanoseconds(std::llround(*fraction * 1e9));
    return from_posix(since_1970, LeapSeconds::announced()).time_since_epoch();
}

std::optional<Nanoseconds> week_since_1980(double week, double tow_s) {
    constexpr double latest_week = 11400;  // of the year 2198
    if (!(week >= 0 && week < latest_week && week == std::floor(week) && tow_s >= 0 && tow_s <= seconds_per_week))
        return std::nullopt;
    return to_gps_time(static_cast<std::int64_t>(week), tow_s).time_since_epoch();
}

bool is_table_dialect(const TrackFile& file) {
    constexpr std::size_t looked_at = 65536;
    const std::string_view head = file.text.substr(0, looked_at);
    return is_named_dialect(head) || is_shaped_dialect(file);
}

Result<Track> read_table_dialect(const TrackFile& file) {
    constexpr std::size_t looked_at = 65536;
    const std::string_view head = file.text.substr(0, looked_at);
    if (is_named_dialect(head)) return read_named_dialect(file);
    return read_shaped_dialect(file);
}

}  // namespace skyloop::inline motion
