#include "detail/kepler_record.hpp"

#include <fmt/format.h>

#include <array>
#include <chrono>
#include <cmath>

namespace skyloop::rinex {
namespace {

// A number of the orbit or the clock. The limits are some ten times those that the bits of the messages allow
// (IS-GPS-200, tables 20-I and 20-III); angles may be written 0 … 2π.
struct KeplerField {
    FieldRule rule;
    double KeplerEphemeris::*value;
};

using Eph = KeplerEphemeris;
constexpr double full_turn = 7;
constexpr std::array<KeplerField, 20> kepler_fields{{
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
    {{6, 0, "the accuracy", -1, 1e12, false}, &Eph::accuracy_m},
    {{6, 2, "the group delay", -1e-3, 1e-3, false}, &Eph::tgd},
}};

// Galileo's data sources: bits 0 and 2 I/NAV, 1 F/NAV; bit 8: the clock is of E5a, E1 (F/NAV), bit 9: of E5b, E1
// (RINEX 3.05, table A8).
NavigationMessage galileo_message(int sources) {
    constexpr int fnav_bit = 1 << 1, clock_e5a = 1 << 8, clock_e5b = 1 << 9;
    if ((sources & clock_e5b) != 0) return NavigationMessage::inav;
    const bool fnav = (sources & clock_e5a) != 0 || (sources & 0b111) == fnav_bit;
    return fnav ? NavigationMessage::fnav : NavigationMessage::inav;
}

class KeplerReading {
public:
    KeplerReading(const RecordKind& kind, RecordFields fields) : kind_(kind), fields_(std::move(fields)) {
        eph_.satellite = kind.satellite;
    }

    tl::expected<KeplerEphemeris, Defect> read() {
        for (const KeplerField& f : kepler_fields)
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

    // toe is the instant with that time of week that lies nearest to the clock's epoch; the week must tell of the same.
    void reference_time(double toe_tow, double week) {
        const std::int64_t toc_week = week_and_tow(eph_.toc).week;
        eph_.toe = to_gps_time(toc_week, toe_tow);
        constexpr Nanoseconds week_length = std::chrono::seconds(seconds_per_week);
        if (eph_.toe - eph_.toc > week_length / 2) eph_.toe -= week_length;
        if (eph_.toc - eph_.toe > week_length / 2) eph_.toe += week_length;
        if (std::chrono::abs(eph_.toe - eph_.toc) > std::chrono::days(1))
            return fields_.refuse(3, 0, fmt::format("toe {} s", toe_tow), "toe within a day of the record's epoch");
        if (!fields_.blank(5, 2)) check_week(static_cast<std::int64_t>(std::llround(week)));
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

    RecordKind kind_;
    RecordFields fields_;
    KeplerEphemeris eph_;
};

}  // namespace

tl::expected<KeplerEphemeris, Defect> read_kepler_record(const RecordKind& kind, RecordFields fields) {
    return KeplerReading(kind, std::move(fields)).read();
}

}  // namespace skyloop::rinex
