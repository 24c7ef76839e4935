// How the receiver is off, and what wakes it (u-blox M8 receiver description UBX-13003221, 13; NEO-M9N integration
// manual UBX-19014286, 3.11).
#include "firmware/power_save.hpp"

#include <algorithm>
#include <utility>

#include "firmware/config/config_keys.hpp"
#include "firmware/config/legacy_keys.hpp"
#include "firmware/receiver_core.hpp"
#include "receiver/protocol/ubx_cfg_device.hpp"
#include "receiver/protocol/ubx_mon.hpp"
#include "receiver/protocol/ubx_raw.hpp"
#include "world/gnss/constants.hpp"

namespace skyloop::firmware {
namespace {

using namespace std::chrono_literals;
using enum PowerSaveState;

constexpr Nanoseconds acquisition_period = 500ms;  // of on and off
constexpr Nanoseconds ephemeris_grid = 30min;
// With CFG-PM-WAITTIMEFIX there are to be fixes for so long.
constexpr Nanoseconds steady_fix = 2s;

Nanoseconds week() { return std::chrono::seconds(seconds_per_week); }

// From generation 9 on cyclic tracking is there at 2 and 1 Hz, and with periods of 2 s to 10 s in whole seconds.
bool is_cyclic_rate(std::uint64_t measurement_ms) {
    return measurement_ms == 500 || (measurement_ms % 1000 == 0 && measurement_ms >= 1000 && measurement_ms <= 10'000);
}

Nanoseconds period_of(const ConfigStore& store, std::uint32_t whole_s, std::uint32_t rest_ms) {
    const Nanoseconds period =
        std::chrono::seconds(store.value(whole_s)) + std::chrono::milliseconds(store.value(rest_ms));
    return std::min(period, week());
}

// Before generation 9 the update period says it, and the setups of CFG-PMS their own.
Nanoseconds cyclic_period_of(const ConfigStore& store, Nanoseconds update_period) {
    constexpr std::uint64_t aggressive_1_hz = 3, aggressive_2_hz = 4, aggressive_4_hz = 5;
    switch (store.value(legacy_key::pms_setup)) {
        case aggressive_1_hz:
            return 1s;
        case aggressive_2_hz:
            return 500ms;
        case aggressive_4_hz:
            return 250ms;
        default:
            return std::clamp<Nanoseconds>(update_period, 1s, 10s);
    }
}

bool is_solved(const NavigationState& report) {
    const Fix& fix = report.epoch.fix;
    return report.fix_ok && fix.has_position() && fix.type != FixType::dead_reckoning;
}

bool hears(const NavigationState& report) {
    const auto& satellites = report.epoch.fix.satellites;
    return std::any_of(satellites.begin(), satellites.end(), [](const SatelliteStatus& s) { return s.cn0; });
}

GpsTime next_half_hour(GpsTime after) { return after - after.time_since_epoch() % ephemeris_grid + ephemeris_grid; }

}  // namespace

PowerSaveSettings PowerSaveSettings::of(const ConfigStore& store, const BoardProfile& board) {
    PowerSaveSettings s;
    const std::uint64_t mode = board.power.save_modes ? store.value(key::pm_operate_mode) : 0;
    if (mode == 1) s.mode = PowerMode::on_off;
    if (mode == 2) s.mode = PowerMode::cyclic;
    const bool by_rate = board.identity.generation >= 9;
    if (s.mode == PowerMode::cyclic && by_rate && !is_cyclic_rate(store.value(key::rate_meas)))
        s.mode = PowerMode::full;
    const auto seconds = [&](std::uint32_t id) { return Seconds(static_cast<double>(store.value(id))); };
    s.update_period = period_of(store, key::pm_update_period, legacy_key::pm_update_rest);
    s.search_period = period_of(store, key::pm_search_period, legacy_key::pm_search_rest);
    s.grid_offset = period_of(store, key::pm_grid_offset, legacy_key::pm_grid_rest);
    if (!by_rate) s.cyclic_period = cyclic_period_of(store, s.update_period);
    s.on_time = seconds(key::pm_on_time);
    s.least_acquisition = seconds(key::pm_least_acquisition);
    s.longest_acquisition = seconds(key::pm_longest_acquisition);
    // The mask of the time is one of range, m.
    s.time_accuracy = seconds(key::navspg_tacc) / speed_of_light;
    s.wait_for_time = store.flag(key::pm_wait_for_time);
    s.never_off = store.flag(key::pm_never_off);
    s.update_ephemerides = store.flag(key::pm_update_ephemerides);
    // UTC, where several systems are at work.
    constexpr int first_with_several = 8;
    s.in_utc = board.identity.generation >= first_with_several;
    return s;
}

void PowerSave::adopt(const PowerSaveSettings& settings) {
    const bool same = settings.mode == settings_.mode;
    settings_ = settings;
    if (!same && (!saves() || state_ == inactive)) state_ = full_power;
}

void PowerSave::restart(bool knows_ephemerides) {
    state_ = full_power;
    solved_since_.reset();
    if (!knows_ephemerides) download_due_.reset();
}

void PowerSave::enter(PowerSaveState state, GpsTime now) {
    state_ = state;
    since_ = now;
    heard_ = false;
    // With the first fix it has them.
    if (state == tracking && !download_due_) download_due_ = next_half_hour(now);
}

std::optional<PowerSave::Rest> PowerSave::update(const NavigationState& report) {
    if (!saves()) return std::nullopt;
    const GpsTime now = report.epoch.fix.time;
    if (!is_solved(report))
        solved_since_.reset();
    else if (!solved_since_)
        solved_since_ = now;
    switch (state_) {
        case full_power:
        case inactive:
            enter(enabled, now);
            break;
        case enabled:
            enter(acquisition, now);
            break;
        case acquisition:
            if (may_track(report)) enter(tracking, now);
            break;
        case tracking:
        case optimized:
            track(now);
            break;
    }
    heard_ = heard_ || hears(report);
    std::optional<Rest> rest;
    if (state_ == acquisition && gives_up(now)) rest = rest_until_search(report);
    const bool goes_off = settings_.mode == PowerMode::on_off && state_ == tracking;
    if (goes_off && !downloads(now) && on_time_is_over(now)) rest = rest_until_update(report);
    return rest;
}

// Optimized tracking is left for tracking when signals are lost, or ephemerides are due; tracking for a search only
// when there is still no fix.
void PowerSave::track(GpsTime now) {
    if (state_ == tracking) {
        if (!solved_since_) return enter(acquisition, now);
        if (settings_.mode == PowerMode::cyclic && !downloads(now) && on_time_is_over(now)) enter(optimized, now);
        return;
    }
    const bool due = settings_.update_ephemerides && download_due_ && now >= *download_due_;
    if (settings_.mode != PowerMode::cyclic || !solved_since_ || due) enter(tracking, now);
}

bool PowerSave::may_track(const NavigationState& report) const {
    if (!solved_since_) return false;
    const GpsTime now = report.epoch.fix.time;
    if (!settings_.never_off && difference(now, since_) < settings_.least_acquisition) return false;
    if (!settings_.wait_for_time) return true;
    return report.time.time && report.time.accuracy <= settings_.time_accuracy && now - *solved_since_ >= steady_fix;
}

bool PowerSave::gives_up(GpsTime now) const {
    if (settings_.never_off) return false;
    const bool own = settings_.longest_acquisition.value() <= 0;
    Seconds limit = own ? ability_.acquisition : settings_.longest_acquisition;
    if (!heard_ && ability_.blind_acquisition.value() > 0) limit = std::min(limit, ability_.blind_acquisition);
    return difference(now, since_) >= std::max(limit, settings_.least_acquisition);
}

bool PowerSave::on_time_is_over(GpsTime now) const { return difference(now, since_) >= settings_.on_time; }

// Whether it has to go on tracking for ephemerides.
bool PowerSave::downloads(GpsTime now) {
    if (!settings_.update_ephemerides || !download_due_ || now < *download_due_) return false;
    if (difference(now, std::max(since_, *download_due_)) < ability_.download) return true;
    download_due_ = next_half_hour(now);
    return false;
}

// The grid begins anew with each week; before the time is known there is none.
GpsTime PowerSave::on_grid(GpsTime after, Nanoseconds period, const NavigationState& report) const {
    if (!report.time.time) return after + period;
    const Nanoseconds shift = std::chrono::seconds(settings_.in_utc ? report.epoch.fix.leap_seconds : 0);
    const Nanoseconds tow = (after.time_since_epoch() - shift) % week();
    const GpsTime begin = after - tow;
    const Nanoseconds first = settings_.grid_offset % period;
    if (tow < first) return begin + first;
    const Nanoseconds next = first + ((tow - first) / period + 1) * period;
    return next < week() ? begin + next : begin + week() + first;
}

PowerSave::Rest PowerSave::rest_until_update(const NavigationState& report) const {
    if (settings_.update_period <= 0s) return {};
    const GpsTime update = on_grid(report.epoch.fix.time, settings_.update_period, report);
    const bool downloads = settings_.update_ephemerides && download_due_;
    return {downloads ? std::min(update, *download_due_) : update};
}

PowerSave::Rest PowerSave::rest_until_search(const NavigationState& report) const {
    if (settings_.search_period <= 0s) return {};
    const Nanoseconds margin = std::min(to_nanoseconds(ability_.search_margin), settings_.search_period / 2);
    return {on_grid(report.epoch.fix.time + margin, settings_.search_period, report) - margin};
}

Nanoseconds PowerSave::navigation_period(Nanoseconds configured) const {
    const bool searches = state_ != tracking && state_ != optimized && state_ != inactive;
    if (settings_.mode == PowerMode::on_off && searches) return acquisition_period;
    const bool rests = settings_.mode == PowerMode::cyclic && state_ == optimized;
    return rests && settings_.cyclic_period > 0s ? settings_.cyclic_period : configured;
}

namespace {

using namespace std::chrono_literals;

// What wakes it: bits as in RXM-PMREQ, and one of our own.
constexpr std::uint32_t uart_rx = 1u << 3, extint_0 = 1u << 5, extint_1 = 1u << 6, spi_cs = 1u << 7,
                        usb_data = 1u << 31;
constexpr std::uint32_t every_pin = uart_rx | extint_0 | extint_1 | spi_cs;

constexpr std::uint32_t flag_backup = 1u << 1, flag_force = 1u << 2;
constexpr Nanoseconds longest_backup = std::chrono::hours(12 * 24);
// Ephemerides last so long: after more the start is no hot one.
constexpr Nanoseconds ephemeris_life = 4h;

// UART2 and I2C wake nobody.
std::uint32_t source_of(PortId port) {
    switch (port) {
        case PortId::uart1:
            return uart_rx;
        case PortId::spi:
            return spi_cs;
        case PortId::usb:
            return usb_data;
        case PortId::i2c:
        case PortId::uart2:
            break;
    }
    return 0;
}

}  // namespace

void Receiver::Core::follow_power() { settings_.navigation_period = power_.navigation_period(configured_period_); }

// RXM-PMREQ is a command without an answer. That it came by USB shows a host there, for which it stays on unless it is
// forced; without one it is woken by any pin in its short form, by those that it names in its longer one.
void Receiver::Core::request_backup(PortUnit& unit, const UbxFrameView& frame, GpsTime now) {
    RxmPmreq asked;
    asked.wakeup_sources = every_pin;
    if (const auto whole = decode_payload<RxmPmreq>(frame.payload)) {
        asked = *whole;
    } else if (const auto brief = decode_payload<RxmPmreqShort>(frame.payload)) {
        asked.duration = brief->duration;
        asked.flags = brief->flags;
    } else {
        return;
    }
    const bool forced = (asked.flags & flag_force) != 0;
    const bool stays_on = !forced && (unit.id == PortId::usb || board_.power.backup_needs_force);
    if (asked.version != 0 || (asked.flags & flag_backup) == 0 || stays_on) return;
    Sleep sleep{.until = {}, .wakes = asked.wakeup_sources & every_pin};
    if (asked.duration > 0)
        sleep.until = now + std::min<Nanoseconds>(std::chrono::milliseconds(asked.duration), longest_backup);
    fall_asleep(sleep, answer_time(now, Seconds(0)));
}

// CFG-PWR: on, GNSS stopped, or backup without USB.
void Receiver::Core::change_power_state(PortUnit& unit, const UbxFrameView& frame, GpsTime now) {
    values_.cancel();
    const auto asked = decode_payload<CfgPwr>(frame.payload);
    const bool known = asked && asked->version == 1 &&
                       (asked->state == power_run || asked->state == power_stop || asked->state == power_backup);
    const Bytes verdict = known ? encode_frame(AckAck{frame.id.message_class, frame.id.id})
                                : encode_frame(AckNak{frame.id.message_class, frame.id.id});
    reply(unit, {{}, verdict, Seconds(0), frame.id}, now);
    if (!known) return;
    if (asked->state == power_backup) return fall_asleep({.until = {}, .wakes = every_pin}, last_answer_);
    switch_navigating(asked->state == power_run, now);
}

void Receiver::Core::stand_by(GpsTime from) { fall_asleep({.until = {}, .wakes = every_pin | usb_data}, from); }

void Receiver::Core::rest(const PowerSave::Rest& rest, GpsTime from) {
    fall_asleep({.until = rest.until, .wakes = every_pin | usb_data, .saves_power = true}, from);
}

// What was to be sent still leaves; nothing is measured meanwhile.
void Receiver::Core::fall_asleep(const Sleep& sleep, GpsTime from) {
    falling_asleep_ = sleep;
    plan_lying_down(from);
}

void Receiver::Core::plan_lying_down(GpsTime at) {
    lies_down_at_ = at;
    outbox_.plan(at, [this](GpsTime t) { lie_down(t); });
}

void Receiver::Core::lie_down(GpsTime now) {
    if (!falling_asleep_ || now < lies_down_at_) return;
    GpsTime drained = now;
    for (const PortUnit& unit : units_)
        drained = std::max(drained, unit.transmit.drained_at().value_or(now));
    if (drained > now) return plan_lying_down(drained);
    const Sleep sleep = *std::exchange(falling_asleep_, std::nullopt);
    // Not worth it.
    if (sleep.saves_power && sleep.until && *sleep.until <= now) return;
    sleep_ = sleep;
    sleep_->since = now;
    outbox_.clear();
    settings_.navigating = false;
    power_.go_off();
    follow_power();
    tell_being_off();
}

// To whoever looks at it from outside; nothing leaves it.
void Receiver::Core::tell_being_off() {
    NavigationState shown = *reported_;
    Fix nothing;
    nothing.time = shown.epoch.fix.time;
    nothing.leap_seconds = shown.epoch.fix.leap_seconds;
    shown.epoch = {nothing};
    shown.fix_ok = false;
    shown.power_save = PowerSaveState::inactive;
    report(shown);
}

bool Receiver::Core::wakes_by(GpsTime now) const { return sleep_ && sleep_->until && *sleep_->until <= now; }

void Receiver::Core::look_at_clock(GpsTime now) {
    if (wakes_by(now)) wake(std::max(*sleep_->until, sleep_->since));
}

// The edge that wakes it is not heard, nor what follows until it listens again.
void Receiver::Core::feel(PortId port, GpsTime now) {
    if ((sleep_->wakes & source_of(port)) != 0) wake(now);
}

void Receiver::Core::wake(GpsTime now) {
    const Sleep slept = *std::exchange(sleep_, std::nullopt);
    Forgotten forgotten;
    forgotten.ephemerides = now - slept.since > ephemeris_life;
    boot(forgotten, now,
         {.takes = board_.power.wake,
          .banner = board_.power.banner,
          .keeps_ram = board_.power.keeps_ram,
          .cause = BootCause::backup});
}

std::optional<GpsTime> Receiver::Core::next_change() const {
    if (sleep_) return sleep_->until;
    return falling_asleep_ ? std::optional(lies_down_at_) : std::nullopt;
}

}  // namespace skyloop::firmware
