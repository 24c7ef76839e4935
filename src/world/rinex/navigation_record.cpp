#include <fmt/format.h>

#include <array>
#include <chrono>
#include <cmath>

#include "base/time/utc_time.hpp"
#include "detail/navigation_record.hpp"

namespace skyloop::inline world::rinex {
namespace {

constexpr std::size_t field_width = 19;

// Where a number stands in a record, what it is called and what a satellite can broadcast.
struct FieldRule {
    std::size_t line = 0, column = 0;  // column 0 … 3; of the first line 1 … 3, after the epoch
    std::string_view name;
    double least = 0, most = 0;
    bool required = false;  // blank is not 0
};

// Takes numbers from the lines of a record and remembers the first defect; what comes after one is 0.
class RecordFields {
public:
    RecordFields(std::span<const Line> lines, int major) : lines_(lines), major_(major) {}

    double number(const FieldRule& rule);
    int whole(const FieldRule& rule);
    // The calendar epoch of the first line, in whatever time scale it is written, read as if it were GPST.
    GpsTime epoch();
    [[nodiscard]] bool blank(std::size_t line, std::size_t column) const;
    [[nodiscard]] std::size_t line_count() const { return lines_.size(); }

    // Notes that the field at `line`, `column` cannot be.
    void refuse(std::size_t line, std::size_t column, std::string found, std::string expected);
    [[nodiscard]] const std::optional<Defect>& defect() const { return defect_; }

private:
    [[nodiscard]] std::size_t text_column(std::size_t line, std::size_t column) const;
    [[nodiscard]] std::string_view field(std::size_t line, std::size_t column) const;

    std::span<const Line> lines_;
    int major_;
    std::optional<Defect> defect_;
};

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
    if (year && major_ == 2) year = full_year(*year);
    const auto second = real_field(columns(text, year_width + 12, text.size()));
    const auto time = calendar_epoch({year, part(1), part(2), part(3), part(4), second}, {24, 60, 60});
    if (!time && !defect_)
        defect_ = Defect{lines_[0].number, static_cast<int>(first) + 1, in_quotes(text),
                         "a calendar epoch from 1980 to 2269"};
    return time.value_or(GpsTime{});
}

void RecordFields::refuse(std::size_t line, std::size_t column, std::string found, std::string expected) {
    if (defect_) return;
    const int at = line < lines_.size() ? lines_[line].number : lines_.back().number;
    defect_ = Defect{at, static_cast<int>(text_column(line, column)) + 1, std::move(found), std::move(expected)};
}

// A number of the orbit or the clock. The limits are some ten times those that the bits of the messages allow
// (IS-GPS-200, tables 20-I and 20-III); angles may be written 0 … 2π.
struct KeplerField {
    FieldRule rule;
    double KeplerEphemeris::*value;
};

using Eph = KeplerEphemeris;
constexpr double full_turn = 7;
constexpr std::array<KeplerField, 18> kepler_fields{{
    {{0, 1, "the clock offset", -1, 1, false}, &Eph::af0},
    {{0, 2, "the clock drift", -1e-6, 1e-6, false}, &Eph::af1},
    {{0, 3, "the clock drift rate", -1e-9, 1e-9, false}, &Eph::af2},
    {{1, 1, "Crs", -1e5, 1e5, false}, &Eph::crs},
    {{1, 2, "delta n", -1e-6, 1e-6, false}, &Eph::delta_n},
    {{1, 3, "M0", -full_turn, full_turn, true}, &Eph::m0},
    {{2, 0, "Cuc", -1e-2, 1e-2, false}, &Eph::cuc},
    {{2, 1, "the eccentricity", 0, 0.5, true}, &Eph::e},
    {{2, 2, "Cus", -1e-2, 1e-2, false}, &Eph::cus},
    {{2, 3, "the square root of the semi-major axis", 4000, 8000, true}, &Eph::sqrt_a},
    {{3, 1, "Cic", -1e-2, 1e-2, false}, &Eph::cic},
    {{3, 2, "OMEGA0", -full_turn, full_turn, true}, &Eph::omega0},
    {{3, 3, "Cis", -1e-2, 1e-2, false}, &Eph::cis},
    {{4, 0, "i0", -full_turn, full_turn, true}, &Eph::i0},
    {{4, 1, "Crc", -1e5, 1e5, false}, &Eph::crc},
    {{4, 2, "the argument of perigee", -full_turn, full_turn, true}, &Eph::omega},
    {{4, 3, "OMEGA DOT", -1e-5, 1e-5, false}, &Eph::omega_dot},
    {{5, 0, "IDOT", -1e-6, 1e-6, false}, &Eph::idot},
}};
constexpr KeplerField legacy_accuracy{{6, 0, "the accuracy", -1, 1e12, false}, &Eph::accuracy_m};
constexpr KeplerField legacy_delay{{6, 2, "the group delay", -1e-3, 1e-3, false}, &Eph::tgd};

// Galileo's data sources: bits 0 and 2 I/NAV, 1 F/NAV; bit 8: the clock is of E5a, E1 (F/NAV), bit 9: of E5b, E1
// (RINEX 3.05, table A8).
NavigationMessage galileo_message(int sources) {
    constexpr int fnav_bit = 1 << 1, clock_e5a = 1 << 8, clock_e5b = 1 << 9;
    if ((sources & clock_e5b) != 0) return NavigationMessage::inav;
    const bool fnav = (sources & clock_e5a) != 0 || (sources & 0b111) == fnav_bit;
    return fnav ? NavigationMessage::fnav : NavigationMessage::inav;
}

// Eight lines (RINEX 3.05, tables A6, A8, A12, A14, A18).
class KeplerReading {
public:
    KeplerReading(const RecordKind& kind, RecordFields& fields) : kind_(kind), fields_(fields) {
        eph_.satellite = kind.satellite;
    }

    tl::expected<KeplerEphemeris, Defect> read() {
        for (const KeplerField& f : kepler_fields)
            eph_.*f.value = fields_.number(f.rule);
        if (kind_.layout != RecordLayout::legacy) return read_modern();
        for (const KeplerField& f : {legacy_accuracy, legacy_delay})
            eph_.*f.value = fields_.number(f.rule);
        eph_.iode = fields_.whole({1, 0, "the issue of data", 0, 65535, false});
        eph_.health = fields_.whole({6, 1, "the health", 0, 65535, false});
        system_fields();
        const double toe_tow = fields_.number({3, 0, "the toe", 0, static_cast<double>(seconds_per_week), true});
        // Those of BeiDou, where a record was moved to before 2006, are negative.
        const double first_week = beidou() ? -static_cast<double>(bdt_first_week) : 0;
        const double week = fields_.number({5, 2, "the week", first_week, 1e5, false});
        eph_.toc = fields_.epoch();
        if (!fields_.defect()) reference_time(toe_tow, week);
        if (fields_.defect()) return tl::make_unexpected(*fields_.defect());
        if (beidou()) {  // whose calendar epochs, toe and weeks are those of BDT
            eph_.toc += bdt_lag;
            eph_.toe += bdt_lag;
        }
        return eph_;
    }

private:
    [[nodiscard]] bool beidou() const { return kind_.satellite.constellation == Constellation::beidou; }

    // What stands where depends on the system.
    void system_fields() {
        switch (kind_.satellite.constellation) {
            case Constellation::galileo:
                eph_.message =
                    kind_.message.value_or(galileo_message(fields_.whole({5, 1, "the data sources", 0, 65535, false})));
                eph_.tgd2 = fields_.number({6, 3, "the group delay", -1e-3, 1e-3, false});
                break;
            case Constellation::beidou:
                eph_.message = kind_.message.value_or(is_beidou_geo(kind_.satellite) ? NavigationMessage::d2
                                                                                     : NavigationMessage::d1);
                eph_.tgd2 = fields_.number({6, 3, "the group delay", -1e-3, 1e-3, false});
                eph_.iodc = fields_.whole({7, 1, "AODC", 0, 65535, false});
                break;
            case Constellation::navic:
                break;
            default:
                eph_.iodc = fields_.whole({6, 3, "IODC", 0, 65535, false});
                eph_.fit_interval_h = fields_.number({7, 1, "the fit interval", -1e12, 1e12, false});
        }
    }

    // The orbit of CNAV and its like is that of LNAV with two rates. The reference time of GPS's is that of the clock,
    // and no issue is told; what BeiDou's accuracies are in metres no document says.
    tl::expected<KeplerEphemeris, Defect> read_modern() {
        eph_.message = NavigationMessage::modern;
        eph_.axis_rate = fields_.number({1, 0, "the rate of the axis", -10, 10, false});
        eph_.delta_n_rate = fields_.number({5, 1, "the rate of delta n", -1e-9, 1e-9, false});
        const double toe_tow = fields_.number({3, 0, "the toe", 0, static_cast<double>(seconds_per_week), true});
        if (beidou()) {
            const std::size_t health_line = kind_.layout == RecordLayout::b_cnav3 ? 7 : 8;
            eph_.accuracy_m = usual_accuracy_m;
            eph_.health = fields_.whole({health_line, 1, "the health", 0, 65535, false});
            if (kind_.layout == RecordLayout::b_cnav) {
                eph_.iodc = fields_.whole({8, 3, "IODC", 0, 65535, false});
                eph_.iode = fields_.whole({9, 3, "IODE", 0, 65535, false});
            }
        } else {
            eph_.accuracy_m = modern_accuracy(fields_.number({6, 0, "the accuracy index", -16, 15, false}));
            eph_.health = fields_.whole({6, 1, "the health", 0, 65535, false});
            // 9.999E+09 and the like stand for an unknown one.
            const double delay = fields_.number({6, 2, "the group delay", -1e12, 1e12, false});
            eph_.tgd = std::abs(delay) < 1e-3 ? delay : 0;
        }
        eph_.toc = fields_.epoch();
        eph_.toe = eph_.toc;
        if (!fields_.defect() && beidou()) reference_time(toe_tow, 0);
        if (fields_.defect()) return tl::make_unexpected(*fields_.defect());
        if (beidou()) {
            eph_.toc += bdt_lag;
            eph_.toe += bdt_lag;
        } else {
            constexpr std::int64_t step_s = 300, issues = 256;
            eph_.iode = eph_.iodc =
                static_cast<int>(week_and_tow(eph_.toe).tow / std::chrono::seconds(step_s) % issues);
        }
        return eph_;
    }

    // The upper bound of URA_ED by its index (IS-GPS-200N, 30.3.3.1.1.4); −16 and 15 are no prediction.
    static double modern_accuracy(double index) {
        constexpr std::array<double, 30> bounds{0.01,  0.02, 0.03, 0.04, 0.06, 0.08, 0.11, 0.15, 0.21, 0.3,
                                                0.43,  0.6,  0.85, 1.2,  1.7,  2.4,  3.4,  4.85, 6.85, 9.65,
                                                13.65, 24,   48,   96,   192,  384,  768,  1536, 3072, 6144};
        const auto place = static_cast<std::int64_t>(std::llround(index)) + 15;
        constexpr double none_predicted = 8192;
        return place < 0 || place >= static_cast<std::int64_t>(bounds.size()) ? none_predicted
                                                                              : bounds[static_cast<std::size_t>(place)];
    }
    static constexpr double usual_accuracy_m = 2;

    // toe is the instant with that time of week that lies nearest to the clock's epoch; the week must tell of the same.
    void reference_time(double toe_tow, double week) {
        const std::int64_t toc_week = week_and_tow(eph_.toc).week;
        eph_.toe = to_gps_time(toc_week, toe_tow);
        constexpr Nanoseconds week_length = std::chrono::seconds(seconds_per_week);
        if (eph_.toe - eph_.toc > week_length / 2) eph_.toe -= week_length;
        if (eph_.toc - eph_.toe > week_length / 2) eph_.toe += week_length;
        if (std::chrono::abs(eph_.toe - eph_.toc) > std::chrono::days(1))
            return fields_.refuse(3, 0, fmt::format("toe {} s", toe_tow), "toe within a day of the record's epoch");
        if (kind_.layout == RecordLayout::legacy && !fields_.blank(5, 2))
            check_week(static_cast<std::int64_t>(std::llround(week)));
    }

    void check_week(std::int64_t stated) {
        const std::int64_t toe_week = week_and_tow(eph_.toe).week;
        // Some writers give the week of transmission, which may be a neighbour of that of toe.
        const auto tells_toe = [&](std::int64_t w) { return std::abs(w - toe_week) <= 1; };
        const std::int64_t resolved = stated < 1024 ? resolve_week(stated, toe_week) : stated;
        if (tells_toe(resolved) || (beidou() && tells_toe(stated + bdt_first_week))) return;
        // Galileo's weeks are written as those of GPS, but its own, 1024 fewer, are met too.
        if (kind_.satellite.constellation == Constellation::galileo && tells_toe(stated + 1024)) return;
        fields_.refuse(5, 2, fmt::format("{} week {}", beidou() ? "BeiDou" : "GPS", stated),
                       fmt::format("week {}, that of the epoch", beidou() ? toe_week - bdt_first_week : toe_week));
    }

    const RecordKind& kind_;
    RecordFields& fields_;
    KeplerEphemeris eph_;
};

constexpr std::array<std::string_view, 3> axis_names{"X", "Y", "Z"};

// Position, velocity and acceleration, one axis a line, in kilometres.
template <class StateVector>
void read_state_vector(RecordFields& fields, StateVector& record) {
    constexpr double metres = 1000;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::size_t line = axis + 1;
        record.position_m[axis] = metres * fields.number({line, 0, axis_names[axis], -5e4, 5e4, true});
        record.velocity_mps[axis] = metres * fields.number({line, 1, "the velocity", -6, 6, true});
        record.acceleration_mps2[axis] = metres * fields.number({line, 2, "the acceleration", -1e-4, 1e-4, false});
    }
}

// What keeps an orbit from running through the Earth, where the equations of motion lose their meaning.
void check_radius(RecordFields& fields, const std::array<double, 3>& position, double least_km, double most_km) {
    const double radius_km = std::hypot(position[0], position[1], position[2]) / 1000;
    if (!fields.defect() && !(radius_km >= least_km && radius_km <= most_km))
        fields.refuse(1, 0, fmt::format("a satellite {:.0f} km from the Earth's centre", radius_km),
                      fmt::format("{} to {} km", least_km, most_km));
}

// Four lines, or the five of version 3.05 and later (RINEX 3.05, table A10).
tl::expected<GlonassEphemeris, Defect> read_glonass_record(const RecordKind& kind, RecordFields& fields) {
    GlonassEphemeris eph;
    eph.satellite = kind.satellite;
    eph.clock_bias = fields.number({0, 1, "the clock offset", -1, 1, false});
    eph.clock_drift = fields.number({0, 2, "the relative frequency offset", -1e-6, 1e-6, false});
    read_state_vector(fields, eph);
    check_radius(fields, eph.position_m, 20000, 32000);
    eph.health = fields.whole({1, 3, "the health", 0, 255, false});
    eph.frequency_channel = fields.whole({2, 3, "the frequency channel", -13, 255, false});
    if (eph.frequency_channel > 128) eph.frequency_channel -= 256;  // a signed byte written without its sign
    if (!fields.defect() && (eph.frequency_channel < -13 || eph.frequency_channel > 24))
        fields.refuse(2, 3, fmt::format("frequency channel {}", eph.frequency_channel), "a channel from -13 to 24");
    if (fields.line_count() > 4) {
        // 999999999999e-3 and the like stand for an unknown delay.
        const double delay = fields.number({4, 1, "the delay of L2", -1e12, 1e12, false});
        if (std::abs(delay) < 1e-6) eph.group_delay_l2 = delay;
        const int index = fields.whole({4, 2, "the accuracy index", -1e9, 1e9, false});
        if (index >= 0 && index < static_cast<int>(glonass_accuracies_m.size()))
            eph.accuracy_m = glonass_accuracies_m[static_cast<std::size_t>(index)];
    }
    const GpsTime utc = fields.epoch();
    if (fields.defect()) return tl::make_unexpected(*fields.defect());
    eph.toe = from_utc_count(utc.time_since_epoch(), LeapSeconds::announced());
    constexpr std::int64_t moscow_s = 3 * 3600, quarter_hour_s = 900;
    const std::int64_t of_day = std::chrono::floor<std::chrono::seconds>(utc.time_since_epoch()).count() + moscow_s;
    eph.iode = static_cast<int>(of_day % seconds_per_day / quarter_hour_s);
    return eph;
}

// Four lines (RINEX 3.05, table A16).
tl::expected<SbasEphemeris, Defect> read_sbas_record(const RecordKind& kind, RecordFields& fields) {
    SbasEphemeris eph;
    eph.satellite = kind.satellite;
    eph.clock_bias = fields.number({0, 1, "the clock offset", -1, 1, false});
    eph.clock_drift = fields.number({0, 2, "the relative frequency offset", -1e-6, 1e-6, false});
    read_state_vector(fields, eph);
    check_radius(fields, eph.position_m, 35000, 50000);
    eph.health = fields.whole({1, 3, "the health", 0, 65535, false});
    eph.accuracy_m = fields.number({2, 3, "the accuracy", -1, 1e12, false});
    eph.iode = fields.whole({3, 3, "the issue of data", 0, 65535, false});
    eph.toe = fields.epoch();
    if (fields.defect()) return tl::make_unexpected(*fields.defect());
    return eph;
}

}  // namespace

bool begins_record(std::string_view line, int major) { return !is_blank(columns(line, 0, major == 2 ? 2 : 1)); }

std::optional<SatelliteId> record_satellite(std::string_view line, int major, Constellation system) {
    if (major != 2) return parse_satellite(columns(line, 0, 3));
    const std::optional<int> number = whole_field(columns(line, 0, 2));
    if (!number || *number < 1) return std::nullopt;
    return SatelliteId{system, *number};
}

tl::expected<Ephemeris, Defect> read_record(const RecordKind& kind, std::span<const Line> lines) {
    RecordFields fields(lines, kind.major);
    switch (kind.satellite.constellation) {
        case Constellation::glonass:
            return read_glonass_record(kind, fields);
        case Constellation::sbas:
            return read_sbas_record(kind, fields);
        default:
            return KeplerReading(kind, fields).read();
    }
}

}  // namespace skyloop::inline world::rinex
