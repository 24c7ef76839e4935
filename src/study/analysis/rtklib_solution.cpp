#include "detail/rtklib_solution.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/time/utc_time.hpp"
#include "detail/fix_table.hpp"
#include "detail/table_cells.hpp"

namespace skyloop {
namespace {

enum class PosCoordinates { degrees, sexagesimal, ecef };
enum class PosClock { gpst, utc, jst };

struct PosHeader {
    PosCoordinates coordinates = PosCoordinates::degrees;
    PosClock clock = PosClock::gpst;
};

bool names_columns(std::string_view line) {
    return line.find("latitude(") != std::string_view::npos || line.find("x-ecef(") != std::string_view::npos ||
           line.find("-baseline(") != std::string_view::npos;
}

// The fields of a line: blanks, tabs, commas and semicolons separate them, alone or together.
std::vector<std::string_view> pos_fields(std::string_view line) {
    constexpr std::string_view separators = " \t,;\r";
    std::vector<std::string_view> fields;
    for (std::size_t at = line.find_first_not_of(separators); at != std::string_view::npos;) {
        const std::size_t end = std::min(line.find_first_of(separators, at), line.size());
        fields.push_back(line.substr(at, end - at));
        at = line.find_first_not_of(separators, end);
    }
    return fields;
}

// One row, read field by field from the left. After a failure all that follows is nothing.
class PosRow {
public:
    explicit PosRow(std::string_view line) : fields_(pos_fields(line)) {}
    std::optional<double> number(const char* what) {
        if (fault_) return std::nullopt;
        const std::string_view field = next();
        const std::optional<double> value = cell_value(field);
        if (value && std::isfinite(*value)) return value;
        fail_with(fmt::format("the {} is '{}'; expected a number", what, field.substr(0, 40)));
        return std::nullopt;
    }
    std::string_view next() { return place_ < fields_.size() ? fields_[place_++] : std::string_view(); }
    [[nodiscard]] std::string_view peek() const { return place_ < fields_.size() ? fields_[place_] : ""; }
    void fail_with(std::string what) {
        if (!fault_) fault_ = std::move(what);
    }
    [[nodiscard]] const std::optional<std::string>& fault() const { return fault_; }

private:
    std::vector<std::string_view> fields_;
    std::size_t place_ = 0;
    std::optional<std::string> fault_;
};

GpsTime on_clock(const UtcTime& calendar, PosClock clock) {
    if (clock == PosClock::gpst)
        return gps_calendar_time(calendar.year, calendar.month, calendar.day, calendar.hour, calendar.minute,
                                 calendar.second + calendar.nanosecond * 1e-9);
    const GpsTime time = to_gps_time(calendar, LeapSeconds::announced());
    return clock == PosClock::jst ? time - std::chrono::hours(9) : time;
}

// "2018/10/15" and "17:00:00.000".
std::optional<GpsTime> calendar_time(PosRow& row, PosClock clock) {
    const std::string_view date = row.next();
    const std::string_view time = row.next();
    std::string iso = fmt::format("{}T{}Z", date.substr(0, 20), time.substr(0, 20));
    std::replace(iso.begin(), iso.end(), '/', '-');
    if (const Result<UtcTime> calendar = parse_utc(iso)) return on_clock(*calendar, clock);
    row.fail_with(fmt::format("the time is '{} {}'; expected e.g. '2018/10/15 17:00:00.000'", date.substr(0, 20),
                              time.substr(0, 20)));
    return std::nullopt;
}

std::optional<GpsTime> week_time(PosRow& row, PosClock clock) {
    const std::optional<double> week = row.number("GPS week");
    const std::optional<double> tow = row.number("time of week");
    if (!week || !tow) return std::nullopt;
    if (*week < 0 || *week > static_cast<double>(last_gps_week) || *tow < 0 ||
        *tow > static_cast<double>(seconds_per_week)) {
        row.fail_with(fmt::format("GPS week {} and time of week {} s are out of range", *week, *tow));
        return std::nullopt;
    }
    const GpsTime time = to_gps_time(static_cast<std::int64_t>(*week), *tow);
    // The calendar of a clock that runs behind GPST is read as that clock's.
    return clock == PosClock::gpst ? time : on_clock(gps_calendar(time), clock);
}

std::optional<double> pos_angle(PosRow& row, const char* what, PosCoordinates coordinates) {
    const std::string_view first = row.peek();
    const std::optional<double> degrees = row.number(what);
    if (coordinates == PosCoordinates::degrees || !degrees) return degrees;
    const std::optional<double> minutes = row.number("minutes of arc");
    const std::optional<double> seconds = row.number("seconds of arc");
    if (!minutes || !seconds) return std::nullopt;
    const double size = std::abs(*degrees) + *minutes / 60 + *seconds / 3600;
    return first.starts_with('-') ? -size : size;  // the sign of "-0 30 00" too
}

std::optional<Geodetic> geodetic_position(PosRow& row, PosCoordinates coordinates) {
    const std::optional<double> latitude = pos_angle(row, "latitude", coordinates);
    const std::optional<double> longitude = pos_angle(row, "longitude", coordinates);
    const std::optional<double> height = row.number("height");
    if (!latitude || !longitude || !height) return std::nullopt;
    const auto position = checked_position(*latitude, *longitude, *height);
    if (position) return *position;
    row.fail_with(position.error());
    return std::nullopt;
}

std::optional<Geodetic> ecef_position(PosRow& row) {
    const std::optional<double> x = row.number("x coordinate");
    const std::optional<double> y = row.number("y coordinate");
    const std::optional<double> z = row.number("z coordinate");
    if (!x || !y || !z) return std::nullopt;
    const Eigen::Vector3d ecef(*x, *y, *z);
    constexpr double nearest = 6.3e6, farthest = 1e8;  // m; below any place on Earth, beyond any user
    if (ecef.norm() > nearest && ecef.norm() < farthest) return to_geodetic(Position<Ecef>(ecef));
    row.fail_with(fmt::format("the position is {} m from the centre of the Earth; expected {} to {}", ecef.norm(),
                              nearest, farthest));
    return std::nullopt;
}

FixSample pos_sample(PosRow& row, const PosHeader& header) {
    FixSample sample;
    sample.time = row.peek().find('/') != std::string_view::npos ? calendar_time(row, header.clock)
                                                                 : week_time(row, header.clock);
    const auto position =
        header.coordinates == PosCoordinates::ecef ? ecef_position(row) : geodetic_position(row, header.coordinates);
    if (position) sample.position = *position;
    const std::optional<double> quality = row.number("quality");
    const std::optional<double> satellites = row.number("number of satellites");
    constexpr double most_satellites = 1000;
    if (quality && (*quality < 0 || *quality > 9))
        row.fail_with(fmt::format("the quality is {}; expected 0 to 9", *quality));
    if (satellites && (*satellites < 0 || *satellites > most_satellites))
        row.fail_with(fmt::format("the number of satellites is {}; expected 0 to {}", *satellites, most_satellites));
    if (row.fault()) return sample;
    sample.has_fix = *quality >= 1;
    sample.satellites_used = static_cast<int>(*satellites);
    return sample;
}

Result<void> take_header_line(std::string_view line, std::optional<PosHeader>& header, FixSeries& series) {
    if (line.find("height=WGS84/geodetic") != std::string_view::npos)
        series.warnings.push_back(fmt::format("{}: heights are above the geoid, not above the ellipsoid", series.name));
    if (!names_columns(line)) return {};
    if (line.find("-baseline(") != std::string_view::npos)
        return fail(ErrorCode::input, fmt::format("{}: is a solution of baselines; expected one of positions "
                                                  "(out-solformat llh or xyz)",
                                                  series.name));
    PosHeader found;
    if (line.find("x-ecef(") != std::string_view::npos)
        found.coordinates = PosCoordinates::ecef;
    else if (line.find("latitude(d'") != std::string_view::npos)
        found.coordinates = PosCoordinates::sexagesimal;
    if (line.find("UTC") != std::string_view::npos) found.clock = PosClock::utc;
    if (line.find("JST") != std::string_view::npos) found.clock = PosClock::jst;
    header = found;
    return {};
}

}  // namespace

bool is_rtklib_solution(std::string_view text) {
    while (text.starts_with('%') || text.starts_with('\n') || text.starts_with('\r')) {
        const std::size_t end = std::min(text.find('\n'), text.size());
        if (names_columns(text.substr(0, end))) return true;
        text.remove_prefix(std::min(end + 1, text.size()));
    }
    return false;
}

Result<FixSeries> parse_rtklib_solution(std::string_view text, const std::string& name) {
    FixSeries series;
    series.name = name;
    series.dated = true;
    std::optional<PosHeader> header;
    for (std::size_t line = 1; !text.empty(); ++line) {
        const std::size_t end = std::min(text.find('\n'), text.size());
        const std::string_view content = text.substr(0, end);
        text.remove_prefix(std::min(end + 1, text.size()));
        if (content.starts_with('%')) {
            if (auto taken = take_header_line(content, header, series); !taken) return fail(taken.error());
            continue;
        }
        if (trimmed_cell(content).empty()) continue;
        PosRow row(content);
        const FixSample sample = pos_sample(row, header.value_or(PosHeader{}));
        if (row.fault()) return fail(ErrorCode::input, fmt::format("{}:{}: {}", name, line, *row.fault()));
        series.samples.push_back(sample);
    }
    return series;
}

}  // namespace skyloop
