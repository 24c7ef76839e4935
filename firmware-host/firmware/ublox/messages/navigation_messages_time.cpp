// NAV-TIME…, NAV-CLOCK and TIM messages (RECEIVER.md 3.1, 3.2, 4.9).
#include <chrono>
#include <cmath>

#include "firmware/core/navigation_state.hpp"
#include "firmware/messages/field_values.hpp"
#include "firmware/messages/make_message.hpp"
#include "receiver/protocol/ubx_time.hpp"
#include "world/gnss/constants.hpp"

namespace skyloop::firmware {
namespace {

using namespace std::chrono_literals;

// CFG-TP: periods of the pulse, µs, and frequencies, Hz, before it is locked and after; which of them counts; whether
// there is one; the time that it is aligned to (RECEIVER.md 3.5.1).
// Values of CFG-TP-TIMEGRID; 1 is GPS.
constexpr std::uint64_t grid_utc = 0, grid_glonass = 2, grid_beidou = 3, grid_galileo = 4;
// Step of the oscillator by which a pulse can be moved: RECEIVER.md 4.9 has errors of ±15 ns.
constexpr double pulse_step_ns = 30;
constexpr std::int64_t ns_per_second = 1'000'000'000;

// Time of week, week and leap seconds.
std::uint8_t gnss_time_valid(const NavigationState& state) {
    const TimeKnowledge& known = state.time;
    return static_cast<std::uint8_t>((known.time ? 1 : 0) | (known.date ? 2 : 0) | (known.leap_seconds ? 4 : 0));
}

// Whole seconds of a time of week, and the rest: −5e8 … 5e8 ns.
struct WholeSeconds {
    std::int64_t week = 0;
    std::uint32_t seconds = 0;
    std::int32_t rest = 0;
    [[nodiscard]] WeekAndTow stamp() const { return {week, std::chrono::seconds(seconds) + Nanoseconds(rest)}; }
};
WholeSeconds whole_seconds(GpsTime time, WeekAndTow (*system)(GpsTime)) {
    const GpsTime rounded = std::chrono::floor<std::chrono::seconds>(time + 500ms);
    const WeekAndTow value = system(rounded);
    return {value.week, static_cast<std::uint32_t>(value.tow / 1s),
            static_cast<std::int32_t>((time - rounded).count())};
}

NavTimegps time_gps(const ReportContext& context) {
    const ReportedTime reported = reported_time(context);
    const EpochTime now = epoch_time(reported.time);
    const NavigationState& state = context.state;
    NavTimegps m{now.i_tow, now.f_tow, 0, 0, gnss_time_valid(state), time_accuracy_ns(state)};
    m.week = week_field<std::int16_t>(state, now.stamp());
    m.leap_s.set(state.epoch.fix.leap_seconds);
    return m;
}

NavTimeutc time_utc(const ReportContext& context) {
    const ReportedTime reported = reported_time(context);
    const UtcFields now = utc_fields(reported);
    const TimeKnowledge& time = context.state.time;
    NavTimeutc m;
    m.i_tow = epoch_time(reported.time).i_tow;
    m.t_acc = time_accuracy_ns(context.state);
    m.nano = now.nano;
    m.year = static_cast<std::uint16_t>(now.utc.year);
    m.month = static_cast<std::uint8_t>(now.utc.month);
    m.day = static_cast<std::uint8_t>(now.utc.day);
    m.hour = static_cast<std::uint8_t>(now.utc.hour);
    m.minute = static_cast<std::uint8_t>(now.utc.minute);
    m.second = static_cast<std::uint8_t>(now.utc.second);
    // Which UTC it is stands there from M8 on: LEA-4T and AEK-4T say 07.
    constexpr int first_with_standard = 8;
    const int standard = context.board.identity.generation >= first_with_standard ? utc_standard(context) : 0;
    m.valid = static_cast<std::uint8_t>((time.time ? 1 : 0) | (time.date ? 2 : 0) | (time.leap_seconds ? 4 : 0) |
                                        standard << 4);
    return m;
}

// The time of a system that counts weeks. @param ahead_of_gps_leaps its leap seconds that GPS does not count
template <class Message>
Message system_time(const ReportContext& context, WeekAndTow (*system)(GpsTime), int ahead_of_gps_leaps = 0) {
    const GpsTime time = reported_time(context).time;
    const WholeSeconds now = whole_seconds(time, system);
    return {epoch_time(time).i_tow,
            now.seconds,
            now.rest,
            week_field<std::int16_t>(context.state, now.stamp()),
            nearest<std::int8_t>(context.state.epoch.fix.leap_seconds - ahead_of_gps_leaps),
            gnss_time_valid(context.state),
            time_accuracy_ns(context.state)};
}

NavTimegal time_galileo(const ReportContext& context) { return system_time<NavTimegal>(context, gst_week_and_tow); }
// QZSS counts weeks and leap seconds as GPS does.
NavTimeqzss time_qzss(const ReportContext& context) { return system_time<NavTimeqzss>(context, week_and_tow); }
NavTimebds time_beidou(const ReportContext& context) {
    return system_time<NavTimebds>(context, bdt_week_and_tow, bdt_lag / 1s);
}

// GLONASS time is UTC and three hours; days count in cycles of four years from 1996 (ICD L1, L2 GLONASS 5.1, 4.4).
NavTimeglo time_glonass(const ReportContext& context) {
    using std::chrono::sys_days;
    constexpr int days_of_cycle = 1461, seconds_of_day = 86400;
    constexpr auto first_day = (sys_days(std::chrono::year(1996) / 1 / 1) - sys_days(std::chrono::year(1980) / 1 / 6));
    const ReportedTime reported = reported_time(context);
    const GpsTime rounded = std::chrono::floor<std::chrono::seconds>(reported.time + 500ms);
    const std::int64_t count = (rounded.time_since_epoch() + 3h) / 1s - reported.leap_seconds;
    const std::int64_t days = std::max<std::int64_t>(0, count / seconds_of_day - first_day.count());
    NavTimeglo m;
    m.i_tow = epoch_time(reported.time).i_tow;
    m.tod = static_cast<std::uint32_t>((count % seconds_of_day + seconds_of_day) % seconds_of_day);
    m.f_tod = static_cast<std::int32_t>((reported.time - rounded).count());
    m.n_t = static_cast<std::uint16_t>(days % days_of_cycle + 1);
    const auto cycles = days / days_of_cycle;
    m.n_4.set(static_cast<double>(cycles + 1));
    m.valid = static_cast<std::uint8_t>((context.state.time.time ? 1 : 0) | (context.state.time.date ? 2 : 0));
    m.t_acc = time_accuracy_ns(context.state);
    return m;
}

void put_leap_event(GpsTime now, const LeapSeconds::Step& event, int change, NavTimels& m) {
    m.ls_change = nearest<std::int8_t>(event.from > now ? change : 0);
    m.time_to_ls_event.set(difference(event.from, now).value());
    // The day at whose end it comes: 1 is Sunday, 7 Saturday.
    const WeekAndTow day = week_and_tow(event.from - std::chrono::hours(12));
    m.date_of_ls_gps_wn.set(static_cast<double>(day.week));
    m.date_of_ls_gps_dn = static_cast<std::uint16_t>(day.tow / std::chrono::hours(24) + 1);
}

// Of the last event or, once it is broadcast (half a year before, IERS Bulletin C), of the coming one.
void put_announced_leap_event(GpsTime now, NavTimels& m) {
    constexpr auto announced_before = std::chrono::hours(24 * 182);
    const LeapSeconds::Step* event = nullptr;
    int change = 0, offset = 0;
    for (const LeapSeconds::Step& step : LeapSeconds::announced().steps()) {
        if (step.from - announced_before > now) break;
        change = step.offset - offset;
        offset = step.offset;
        event = &step;
    }
    if (event != nullptr) put_leap_event(now, *event, change, m);
}

// srcOfCurrLs; srcOfLsChange has 6 for GLONASS. What was known from before the run was told by the first of the systems
// that are on.
std::uint8_t leap_source_code(const ReportContext& context) {
    using enum Constellation;
    constexpr std::pair<Constellation, std::uint8_t> codes[] = {{gps, 2}, {galileo, 5}, {beidou, 4}, {glonass, 1}};
    for (const auto& [system, code] : codes)
        if (const auto& source = context.state.time.leap_source;
            source ? *source == system : context.config.has_on(system))
            return code;
    return codes[0].second;
}

NavTimels time_leap_seconds(const ReportContext& context) {
    constexpr std::uint8_t from_firmware = 0, glonass_difference = 1, change_from_glonass = 6;
    const ReportedTime reported = reported_time(context);
    NavTimels m;
    const GpsTime now = std::chrono::round<std::chrono::milliseconds>(reported.time);
    m.i_tow = epoch_time(now).i_tow;
    m.curr_ls.set(context.state.epoch.fix.leap_seconds);
    m.src_of_curr_ls = from_firmware;
    if (!context.state.time.leap_seconds) return m;
    m.src_of_curr_ls = leap_source_code(context);
    m.src_of_ls_change = m.src_of_curr_ls == glonass_difference ? change_from_glonass : m.src_of_curr_ls.raw;
    m.valid = 3;
    const auto& own = reported.leap_event;
    if (own)
        put_leap_event(now, {own->at, own->after}, own->after - own->before, m);
    else
        put_announced_leap_event(now, m);
    return m;
}

NavClock receiver_clock(const ReportContext& context) {
    const NavigationState& state = context.state;
    auto m = stamped<NavClock>(context);
    m.t_acc = time_accuracy_ns(state);
    m.f_acc = 3749500;  // ps/s, of captured receivers without a fix
    if (!estimates_known(state)) return m;
    const Fix& fix = state.epoch.fix;
    m.clk_b = static_cast<std::int32_t>(clock_ahead(state).count());
    m.clk_d.set(fix.clock_drift.value() / speed_of_light * 1e9);
    m.f_acc.set(fix.speed_accuracy.value() / speed_of_light * 1e12);
    return m;
}

// Pulses lie on a grid of UTC or a system's time, and are counted in GPS time, which goes on evenly over leap seconds.
// Those of a frequency, whatever their period, begin anew with each second. The receiver's own clock is a bit before or
// after the epoch that it means.
struct PulseGrid {
    GpsTime epoch;
    PulseRate rate;
    std::uint64_t base = 0;              ///< 0 UTC, 1 GPS, 2 GLONASS, 3 BeiDou, 4 Galileo
    std::optional<LeapSeconds> leaps{};  ///< of a grid of UTC: those that the receiver counts by

    // By how much the grid's time is behind GPS time. GLONASS counts UTC, three hours ahead.
    [[nodiscard]] Nanoseconds behind(GpsTime time) const {
        if (base == grid_beidou) return bdt_lag;
        const Nanoseconds of_utc = leaps ? std::chrono::seconds(leaps->offset(time)) : Nanoseconds(0);
        return base == grid_glonass ? of_utc - 3h : of_utc;
    }
    // Week and time of week by the grid's time.
    [[nodiscard]] WeekAndTow stamp(GpsTime time) const {
        if (base == grid_beidou) return bdt_week_and_tow(time);
        if (base == grid_galileo) return gst_week_and_tow(time);
        return week_and_tow(time - behind(time));
    }
    // Where the grid lies at `time`. Leap seconds are whole ones, which leave that of a frequency in its place.
    [[nodiscard]] Nanoseconds offset(GpsTime time) const {
        return rate.hertz > 0 ? Nanoseconds(0) : behind(time) % rate.period;
    }
    // Until the epoch, by the grid as it lies at `time`.
    [[nodiscard]] std::int64_t pulses(GpsTime time) const {
        const Nanoseconds since = epoch.time_since_epoch() - offset(time);
        if (rate.hertz > 0) return since / 1s * rate.hertz + (since % 1s).count() * rate.hertz / ns_per_second;
        return since / rate.period - (since % rate.period < Nanoseconds(0) ? 1 : 0);
    }
    [[nodiscard]] GpsTime next(GpsTime time) const {
        const std::int64_t pulse = pulses(time) + 1;
        if (rate.hertz == 0) return GpsTime(pulse * rate.period + offset(time));
        // To the nearest nanosecond.
        const std::int64_t part = (pulse % rate.hertz * ns_per_second + rate.hertz / 2) / rate.hertz;
        return GpsTime(pulse / rate.hertz * Nanoseconds(1s) + Nanoseconds(part));
    }
    // A leap second in between moves the grid.
    [[nodiscard]] GpsTime next() const { return next(next(epoch)); }
};

// Nothing: there are no pulses.
std::optional<PulseGrid> pulse_grid(const ReportContext& context) {
    const ReportedTime reported = reported_time(context);
    const PulseConfig& pulses = context.config.pulses;
    const PulseRate rate = context.state.epoch.fix.type != FixType::none ? pulses.locked : pulses.unlocked;
    if (rate.period <= Nanoseconds(0) && rate.hertz == 0) return std::nullopt;
    const std::uint64_t base = pulses.time_grid;
    PulseGrid grid{std::chrono::round<std::chrono::milliseconds>(reported.time), rate, base};
    if (base == grid_utc || base == grid_glonass) grid.leaps = counted_leap_seconds(reported);
    return grid;
}

// timeRefGnss: 0 GPS, 1 GLONASS, 2 BeiDou, 3 Galileo; captured receivers say 15 of UTC.
std::uint8_t reference_of(std::uint64_t base) {
    return base >= 1 && base <= 4 ? static_cast<std::uint8_t>(base - 1) : std::uint8_t{0x0F};
}

// The pulse after the epoch. Flags: 0 UTC base, 1 UTC available, 2-3 RAIM active, 4 quantisation unknown,
// 5 not locked to the time (from generation 9 on).
TimTp next_pulse(const ReportContext& context, const PulseGrid& grid) {
    const NavigationState& state = context.state;
    const GpsTime pulse = grid.next();
    const WeekAndTow value = grid.stamp(pulse);
    const Nanoseconds sub_ms = value.tow % 1ms;
    TimTp m;
    m.tow_ms = static_cast<std::uint32_t>(value.tow / 1ms);
    m.tow_sub_ms.set(static_cast<double>(sub_ms.count()) * 1e-6);
    m.week = week_field<std::uint16_t>(state, value);
    const bool known = state.epoch.fix.type != FixType::none;
    const int unknown = context.board.identity.generation > 8 ? 0x30 : 0x10;
    m.flags = static_cast<std::uint8_t>((grid.base == grid_utc ? 1 : 0) | (state.time.leap_seconds ? 2 : 0) |
                                        (known ? 8 : unknown));
    if (known)
        m.q_err.set(std::remainder(state.epoch.fix.clock_bias.value() / speed_of_light * 1e9, pulse_step_ns) * 1e3);
    m.ref_info = reference_of(grid.base);
    return m;
}

std::vector<Bytes> time_pulse(const ReportContext& context) {
    const auto grid = pulse_grid(context);
    return grid ? ubx_frames_of(next_pulse(context, *grid)) : std::vector<Bytes>();
}

constexpr UbxMaker time_makers[] = {{TimTp::message_id, time_pulse},
                                    maker<time_gps>,
                                    maker<time_utc>,
                                    maker<time_galileo>,
                                    maker<time_beidou>,
                                    maker<time_qzss>,
                                    maker<time_glonass>,
                                    maker<time_leap_seconds>,
                                    maker<receiver_clock>};

}  // namespace

std::optional<std::int64_t> pulses_until_epoch(const ReportContext& context) {
    const auto grid = pulse_grid(context);
    return grid ? std::optional(grid->pulses(grid->epoch)) : std::nullopt;
}

std::vector<Bytes> make_time_message(UbxMessageId message, const ReportContext& context) {
    return made_by(time_makers, message, context);
}

}  // namespace skyloop::firmware
