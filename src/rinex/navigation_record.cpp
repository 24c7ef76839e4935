#include "navigation_record.hpp"

#include <fmt/format.h>

#include <chrono>
#include <cmath>

#include "skyloop/time/utc_time.hpp"

namespace skyloop::rinex {
namespace {

constexpr std::size_t field_width = 19;

// One broadcast number: where it stands and what a satellite can broadcast. The limits are some ten times those that
// the bits of the message allow (IS-GPS-200, tables 20-I and 20-III); angles may be written 0 … 2π.
struct LnavField {
    std::size_t line, column;
    std::string_view name;
    double least, most;
    bool required;  // blank is not 0
    double KeplerEphemeris::*value;
};

using Eph = KeplerEphemeris;
constexpr double full_turn = 7;
constexpr std::array<LnavField, 22> lnav_fields{{
    {0, 1, "the clock offset", -1, 1, false, &Eph::af0},
    {0, 2, "the clock drift", -1e-6, 1e-6, false, &Eph::af1},
    {0, 3, "the clock drift rate", -1e-9, 1e-9, false, &Eph::af2},
    {1, 1, "Crs", -1e5, 1e5, false, &Eph::crs},
    {1, 2, "delta n", -1e-6, 1e-6, false, &Eph::delta_n},
    {1, 3, "M0", -full_turn, full_turn, true, &Eph::m0},
    {2, 0, "Cuc", -1e-2, 1e-2, false, &Eph::cuc},
    {2, 1, "the eccentricity", 0, 0.5, true, &Eph::e},
    {2, 2, "Cus", -1e-2, 1e-2, false, &Eph::cus},
    {2, 3, "the square root of the semi-major axis", 4000, 8000, true, &Eph::sqrt_a},
    {3, 1, "Cic", -1e-2, 1e-2, false, &Eph::cic},
    {3, 2, "OMEGA0", -full_turn, full_turn, true, &Eph::omega0},
    {3, 3, "Cis", -1e-2, 1e-2, false, &Eph::cis},
    {4, 0, "i0", -full_turn, full_turn, true, &Eph::i0},
    {4, 1, "Crc", -1e5, 1e5, false, &Eph::crc},
    {4, 2, "the argument of perigee", -full_turn, full_turn, true, &Eph::omega},
    {4, 3, "OMEGA DOT", -1e-5, 1e-5, false, &Eph::omega_dot},
    {5, 0, "IDOT", -1e-6, 1e-6, false, &Eph::idot},
    {6, 0, "the accuracy", -1, 1e12, false, &Eph::accuracy_m},
    {6, 2, "TGD", -1e-3, 1e-3, false, &Eph::tgd},
    {7, 1, "the fit interval", -1e12, 1e12, false, &Eph::fit_interval_h},
}};

class RecordReading {
public:
    RecordReading(std::span<const Line, lnav_lines> lines, int major)
        : lines_(lines), major_(major), layout_(layout_of_version(major)) {}

    tl::expected<KeplerEphemeris, Defect> read(SatelliteId satellite) {
        eph_.satellite = satellite;
        for (const LnavField& f : lnav_fields)
            if (!defect_ && f.value != nullptr) eph_.*f.value = number(f);
        eph_.iode = whole({1, 0, "IODE", 0, 65535, false, nullptr});
        eph_.health = whole({6, 1, "the health", 0, 65535, false, nullptr});
        eph_.iodc = whole({6, 3, "IODC", 0, 65535, false, nullptr});
        const double toe_tow = number({3, 0, "the toe", 0, static_cast<double>(seconds_per_week), true, nullptr});
        const double week = number({5, 2, "the GPS week", 0, 1e5, false, nullptr});
        epoch();
        if (!defect_) reference_time(toe_tow, week);
        if (defect_) return tl::make_unexpected(std::move(*defect_));
        return eph_;
    }

private:
    [[nodiscard]] std::size_t column_of(std::size_t line, std::size_t column) const {
        return line == 0 ? layout_.clock + field_width * (column - 1) : layout_.orbit + field_width * column;
    }

    double number(const LnavField& f) {
        const std::size_t column = column_of(f.line, f.column);
        const std::string_view field = columns(lines_[f.line].text, column, field_width);
        const std::optional<double> value = real_field(field);
        if (!value || (f.required && is_blank(field)))
            defect(f.line, column, is_blank(field) ? "a blank field" : in_quotes(field),
                   fmt::format("a number, {}", f.name));
        else if (*value < f.least || *value > f.most)
            defect(f.line, column, in_quotes(field), fmt::format("{} between {} and {}", f.name, f.least, f.most));
        return value.value_or(0);
    }

    int whole(const LnavField& f) {
        const double value = number(f);
        return defect_ ? 0 : static_cast<int>(std::llround(value));
    }

    // The calendar epoch of the clock: year, month, day, hour, minute, second.
    void epoch() {
        const std::string_view text = columns(lines_[0].text, layout_.epoch, layout_.epoch_width);
        const std::size_t year_width = major_ == 2 ? 2 : 4;
        const auto part = [&](std::size_t i) { return whole_field(columns(text, year_width + 1 + 3 * (i - 1), 2)); };
        std::optional<int> year = whole_field(text.substr(0, year_width));
        if (year && major_ == 2) year = *year + (*year >= 80 ? 1900 : 2000);
        const auto month = part(1), day = part(2), hour = part(3), minute = part(4);
        const std::optional<double> second = real_field(columns(text, year_width + 12, text.size()));
        if (!year || !month || !day || !hour || !minute || !second || !valid_date(*year, *month, *day) ||
            !valid_clock(*hour, *minute, *second))
            return defect(0, layout_.epoch, in_quotes(text), "a calendar epoch from 1980 to 2099");
        eph_.toc = gps_calendar_time(*year, static_cast<unsigned>(*month), static_cast<unsigned>(*day),
                                     static_cast<unsigned>(*hour), static_cast<unsigned>(*minute), *second);
    }

    static bool valid_date(int year, int month, int day) {
        if (month < 1 || day < 1 || year < 1980 || year >= 2100) return false;
        return (std::chrono::year(year) / month / day).ok();
    }

    // Some writers round up to hour 24, minute 60 or second 60.
    static bool valid_clock(int hour, int minute, double second) {
        return hour >= 0 && hour <= 24 && minute >= 0 && minute <= 60 && second >= 0 && second <= 60;
    }

    // toe is the instant with that time of week that lies nearest to the clock's epoch; the week must tell of the same.
    void reference_time(double toe_tow, double week) {
        const std::int64_t toc_week = week_and_tow(eph_.toc).week;
        eph_.toe = to_gps_time(toc_week, toe_tow);
        constexpr Nanoseconds week_length = std::chrono::seconds(seconds_per_week);
        if (eph_.toe - eph_.toc > week_length / 2) eph_.toe -= week_length;
        if (eph_.toc - eph_.toe > week_length / 2) eph_.toe += week_length;
        if (std::chrono::abs(eph_.toe - eph_.toc) > std::chrono::days(1))
            return defect(3, column_of(3, 0), fmt::format("toe {} s", toe_tow),
                          "toe within a day of the record's epoch");
        if (week_blank()) return;
        const std::int64_t toe_week = week_and_tow(eph_.toe).week;
        const auto stated = static_cast<std::int64_t>(std::llround(week));
        const std::int64_t resolved = stated < 1024 ? resolve_week(stated, toe_week) : stated;
        // Some writers give the week of transmission, which may be a neighbour of that of toe.
        if (std::abs(resolved - toe_week) > 1)
            defect(5, column_of(5, 2), fmt::format("GPS week {}", stated),
                   fmt::format("week {}, that of the epoch", toe_week));
    }
    [[nodiscard]] bool week_blank() const { return is_blank(columns(lines_[5].text, column_of(5, 2), field_width)); }

    void defect(std::size_t line, std::size_t column, std::string found, std::string expected) {
        if (!defect_)
            defect_ = Defect{lines_[line].number, static_cast<int>(column) + 1, std::move(found), std::move(expected)};
    }

    std::span<const Line, lnav_lines> lines_;
    int major_;
    RecordLayout layout_;
    KeplerEphemeris eph_;
    std::optional<Defect> defect_;
};

}  // namespace

bool begins_record(std::string_view line, int major) { return !is_blank(columns(line, 0, major == 2 ? 2 : 1)); }

std::optional<SatelliteId> record_satellite(std::string_view line, int major) {
    if (major != 2) return parse_satellite(columns(line, 0, 3));
    const std::optional<int> number = whole_field(columns(line, 0, 2));
    if (!number || *number < 1) return std::nullopt;
    return SatelliteId{Constellation::gps, *number};
}

tl::expected<KeplerEphemeris, Defect> read_lnav_record(SatelliteId satellite, std::span<const Line, lnav_lines> lines,
                                                       int major) {
    return RecordReading(lines, major).read(satellite);
}

}  // namespace skyloop::rinex
