// Settings that come in force, and restarts.
#include <algorithm>

#include "base/core/std_additions.hpp"
#include "firmware/core/core.hpp"

namespace skyloop::firmware {

void Receiver::Core::begin_as_stored() {
    adopt_settings();
    parts_.restart_ports();
}

void Receiver::Core::adopt_settings() {
    const ReceiverConfig& config = parts_.config();
    revision_ = parts_.maker->revision();
    const ReceiverSettings before = settings_;
    settings_ = config.settings;
    settings_.restarts = before.restarts;
    settings_.start = before.start;
    settings_.navigating = before.navigating;
    settings_.corrections = before.corrections;
    power_.adopt(config.power);
    if (!power_.saves()) sleep_.cancel_saving();
    follow_power();
}

// What a client has configured comes in force; other signals mean that tracking begins anew (RECEIVER.md 4.4).
void Receiver::Core::apply_changes(GpsTime now) {
    if (parts_.maker->revision() == revision_) return;
    const std::set<SystemSignal> signals = settings_.signals;
    adopt_settings();
    tracker_.adopt(parts_.config());
    if (settings_.signals != signals) restart_navigation({}, now, parts_.board.timing.signal_restart);
}

void Receiver::Core::restart_navigation(const Forgotten& forgotten, GpsTime now, Seconds silence) {
    settings_.start = forgotten.kind();
    ++settings_.restarts;
    corrections_.reset();
    settings_.corrections = {};
    parts_.maker->navigation_restarts(forgotten);
    tracker_.start(now, forgotten);
    power_.restart(!forgotten.ephemerides);
    follow_power();
    parts_.report(tracker_.state());
    silent_until_ = std::max(silent_until_, advanced(now, silence));
}

void Receiver::Core::reset(const Reset& how, GpsTime now) {
    switch (how.kind) {
        case Reset::Kind::hardware:
            return reboot(how.forgotten, now, BootCause::hardware_reset);
        case Reset::Kind::software:
            return reboot(how.forgotten, now, BootCause::software_reset);
        case Reset::Kind::navigation:
            settings_.navigating = true;
            return restart_navigation(how.forgotten, now, parts_.board.timing.signal_restart);
        case Reset::Kind::stop_navigation:
            return set_navigating(false, now);
        case Reset::Kind::start_navigation:
            return set_navigating(true, now);
    }
}

void Receiver::Core::set_navigating(bool on, GpsTime now) {
    settings_.navigating = on;
    if (const std::string_view text = parts_.maker->navigation_text(on); !text.empty())
        parts_.send_text(text_notice, std::string(text), now);
    if (on) restart_navigation({}, now, Seconds(0));
}

void Receiver::Core::reboot(const Forgotten& forgotten, GpsTime now, BootCause cause, bool banner) {
    boot(forgotten, now, {.takes = parts_.board.timing.boot, .banner = banner, .cause = cause});
}

// RAM and transmit queue are lost, the configuration is built from its layers, the banner comes at the stored speed.
void Receiver::Core::boot(const Forgotten& forgotten, GpsTime now, const Boot& how) {
    parts_.outbox.clear();
    sleep_.clear();
    parts_.maker->restart(how.keeps_ram);
    adopt_settings();
    settings_.navigating = true;
    parts_.restart_ports();
    busy_until_ = last_answer_ = now;
    speeds_.release();
    reporter_.restart(now);
    const GpsTime awake = advanced(now, how.takes);
    parts_.maker->begin(awake);
    deaf_until_ = awake;
    tracker_.boot(now, how.cause);
    restart_navigation(forgotten, now, how.takes + parts_.board.timing.first_epoch);
    const bool woken = how.cause == BootCause::backup;
    if (how.banner) parts_.outbox.plan(awake, [this, woken](GpsTime t) { send_banner(t, woken); });
}

void Receiver::Core::send_banner(GpsTime now, bool woken) {
    reporter_.send_banner(now, woken);
    if (woken) return;  // half a second after that a client may speak to it
    for (const PortUnit& unit : parts_.units)
        deaf_until_ = std::max(deaf_until_, is_uart(unit.id) ? unit.transmit.drained_at().value_or(now) : now);
}

void Receiver::Core::happen(const ReceiverEvent& event, GpsTime now) {
    Maker& maker = *parts_.maker;
    std::visit(Overloaded{[&](const Reboot& e) {
                              if (e.loses_battery) maker.lose_battery();
                              reboot(Forgotten::of(e.kind), now, BootCause::power, e.banner);
                          },
                          [&](const RestartNavigation& e) {
                              restart_navigation(Forgotten::of(e.kind), now, parts_.board.timing.signal_restart);
                          },
                          // Without a word: what was queued still leaves, at the speed that the factory gave.
                          [&](const ForgetConfiguration&) {
                              maker.forget_settings();
                              speeds_.release();
                              adopt_settings();
                              speeds_.change_now(now);
                          },
                          [&](const ForceBaud& e) {
                              speeds_.force(e);
                              adopt_settings();
                              speeds_.change_now(now);
                          }},
               event);
}

}  // namespace skyloop::firmware
