#include "firmware/messages/field_values.hpp"

#include <algorithm>
#include <chrono>
#include <cstdlib>

#include "firmware/core/navigation_state.hpp"

namespace skyloop::firmware {
namespace {

using namespace std::chrono_literals;

constexpr Nanoseconds utc_rounding = 10ms;

// Keys of CFG-SIGNAL (RECEIVER.md 3.5.1).

// GPS and QZSS: L1 C/A 0, L2 CL 3 and 5, L5 Q 7 and 9 (RECEIVER.md 5.6).
std::uint8_t gps_like_signal(bool qzss, Signal signal) {
    switch (signal) {
        case Signal::l2:
            return qzss ? 5 : 3;
        case Signal::l5:
            return qzss ? 9 : 7;
        default:
            return 0;
    }
}

std::uint8_t galileo_signal(Signal signal) {
    if (signal == Signal::l5) return 4;   // E5a Q
    if (signal == Signal::e5b) return 6;  // E5b Q
    if (signal == Signal::e6) return 8;
    return 0;  // E1 C
}

// Satellites in geostationary orbits send D2 (BeiDou B1I ICD 3.0, 5.1).
std::uint8_t beidou_signal(SatelliteId satellite, Signal signal, bool b1c_for_b1i) {
    const bool d2 = is_beidou_geo(satellite);
    switch (signal) {
        case Signal::e5b:
            return d2 ? 3 : 2;
        case Signal::l1:
            return 5;
        case Signal::l5:
            return 7;
        case Signal::b3i:
            return d2 ? 10 : 4;
        default:
            return b1c_for_b1i ? 5 : d2 ? 1 : 0;
    }
}

}  // namespace

void put_split(double value, int parts, std::int32_t& whole, std::int8_t& rest) {
    const double number = std::isnan(value) ? 0 : value;
    const double limit = static_cast<double>(std::numeric_limits<std::int32_t>::max()) * parts;
    const double within = std::clamp(number, -limit, limit);
    const std::int64_t rounded = std::llround(within / parts);
    whole = static_cast<std::int32_t>(rounded);
    rest = static_cast<std::int8_t>(std::llround(within) - rounded * parts);
}

EpochTime epoch_time(GpsTime time) {
    const GpsTime rounded = std::chrono::floor<std::chrono::milliseconds>(time + 500us);
    const WeekAndTow value = week_and_tow(rounded);
    return {value.week, static_cast<std::uint32_t>(value.tow / 1ms),
            static_cast<std::int32_t>((time - rounded).count())};
}

std::int64_t reported_week(const NavigationState& state, const WeekAndTow& now) {
    // Before there is a time there is no week to change.
    if (!state.time.time || state.week_lag.value() == 0) return now.week;
    const double tow = now.tow_seconds(), lag = state.week_lag.value();
    return now.week - (tow < lag ? 1 : 0) + (tow >= static_cast<double>(seconds_per_week) + lag ? 1 : 0);
}

bool has_dops(const Fix& fix) {
    if (fix.type != FixType::dead_reckoning) return fix.has_position();
    return std::ranges::any_of(fix.satellites, [](const SatelliteStatus& s) { return s.used; });
}

ReportedTime reported_time(const ReportContext& context) {
    const NavigationState& state = context.state;
    if (state.time.time)
        return {state.epoch.fix.time - clock_ahead(state), state.epoch.fix.leap_seconds, state.leap_event};
    const auto week = context.config.first_week;
    const std::chrono::milliseconds running(nearest<std::uint32_t>(state.since_start.value() * 1e3));
    return {to_gps_time({week, Nanoseconds(0)}) + running, 0, std::nullopt};
}

LeapSeconds counted_leap_seconds(const ReportedTime& now) {
    if (!now.leap_event) return LeapSeconds::believed(now.time, now.leap_seconds);
    return LeapSeconds({{GpsTime{}, now.leap_event->before}, {now.leap_event->at, now.leap_event->after}});
}

UtcFields utc_fields(const ReportedTime& now) {
    const Nanoseconds since_epoch = now.time.time_since_epoch() + utc_rounding / 2;
    const GpsTime rounded(since_epoch - ((since_epoch % utc_rounding) + utc_rounding) % utc_rounding);
    UtcFields fields;
    fields.utc = to_utc(rounded, counted_leap_seconds(now));
    fields.nano =
        static_cast<std::int32_t>(fields.utc.nanosecond) + static_cast<std::int32_t>((now.time - rounded).count());
    return fields;
}

std::uint8_t utc_standard(const ReportContext& context) {
    constexpr std::uint8_t unknown = 15;
    if (!context.state.time.leap_seconds) return unknown;
    if (context.config.utc_standard != 0) return context.config.utc_standard & 0x0Fu;
    constexpr std::pair<Constellation, std::uint8_t> preferred[] = {
        {Constellation::gps, 3}, {Constellation::glonass, 6}, {Constellation::galileo, 5}, {Constellation::beidou, 7}};
    const auto& satellites = context.state.epoch.fix.satellites;
    for (const auto& [constellation, standard] : preferred)
        for (const SatelliteStatus& s : satellites)
            if (s.cn0 && s.id.constellation == constellation) return standard;
    return 3;
}

std::uint32_t time_accuracy_ns(const NavigationState& state) {
    if (!state.time.time) return unknown_accuracy;
    return nearest<std::uint32_t>(state.time.accuracy.value() * 1e9);
}

std::uint8_t fix_type_code(const Fix& fix) {
    switch (fix.type) {
        case FixType::none:
            return 0;
        case FixType::dead_reckoning:
            return 1;
        case FixType::fix_2d:
            return 2;
        case FixType::time_only:
            return 5;
        default:
            return 3;
    }
}

std::uint8_t carrier_solution(const Fix& fix) {
    return fix.type == FixType::rtk_fixed ? 2 : fix.type == FixType::rtk_float ? 1 : 0;
}

bool is_differential(const Fix& fix) { return fix.type == FixType::dgnss || carrier_solution(fix) != 0; }

std::uint8_t gnss_id(Constellation constellation) {
    constexpr std::uint8_t ids[] = {0, 1, 2, 3, 5, 6, 7};
    return ids[static_cast<std::size_t>(constellation)];
}

std::uint8_t sv_id(SatelliteId satellite) {
    const int number = satellite.constellation == Constellation::sbas ? satellite.number + 100 : satellite.number;
    return nearest<std::uint8_t>(number);
}

std::optional<std::uint8_t> ubx_single_number(SatelliteId satellite) {
    using enum Constellation;
    const int n = satellite.number;
    if (satellite.constellation == navic || (satellite.constellation == beidou && n > 37)) return std::nullopt;
    // By the constellation; BeiDou's first five stand apart from its others.
    constexpr int before_first[] = {0, 100, 210, 27, 192, 64};
    const bool apart = satellite.constellation == beidou && n <= 5;
    const int number = n + (apart ? 158 : before_first[static_cast<std::size_t>(satellite.constellation)]);
    if (number < 1 || number > 254) return std::nullopt;
    return static_cast<std::uint8_t>(number);
}

std::uint8_t signal_id(SatelliteId satellite, Signal signal, bool b1c_for_b1i) {
    switch (satellite.constellation) {
        case Constellation::gps:
        case Constellation::qzss:
            return gps_like_signal(satellite.constellation == Constellation::qzss, signal);
        case Constellation::galileo:
            return galileo_signal(signal);
        case Constellation::beidou:
            return beidou_signal(satellite, signal, b1c_for_b1i);
        case Constellation::glonass:
            return signal == Signal::g2 ? 2 : 0;
        default:
            return 0;
    }
}

std::uint8_t frequency_id(SatelliteId satellite, Signal signal, Hertz carrier) {
    if (satellite.constellation != Constellation::glonass) return 0;
    const double base = carrier_frequency(signal, 0).value();
    const double step = carrier_frequency(signal, 1).value() - base;
    return nearest<std::uint8_t>(std::round((carrier.value() - base) / step) + 7);
}

std::vector<Bytes> made_by(std::span<const UbxMaker> makers, UbxMessageId message, const ReportContext& context) {
    const auto row = std::ranges::find(makers, message, &UbxMaker::id);
    return row == makers.end() ? std::vector<Bytes>() : row->make(context);
}

bool direction_known(const SatelliteStatus& satellite, const NavigationState& state) {
    return state.position_known && (satellite.azimuth.rad() != 0 || satellite.elevation.rad() != 0);
}

}  // namespace skyloop::firmware
