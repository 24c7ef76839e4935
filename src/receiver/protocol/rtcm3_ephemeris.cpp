#include "receiver/protocol/rtcm3_ephemeris.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "detail/rtcm3_ephemeris_fields.hpp"
#include "world/gnss/broadcast_galileo.hpp"
#include "world/gnss/broadcast_lnav.hpp"

namespace skyloop::inline receiver {
namespace {

using namespace std::chrono_literals;

class FieldPutter {
public:
    explicit FieldPutter(BitWriter& bits) : bits_(bits) {}
    void whole(std::string_view, std::int64_t number, int width) { bits_.put_signed(number, width); }
    void time(std::string_view, std::int64_t steps, int width, int) { bits_.put_signed(steps, width); }
    void scaled(std::string_view, double value, int width, double step) {
        const std::int64_t limit = std::int64_t{1} << (width - 1);
        bits_.put_signed(quantised(value, step, -limit, limit - 1), width);
    }
    void unsigned_scaled(std::string_view, double value, int width, double step) {
        bits_.put_signed(quantised(value, step, 0, (std::int64_t{1} << width) - 1), width);
    }
    // +π is −π: the complement wraps by itself.
    void circle(std::string_view, double radians) {
        constexpr std::int64_t half = std::int64_t{1} << 31;
        const double turns = std::isfinite(radians) ? std::remainder(radians, 2 * sc) : 0;
        bits_.put_signed(quantised(turns, sc * step(-31), -half, half), 32);
    }
    void magnitude(std::string_view, double value, int width, double step) {
        bits_.put(std::signbit(value) ? 1 : 0, 1);
        unsigned_scaled({}, std::abs(value), width - 1, step);
    }
    void skip(int width) { bits_.put(0, width); }

private:
    BitWriter& bits_;
};

class FieldGetter {
public:
    explicit FieldGetter(BitReader& bits) : bits_(bits) {}
    void whole(std::string_view, std::int64_t& number, int width) {
        number = static_cast<std::int64_t>(bits_.get(width));
    }
    void time(std::string_view name, std::int64_t& steps, int width, int) { whole(name, steps, width); }
    void scaled(std::string_view, double& value, int width, double step) {
        value = static_cast<double>(bits_.get_signed(width)) * step;
    }
    void unsigned_scaled(std::string_view, double& value, int width, double step) {
        value = static_cast<double>(bits_.get(width)) * step;
    }
    void circle(std::string_view name, double& radians) { scaled(name, radians, 32, sc * step(-31)); }
    void magnitude(std::string_view, double& value, int width, double step) {
        const bool negative = bits_.get(1) != 0;
        value = static_cast<double>(bits_.get(width - 1)) * (negative ? -step : step);
    }
    void skip(int width) { bits_.skip(static_cast<std::size_t>(width)); }

private:
    BitReader& bits_;
};

constexpr double unknown_accuracy_m = 8192;  // beyond that of index 14

// The middle of an index as IS-GPS-200, 20.3.3.3.1.3, names it, and RINEX after it.
double lnav_accuracy_m(std::int64_t index) {
    constexpr std::array<double, 15> metres{2, 2.8, 4, 5.7, 8, 11.3, 16, 32, 64, 128, 256, 512, 1024, 2048, 4096};
    return index < 15 ? metres[static_cast<std::size_t>(index)] : unknown_accuracy_m;
}

// OS SIS ICD 2.0, table 82; 126 to 254 are spare.
double sisa_m(std::int64_t index) {
    const auto i = static_cast<double>(index);
    if (index < 50) return 0.01 * i;
    if (index < 75) return 0.5 + 0.02 * (i - 50);
    if (index < 100) return 1 + 0.04 * (i - 75);
    return index <= 125 ? 2 + 0.16 * (i - 100) : -1;
}

// What the systems count by.
struct SystemTime {
    Nanoseconds lag{0};           // behind GPST
    std::int64_t first_week = 0;  // of its own, in weeks of GPST
    std::int64_t weeks = 1024;    // after which they begin again
    int toe_step_s = 16;
};
SystemTime system_time(Constellation constellation) {
    switch (constellation) {
        case Constellation::beidou:
            return {bdt_lag, bdt_first_week, 8192, 8};
        case Constellation::galileo:
            return {0s, 1024, 4096, 60};
        default:
            return {};
    }
}

std::int64_t time_field(GpsTime time, const SystemTime& of) {
    const std::int64_t steps_a_week = seconds_per_week / of.toe_step_s;
    return std::llround(week_and_tow(time - of.lag).tow_seconds() / of.toe_step_s) % steps_a_week;
}

// The instant with that time of week that is nearest.
GpsTime time_of_field(std::int64_t field, const SystemTime& of, GpsTime near) {
    constexpr Nanoseconds week = std::chrono::seconds(seconds_per_week);
    const GpsTime of_week = to_gps_time(week_and_tow(near - of.lag).week, static_cast<double>(field * of.toe_step_s));
    const GpsTime time = of_week + of.lag;
    if (time - near > week / 2) return time - week;
    return near - time > week / 2 ? time + week : time;
}

bool week_is_near(std::int64_t week, const SystemTime& of, GpsTime near) {
    const std::int64_t here = week_and_tow(near - of.lag).week - of.first_week;
    const std::int64_t apart = ((here - week) % of.weeks + of.weeks) % of.weeks;
    return apart <= 1 || apart == of.weeks - 1;
}

// Galileo's bits as RINEX has them (3.05, table A8): of E1-B, E5a, E5b data validity, then two of the signal's health.
void spread_health(KeplerFields& m, int health) {
    m.e1_invalid = health & 1;
    m.e1_status = health >> 1 & 3;
    m.e5a_invalid = health >> 3 & 1;
    m.e5a_status = health >> 4 & 3;
    m.e5b_invalid = health >> 6 & 1;
    m.e5b_status = health >> 7 & 3;
}
int joined_health(const KeplerFields& m) {
    return static_cast<int>(m.e1_invalid | m.e1_status << 1 | m.e5a_invalid << 3 | m.e5a_status << 4 |
                            m.e5b_invalid << 6 | m.e5b_status << 7);
}

KeplerFields fields_of(const KeplerEphemeris& r, GpsTime sent) {
    const SystemTime time = system_time(r.satellite.constellation);
    const bool qzss = r.satellite.constellation == Constellation::qzss;
    const bool galileo = r.satellite.constellation == Constellation::galileo;
    KeplerFields m;
    m.r = r;
    m.satellite = r.satellite.number;
    m.week = (week_and_tow(sent - time.lag).week - time.first_week) % time.weeks;
    m.accuracy = galileo ? inav_accuracy_index(r.accuracy_m) : lnav_accuracy_index(r.accuracy_m);
    m.toe = time_field(r.toe, time);
    m.toc = time_field(r.toc, time);
    m.issue = r.iode;
    m.clock_issue = r.iodc;
    m.health = r.satellite.constellation == Constellation::beidou ? (r.health != 0 ? 1 : 0) : r.health;
    // As the satellites send them (IS-GPS-200, 20.3.3.3.1.2; IS-QZSS-PNT, LNAV, subframe 1).
    m.codes_on_l2 = qzss ? 2 : 1;
    m.fit = qzss ? (r.fit_interval_h == 1 || r.fit_interval_h > 2 ? 1 : 0) : (r.fit_interval_h > 4 ? 1 : 0);
    if (galileo) spread_health(m, r.health);
    return m;
}

struct NumberedSystem {
    int number;
    Constellation constellation;
    NavigationMessage message;
};
constexpr std::array<NumberedSystem, 6> kepler_systems{{{1019, Constellation::gps, NavigationMessage::lnav},
                                                        {1041, Constellation::navic, NavigationMessage::lnav},
                                                        {1042, Constellation::beidou, NavigationMessage::d1},
                                                        {1044, Constellation::qzss, NavigationMessage::lnav},
                                                        {1045, Constellation::galileo, NavigationMessage::fnav},
                                                        {1046, Constellation::galileo, NavigationMessage::inav}}};
constexpr int glonass_1020 = 1020, first_channel_of_glonass = -7;

void complete(KeplerFields& m, const NumberedSystem& of, GpsTime near) {
    const SystemTime time = system_time(of.constellation);
    const bool galileo = of.constellation == Constellation::galileo;
    KeplerEphemeris& r = m.r;
    r.satellite = {of.constellation, static_cast<int>(m.satellite)};
    r.message = is_beidou_geo(r.satellite) ? NavigationMessage::d2 : of.message;
    r.toe = time_of_field(m.toe, time, near);
    r.toc = time_of_field(m.toc, time, near);
    r.iode = static_cast<int>(m.issue);
    r.iodc = static_cast<int>(m.clock_issue);
    r.health = galileo ? joined_health(m) : static_cast<int>(m.health);
    r.accuracy_m = galileo ? sisa_m(m.accuracy) : lnav_accuracy_m(m.accuracy);
    // Of QZSS the flag itself, of GPS the least interval that the flag means (RINEX 3.05, tables A6, A12).
    if (of.constellation == Constellation::qzss) r.fit_interval_h = static_cast<double>(m.fit);
    if (of.constellation == Constellation::gps) r.fit_interval_h = m.fit != 0 ? 6 : 4;
}

// Seconds of GLONASS time, UTC + 3 h, since 1980-01-06 00:00 of its own.
constexpr std::int64_t moscow_offset_s = 3 * 3600, tb_step_s = 900;
std::int64_t moscow_seconds(GpsTime time, const LeapSeconds& leap_seconds) {
    return std::chrono::floor<std::chrono::seconds>(time.time_since_epoch()).count() - leap_seconds.offset(time) +
           moscow_offset_s;
}

std::int64_t accuracy_factor_of(double metres) {
    for (std::size_t i = 0; i < glonass_accuracies_m.size(); ++i)
        if (metres <= glonass_accuracies_m[i]) return static_cast<std::int64_t>(i);
    return static_cast<std::int64_t>(glonass_accuracies_m.size());
}

// The date as GLONASS counts it: days of four years that begin with a leap year, from 1996 on (table 4.5, N_T and N_4).
void put_date(GlonassFields& m, std::int64_t of_moscow) {
    constexpr std::int64_t days_to_1996 = 5839, days_in_four_years = 1461;  // from 1980-01-06
    const std::int64_t days = std::max<std::int64_t>(of_moscow / seconds_per_day - days_to_1996, 0);
    m.day = days % days_in_four_years + 1;
    m.four_years = days / days_in_four_years + 1;
}

GlonassFields fields_of(const GlonassEphemeris& r, GpsTime sent, const LeapSeconds& leap_seconds) {
    constexpr std::int64_t frame_s = 30, glonass_m = 1, own_corrections = 0b11, five_almanacs = 1, half_hours = 1;
    const std::int64_t now = moscow_seconds(sent, leap_seconds), reference = moscow_seconds(r.toe, leap_seconds);
    GlonassFields m;
    m.r = r;
    m.tau = -r.clock_bias;
    m.satellite = r.satellite.number;
    m.channel = r.frequency_channel - first_channel_of_glonass;
    m.almanac_health = r.healthy() ? 1 : 0;  // C_n
    m.almanac_health_told = 1;
    m.p1 = half_hours;
    m.hours = now % seconds_per_day / 3600;
    m.minutes = now / 60 % 60;
    m.half_minute = now / frame_s % 2;
    m.malfunction = m.unhealthy = r.healthy() ? 0 : 1;
    m.reference = (reference % seconds_per_day + tb_step_s / 2) / tb_step_s % (seconds_per_day / tb_step_s);
    m.p2 = m.reference & 1;
    m.p3 = five_almanacs;
    m.p = own_corrections;
    m.accuracy = accuracy_factor_of(r.accuracy_m);
    m.kind = glonass_m;
    m.more = 1;  // N_4 is told
    put_date(m, now);
    return m;
}

std::optional<Ephemeris> completed(GlonassFields& m, GpsTime near, const LeapSeconds& leap_seconds) {
    constexpr std::int64_t half_day = seconds_per_day / 2;
    if (m.satellite < 1 || m.reference >= seconds_per_day / tb_step_s) return std::nullopt;
    const std::int64_t now = moscow_seconds(near, leap_seconds);
    std::int64_t toe = now - now % seconds_per_day + m.reference * tb_step_s;
    if (toe - now > half_day) toe -= seconds_per_day;
    if (now - toe > half_day) toe += seconds_per_day;
    GlonassEphemeris& r = m.r;
    r.satellite = {Constellation::glonass, static_cast<int>(m.satellite)};
    r.toe = from_utc_count(std::chrono::seconds(toe - moscow_offset_s), leap_seconds);
    r.clock_bias = -m.tau;
    r.frequency_channel = static_cast<int>(m.channel) + first_channel_of_glonass;
    r.iode = static_cast<int>(m.reference);
    r.health = (m.malfunction | m.unhealthy) != 0 ? 1 : 0;
    const auto factor = static_cast<std::size_t>(m.accuracy);
    r.accuracy_m = factor < glonass_accuracies_m.size() ? glonass_accuracies_m[factor] : 0;
    return r;
}

}  // namespace

std::optional<int> ephemeris_number(const Ephemeris& record) {
    if (std::holds_alternative<GlonassEphemeris>(record)) return glonass_1020;
    const auto* kepler = std::get_if<KeplerEphemeris>(&record);
    if (kepler == nullptr) return std::nullopt;
    // The messages of BeiDou's D1 and D2 are one.
    const auto message = kepler->message == NavigationMessage::d2 ? NavigationMessage::d1 : kepler->message;
    for (const NumberedSystem& one : kepler_systems)
        if (one.constellation == kepler->satellite.constellation && one.message == message) return one.number;
    return std::nullopt;
}

bool is_ephemeris_number(int number) {
    return number == glonass_1020 || std::any_of(kepler_systems.begin(), kepler_systems.end(),
                                                 [&](const NumberedSystem& one) { return one.number == number; });
}

Bytes encode_ephemeris(const Ephemeris& record, GpsTime sent, const LeapSeconds& leap_seconds) {
    const auto number = ephemeris_number(record);
    if (!number) return {};
    KeplerFields kepler;
    GlonassFields glonass;
    if (const auto* r = std::get_if<KeplerEphemeris>(&record)) kepler = fields_of(*r, sent);
    if (const auto* r = std::get_if<GlonassEphemeris>(&record)) glonass = fields_of(*r, sent, leap_seconds);
    BitWriter bits;
    bits.put_signed(*number, 12);
    FieldPutter putter(bits);
    ephemeris_fields(putter, *number, kepler, glonass);
    return encode_rtcm3(bits.bytes());
}

std::optional<Ephemeris> decode_ephemeris(const Rtcm3Message& message, GpsTime near, const LeapSeconds& leap_seconds) {
    KeplerFields kepler;
    GlonassFields glonass;
    BitReader bits(message.payload);
    bits.skip(12);
    FieldGetter getter(bits);
    if (!ephemeris_fields(getter, message.number, kepler, glonass) || !bits.ok()) return std::nullopt;
    if (message.number == glonass_1020) return completed(glonass, near, leap_seconds);
    const auto of = std::find_if(kepler_systems.begin(), kepler_systems.end(),
                                 [&](const NumberedSystem& one) { return one.number == message.number; });
    const SystemTime time = system_time(of->constellation);
    if (kepler.satellite < 1 || !week_is_near(kepler.week, time, near)) return std::nullopt;
    complete(kepler, *of, near);
    return kepler.r;
}

}  // namespace skyloop::inline receiver
