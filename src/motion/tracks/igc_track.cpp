#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "detail/text_track.hpp"

namespace skyloop::inline motion {
namespace {

// Where an extension stands in a B record; empty: not there.
struct IgcField {
    std::size_t first = 0, length = 0;  // first counts from 0
    [[nodiscard]] std::string_view of(std::string_view record) const {
        return first + length <= record.size() ? record.substr(first, length) : std::string_view();
    }
};

std::optional<unsigned> igc_digits(std::string_view text) {
    unsigned value = 0;
    if (text.empty() || text.size() > 9) return std::nullopt;
    for (const char digit : text) {
        if (digit < '0' || digit > '9') return std::nullopt;
        value = value * 10 + static_cast<unsigned>(digit - '0');
    }
    return value;
}

// Shortest B record: time, latitude, longitude, validity, pressure altitude and GNSS altitude.
constexpr std::size_t igc_fix_length = 35;

bool is_igc_fix(std::string_view line) {
    return line.size() >= igc_fix_length && line[0] == 'B' && igc_digits(line.substr(1, 6)) &&
           (line[14] == 'N' || line[14] == 'S') && (line[23] == 'E' || line[23] == 'W') &&
           (line[24] == 'A' || line[24] == 'V');
}

// "0123456": degrees, minutes and thousandths of a minute, and further digits of the minute.
std::optional<double> igc_angle(std::string_view digits, std::size_t degree_digits, std::string_view further) {
    const auto degrees = igc_digits(digits.substr(0, degree_digits));
    const auto thousandths = igc_digits(digits.substr(degree_digits));
    if (!degrees || !thousandths || *thousandths >= 60'000) return std::nullopt;
    double minutes = *thousandths / 1000.0, unit = 1e-4;
    for (const char digit : further) {
        if (digit < '0' || digit > '9') break;  // a recorder that does not fill the field
        minutes += unit * (digit - '0');
        unit /= 10;
    }
    return *degrees + minutes / 60;
}

// "-0123" or "00456": metres.
std::optional<double> igc_altitude(std::string_view text) {
    const bool negative = text.starts_with('-');
    const auto metres = igc_digits(negative ? text.substr(1) : text);
    if (!metres) return std::nullopt;
    return negative ? -static_cast<double>(*metres) : static_cast<double>(*metres);
}

// Midnight some days after a date, GPS time; without a date after the first day.
Nanoseconds midnight_after(const std::optional<UtcTime>& date, int days) {
    if (!date) return days * Nanoseconds(std::chrono::hours(24));
    return to_gps_time(midnight_of(*date, days), LeapSeconds::announced()).time_since_epoch();
}

// FAI/IGC data file standard: technical specification for GNSS flight recorders, appendix A (FEEDS.md 1.10).
class IgcReader {
public:
    explicit IgcReader(const TrackFile& file) : file_(file), track_(file, "IGC", "fixes") {}
    Result<Track> read();

private:
    struct Fix {
        TextRow row;
        std::optional<UtcTime> date;  // the last one before it
        Nanoseconds of_day{0};
        bool valid = false;
        std::optional<double> gnss_m, pressure_m;
    };
    enum class Datum { untold, sea_level, ellipsoid };
    void take_header(std::string_view line);
    void take_date(std::string_view line);
    void take_extensions(std::string_view line);
    void take_fix(std::string_view line, std::size_t number);
    [[nodiscard]] std::optional<Nanoseconds> time_of_day(std::string_view line) const;
    [[nodiscard]] bool is_kept(const Fix& fix) const;
    void date_fixes();
    Result<void> add_fixes();
    void place_height(TextRow& row, const Fix& fix) const;
    void add_notes();

    const TrackFile& file_;
    TextTrack track_;
    std::vector<Fix> fixes_;
    IgcField decimals_, latitude_digits_, longitude_digits_;
    Datum datum_ = Datum::untold;
    std::optional<UtcTime> date_;  // the last one; nothing: none yet
    bool any_valid_ = false, any_gnss_height_ = false;
};

Result<Track> IgcReader::read() {
    TextLines lines(file_.text);
    while (lines.next()) {
        const std::string_view line = trimmed_cell(lines.line());
        if (line.starts_with('H')) take_header(line);
        if (line.starts_with('I')) take_extensions(line);
        if (line.starts_with('B')) take_fix(line, lines.number());
    }
    if (const auto added = add_fixes(); !added) return fail(added.error());
    add_notes();
    return track_.finish("B records with a time and a place");
}

void IgcReader::take_header(std::string_view line) {
    constexpr std::size_t code_end = 5;
    if (line.size() < code_end) return;
    if (line.substr(2, 3) == "DTE") take_date(line);
    if (line.substr(2, 3) != "ALG") return;
    if (line.find("ELL") != std::string_view::npos) datum_ = Datum::ellipsoid;
    if (line.find("GEO") != std::string_view::npos) datum_ = Datum::sea_level;
}

// HFDTE201126 and HFDTEDATE:201126,01: day, month, year. Years from 80 on are those of the century before.
void IgcReader::take_date(std::string_view line) {
    const std::size_t at = line.find_first_of("0123456789");
    if (at == std::string_view::npos || line.size() < at + 6) return;
    const auto day = igc_digits(line.substr(at, 2)), month = igc_digits(line.substr(at + 2, 2)),
               year = igc_digits(line.substr(at + 4, 2));
    if (!day || !month || !year) return;
    const int full = static_cast<int>(*year) + (*year < 80 ? 2000 : 1900);
    const UtcTime date{full, *month, *day, 0, 0, 0, 0};
    if (is_calendar_time(date)) date_ = date;
}

// "I023636TDS3738LAD": a count, then each first and last column, from 1, and a code.
void IgcReader::take_extensions(std::string_view line) {
    constexpr std::size_t head = 3, size = 7;
    for (std::size_t at = head; at + size <= line.size(); at += size) {
        const auto first = igc_digits(line.substr(at, 2)), last = igc_digits(line.substr(at + 2, 2));
        if (!first || !last || *first <= igc_fix_length || *last < *first) continue;
        const IgcField field{*first - 1, *last - *first + 1};
        const std::string_view code = line.substr(at + 4, 3);
        if (code == "TDS") decimals_ = field;
        if (code == "LAD") latitude_digits_ = field;
        if (code == "LOD") longitude_digits_ = field;
    }
}

// UTC.
std::optional<Nanoseconds> IgcReader::time_of_day(std::string_view line) const {
    const auto hour = igc_digits(line.substr(1, 2)), minute = igc_digits(line.substr(3, 2)),
               second = igc_digits(line.substr(5, 2));
    if (!hour || !minute || !second || *hour > 23 || *minute > 59 || *second > 60) return std::nullopt;
    Nanoseconds of_day = std::chrono::hours(*hour) + std::chrono::minutes(*minute) + std::chrono::seconds(*second);
    Nanoseconds unit = std::chrono::milliseconds(100);
    for (const char digit : decimals_.of(line)) {
        if (digit < '0' || digit > '9') break;
        of_day += unit * (digit - '0');
        unit /= 10;
    }
    return of_day;
}

// Recorders without a fix may write any place and any time of day.
bool IgcReader::is_kept(const Fix& fix) const { return fix.valid || !any_valid_; }

// Of the fixes that are kept a time of day that falls by more than half a day is of the next one. A date counts from
// the fix behind it on, unless it repeats the one before.
void IgcReader::date_fixes() {
    constexpr int most_days = 10000;  // only damaged files have more
    constexpr Nanoseconds half_day = std::chrono::hours(12);
    const Fix* before = nullptr;
    int days = 0;
    for (Fix& fix : fixes_) {
        if (!is_kept(fix)) continue;
        const bool somewhere = fix.row.latitude_deg != 0 || fix.row.longitude_deg != 0;
        int its_days = days;
        if (before && before->date != fix.date)
            its_days = 0;
        else if (before && before->of_day - fix.of_day > half_day)
            its_days = std::min(days + 1, most_days);
        fix.row.time = midnight_after(fix.date, its_days) + fix.of_day;
        if (!somewhere) continue;  // which is left out
        days = its_days;
        before = &fix;
    }
}

void IgcReader::take_fix(std::string_view line, std::size_t number) {
    Fix fix;
    fix.row.line = number;
    if (!is_igc_fix(line)) return track_.leave_out("are damaged", number);
    const auto latitude = igc_angle(line.substr(7, 7), 2, latitude_digits_.of(line));
    const auto longitude = igc_angle(line.substr(15, 8), 3, longitude_digits_.of(line));
    if (!latitude || !longitude || *latitude > 90 || *longitude > 180) return track_.leave_out("are damaged", number);
    const auto time = time_of_day(line);
    if (!time) return track_.leave_out("are damaged", number);
    fix.of_day = *time;
    fix.date = date_;
    fix.row.latitude_deg = line[14] == 'S' ? -*latitude : *latitude;
    fix.row.longitude_deg = line[23] == 'W' ? -*longitude : *longitude;
    fix.valid = line[24] == 'A';
    fix.pressure_m = igc_altitude(line.substr(25, 5));
    fix.gnss_m = igc_altitude(line.substr(30, 5));
    any_valid_ |= fix.valid;
    any_gnss_height_ |= fix.gnss_m.value_or(0) != 0;
    fixes_.push_back(fix);
}

void IgcReader::place_height(TextRow& row, const Fix& fix) const {
    if (!any_gnss_height_)
        row.sea_level_m = fix.pressure_m;
    else if (datum_ == Datum::ellipsoid)
        row.ellipsoidal_m = fix.gnss_m;
    else
        row.sea_level_m = fix.gnss_m;
}

Result<void> IgcReader::add_fixes() {
    date_fixes();
    for (const Fix& fix : fixes_) {
        if (!is_kept(fix)) {
            track_.leave_out("are marked V, without a fix in three dimensions", fix.row.line);
            continue;
        }
        TextRow row = fix.row;
        place_height(row, fix);
        if (const auto added = track_.add(row); !added) return added;
    }
    return {};
}

void IgcReader::add_notes() {
    if (fixes_.empty()) return;
    if (!date_) {
        track_.count_from_start();
        track_.note("no HFDTE record says the date; times count from midnight");
    }
    if (!any_valid_)
        track_.note("all fixes are marked V, without a fix in three dimensions; they are taken all the same");
    if (!any_gnss_height_)
        track_.note("no GNSS altitudes; the pressure altitudes (above 1013.25 hPa) are taken above sea level");
    else if (datum_ == Datum::untold)
        track_.note(
            "no HFALG record says what the altitudes are above; they are taken above sea level, as most "
            "recorders write them");
}

}  // namespace

bool is_igc(const TrackFile& file) {
    constexpr std::size_t looked_at = 65536;
    TextLines lines(file.text.substr(0, looked_at));
    while (lines.next()) {
        const std::string_view line = trimmed_cell(lines.line());
        if (is_igc_fix(line) || (line.starts_with("HFDTE") && line.size() < 80)) return true;
    }
    return false;
}

Result<Track> read_igc(const TrackFile& file) { return IgcReader(file).read(); }

}  // namespace skyloop::inline motion
