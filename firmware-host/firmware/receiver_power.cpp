// How the receiver is off, and what wakes it (u-blox M8 receiver description UBX-13003221, 13; NEO-M9N integration
// manual UBX-19014286, 3.11).
#include <algorithm>
#include <utility>

#include "firmware/receiver_core.hpp"
#include "receiver/protocol/ubx_cfg_hardware.hpp"
#include "receiver/protocol/ubx_mon.hpp"
#include "receiver/protocol/ubx_raw.hpp"

namespace skyloop::firmware {
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
