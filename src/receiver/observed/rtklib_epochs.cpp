#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/core/number_text.hpp"
#include "base/core/table_text.hpp"
#include "base/time/utc_time.hpp"
#include "detail/observed_parts.hpp"

namespace skyloop::inline receiver {
namespace {

enum class PosCoordinates { degrees, sexagesimal, ecef };
enum class PosClock { gpst, utc, jst };

// What the header of a solution says (RTKLIB manual 2.4.2, appendix B.1).
struct PosHeader {
    PosCoordinates coordinates = PosCoordinates::degrees;
    PosClock clock = PosClock::gpst;
    bool above_sea = false;
};

bool names_columns(std::string_view line) {
    return line.find("latitude(") != std::string_view::npos || line.find("x-ecef(") != std::string_view::npos ||
           line.find("-baseline(") != std::string_view::npos;
}

// Blanks, tabs, commas and semicolons separate cells, alone or together, as the options of RTKLIB say.
LineCells pos_cells(std::string_view line) {
    LineCells cells;
    split_line(trimmed_cell(line), " \t,;", true, cells);
    return cells;
}

// One row, read cell by cell from the left. After a failure all that follows is nothing.
class PosRow {
public:
    explicit PosRow(std::string_view line) : cells_(pos_cells(line)) {}
    std::optional<double> number(const char* what) {
        if (fault_) return std::nullopt;
        const std::string_view cell = next();
        const std::optional<double> value = signed_number_in<double>(cell);
        if (!value) fail_with(fmt::format("the {} is '{:.40}'; expected a number", what, cell));
        return value;
    }
    std::string_view next() { return place_ < cells_.size() ? cells_[place_++] : std::string_view(); }
    [[nodiscard]] std::string_view peek() const { return place_ < cells_.size() ? cells_[place_] : ""; }
    void pass_over(std::size_t cells) { place_ += cells; }
    [[nodiscard]] bool has(std::size_t cells) const { return cells_.size() >= place_ + cells; }
    void fail_with(std::string what) {
        if (!fault_) fault_ = std::move(what);
    }
    [[nodiscard]] const std::optional<std::string>& fault() const { return fault_; }

private:
    LineCells cells_;
    std::size_t place_ = 0;
    std::optional<std::string> fault_;
};

GpsTime on_clock(const UtcTime& calendar, PosClock clock) {
    if (clock == PosClock::gpst)
        return gps_calendar_time(calendar.year, calendar.month, calendar.day, calendar.hour, calendar.minute,
                                 calendar.second) +
               Nanoseconds(calendar.nanosecond);
    const GpsTime time = to_gps_time(calendar, LeapSeconds::announced());
    return clock == PosClock::jst ? time - std::chrono::hours(9) : time;
}

// "2018/10/15" and "17:00:00.000".
std::optional<GpsTime> calendar_time(PosRow& row, PosClock clock) {
    const std::string_view date = row.next();
    const std::string_view time = row.next();
    std::string iso = fmt::format("{:.20}T{:.20}Z", date, time);
    std::replace(iso.begin(), iso.end(), '/', '-');
    if (const Result<UtcTime> calendar = parse_utc(iso)) return on_clock(*calendar, clock);
    row.fail_with(
        fmt::format("the time is '{:.20} {:.20}'; expected e.g. '2018/10/15 17:00:00.000', or a GPS week and the time "
                    "of week",
                    date, time));
    return std::nullopt;
}

std::optional<GpsTime> week_time(PosRow& row, PosClock clock) {
    const std::optional<double> week = row.number("GPS week");
    const std::optional<double> tow = row.number("time of week");
    if (!week || !tow) return std::nullopt;
    if (*week < 0 || *week > static_cast<double>(last_gps_week) || *week != std::floor(*week) || *tow < 0 ||
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

std::optional<Geodetic> geodetic_place(PosRow& row, PosCoordinates coordinates) {
    const std::optional<double> latitude = pos_angle(row, "latitude", coordinates);
    const std::optional<double> longitude = pos_angle(row, "longitude", coordinates);
    const std::optional<double> height = row.number("height");
    if (!latitude || !longitude || !height) return std::nullopt;
    const auto place = place_from_degrees(*latitude, *longitude, *height);
    if (place) return *place;
    row.fail_with(place.error());
    return std::nullopt;
}

std::optional<Geodetic> ecef_place(PosRow& row) {
    const std::optional<double> x = row.number("x coordinate");
    const std::optional<double> y = row.number("y coordinate");
    const std::optional<double> z = row.number("z coordinate");
    if (!x || !y || !z) return std::nullopt;
    const Position<Ecef> point(*x, *y, *z);
    constexpr double nearest = 6.3e6, farthest = 1.7e7;  // m; below any place on Earth, beyond what a path is for
    const double radius = point.vector().norm();
    if (radius > nearest && radius < farthest) return to_geodetic(point);
    row.fail_with(fmt::format("the place lies {:.0f} m from the Earth's centre; expected {:.0f} to {:.0f}", radius,
                              nearest, farthest));
    return std::nullopt;
}

// Quality: 1 fixed, 2 float, 3 with SBAS, 4 differential, 5 single, 6 precise point positioning; 0 is none.
FixType pos_fix_type(double quality) {
    if (quality < 1) return FixType::none;
    if (quality == 1) return FixType::rtk_fixed;
    if (quality == 2) return FixType::rtk_float;
    return quality < 5 ? FixType::dgnss : FixType::fix_3d;
}

// Quality and satellites, then six deviations, age and ratio, then velocities north, east and up where they were asked
// for.
void take_quality(PosRow& row, const PosHeader& header, ObservedEpoch& epoch) {
    constexpr double most_satellites = 1000;
    constexpr std::size_t before = 8, with_velocity = before + 3;
    const std::optional<double> quality = row.number("quality");
    const std::optional<double> satellites = row.number("number of satellites");
    if (!quality || !satellites) return;
    if (*quality < 0 || *quality > 9) row.fail_with(fmt::format("the quality is {}; expected 0 to 9", *quality));
    if (*satellites < 0 || *satellites > most_satellites)
        row.fail_with(fmt::format("the number of satellites is {}; expected 0 to {}", *satellites, most_satellites));
    if (row.fault()) return;
    epoch.type = pos_fix_type(*quality);
    epoch.satellites_used = static_cast<int>(*satellites);
    if (header.coordinates == PosCoordinates::ecef || !row.has(with_velocity)) return;
    row.pass_over(before);
    const auto north = signed_number_in<double>(row.next()), east = signed_number_in<double>(row.next()),
               up = signed_number_in<double>(row.next());
    if (north && east && up) epoch.velocity = VelocityNed{*north, *east, -*up};
}

ObservedEpoch pos_epoch(PosRow& row, const PosHeader& header, const Geoid* geoid) {
    ObservedEpoch epoch;
    epoch.is_solution = true;
    const auto time =
        signed_number_in<double>(row.peek()) ? week_time(row, header.clock) : calendar_time(row, header.clock);
    if (time) epoch.time = *time;
    epoch.place =
        header.coordinates == PosCoordinates::ecef ? ecef_place(row) : geodetic_place(row, header.coordinates);
    take_quality(row, header, epoch);
    if (!header.above_sea || !epoch.place) return epoch;
    epoch.motion.latitude = epoch.place->latitude;
    epoch.motion.longitude = epoch.place->longitude;
    epoch.motion.altitude = epoch.place->height.above_ellipsoid;
    if (geoid) epoch.place->height.above_ellipsoid += geoid->undulation(epoch.place->latitude, epoch.place->longitude);
    return epoch;
}

PosHeader header_of(std::string_view line, PosHeader header) {
    const auto says = [&](std::string_view what) { return line.find(what) != std::string_view::npos; };
    if (says("height=WGS84/geodetic")) header.above_sea = true;
    if (!names_columns(line)) return header;
    header.coordinates = says("x-ecef(")       ? PosCoordinates::ecef
                         : says("latitude(d'") ? PosCoordinates::sexagesimal
                                               : PosCoordinates::degrees;
    header.clock = says("UTC") ? PosClock::utc : says("JST") ? PosClock::jst : PosClock::gpst;
    return header;
}

// A row as without a header it can be told: a time of two cells, degrees, a height, quality, satellites, six
// deviations, age and ratio.
bool is_bare_row(std::string_view line) {
    constexpr std::size_t columns = 15;
    const LineCells cells = pos_cells(line);
    if (cells.size() < columns) return false;
    const bool calendar = cells[0].size() == 10 && cells[0][4] == '/' && cells[0][7] == '/' &&
                          cells[1].find(':') != std::string_view::npos;
    const auto tells = [&](std::size_t i) {
        return (calendar && i < 2) || signed_number_in<double>(cells[i]).has_value();
    };
    for (std::size_t i = 0; i < columns; ++i)
        if (!tells(i)) return false;
    constexpr double latest_week = 10'000, most_satellites = 200;
    const auto whole = [&](std::size_t i, double least, double most) {
        const double value = *signed_number_in<double>(cells[i]);
        return value >= least && value <= most && value == std::floor(value);
    };
    const auto within = [&](std::size_t i, double most) {
        return std::abs(*signed_number_in<double>(cells[i])) <= most;
    };
    const bool weeks = !calendar && whole(0, 1, latest_week) && *signed_number_in<double>(cells[1]) >= 0 &&
                       within(1, static_cast<double>(seconds_per_week));
    return (calendar || weeks) && within(2, 90) && within(3, 360) && whole(5, 1, 7) && whole(6, 0, most_satellites);
}

}  // namespace

bool is_rtklib_solution(ByteSpan bytes) {
    constexpr std::size_t looked_at = 65536;
    std::string_view text(reinterpret_cast<const char*>(bytes.data()), std::min(bytes.size(), looked_at));
    while (!text.empty()) {
        const std::string_view line = text.substr(0, text.find('\n'));
        if (line.starts_with('%') && names_columns(line)) return true;
        if (!trimmed_cell(line).empty() && !line.starts_with('%')) return is_bare_row(line);
        text.remove_prefix(std::min(line.size() + 1, text.size()));
    }
    return false;
}

Result<ObservedLog> read_rtklib_solution(ByteSpan bytes, const std::string& name, const ObservedReading& reading) {
    std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    ObservedLog log;
    log.name = name;
    log.format = "RTKLIB solution";
    PosHeader header;
    bool headed = false;
    for (std::size_t line = 1; !text.empty(); ++line) {
        const std::string_view content = text.substr(0, text.find('\n'));
        text.remove_prefix(std::min(content.size() + 1, text.size()));
        const auto refusal = [&](std::string_view what) {
            return fail(ErrorCode::input, fmt::format("{}:{}: {}", name, line, what));
        };
        if (content.starts_with('%')) {
            headed = headed || names_columns(content);
            header = header_of(content, header);
            if (content.find("-baseline(") != std::string_view::npos)
                return refusal("a solution of baselines; expected one of positions (out-solformat llh or xyz)");
            continue;
        }
        if (trimmed_cell(content).empty()) continue;
        PosRow row(content);
        ObservedEpoch epoch = pos_epoch(row, header, reading.geoid);
        if (row.fault()) return refusal(*row.fault());
        epoch.line = line;
        log.epochs.push_back(std::move(epoch));
    }
    if (!headed) log.notes.emplace_back("no header: taken as GPST, degrees, metres above the ellipsoid");
    if (header.above_sea && reading.use != ObservedUse::track)
        log.notes.emplace_back(reading.geoid ? "heights above the geoid were taken above EGM96"
                                             : "heights are above the geoid, not above the ellipsoid");
    return finish_log(std::move(log), reading);
}

}  // namespace skyloop::inline receiver
