#include "firmware/receiver.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "firmware/board_profile.hpp"
#include "firmware/config/legacy_support.hpp"
#include "firmware/receiver_core.hpp"
#include "firmware/septentrio/rover_and_station.hpp"
#include "receiver/protocol/ubx_hardware.hpp"

namespace skyloop::firmware {

Receiver::Receiver(BoardProfile board, const ReceiverOptions& options)
    : core_(std::make_unique<Core>(std::move(board), options)) {}
Receiver::~Receiver() = default;
Receiver::Receiver(Receiver&&) noexcept = default;
Receiver& Receiver::operator=(Receiver&&) noexcept = default;

void Receiver::start(GpsTime now) { core_->start(now); }
void Receiver::input(PortId port, ByteSpan bytes, GpsTime now) { core_->input(port, bytes, now); }
void Receiver::on_epoch(const Epoch& epoch, const ReportEdit& edit) { core_->on_epoch(epoch, edit); }
void Receiver::set_faults(const FirmwareFaults& faults) { core_->set_faults(faults); }
void Receiver::happen(const ReceiverEvent& event, GpsTime now) { core_->happen(event, now); }
std::vector<Receiver::Sent> Receiver::output(GpsTime now) { return core_->output(now); }
std::optional<GpsTime> Receiver::drained_at() const { return core_->outbox().drained_at(); }
std::optional<GpsTime> Receiver::next_output(PortId port) const { return core_->outbox().next_at(port); }
std::optional<GpsTime> Receiver::next_change() const { return core_->next_change(); }

bool Receiver::has(PortId port) const { return core_->unit(port) != nullptr; }
std::uint32_t Receiver::baud(PortId port) const {
    const PortUnit* unit = core_->unit(port);
    return unit == nullptr ? 0 : unit->transmit.baud();
}
PortStatus Receiver::port_status(PortId port) const {
    const PortUnit* unit = core_->unit(port);
    return unit == nullptr ? PortStatus{port} : unit->status;
}
PortTotals Receiver::port_totals(PortId port) const {
    const PortUnit* unit = core_->unit(port);
    return unit == nullptr ? PortTotals{} : unit->totals;
}
const ReceiverSettings& Receiver::settings() const { return core_->settings(); }
const ReceiverSettings& Receiver::settings_at(GpsTime epoch) { return core_->settings_at(epoch); }
ReceiverCounters Receiver::counters() const { return core_->counters(); }
const BoardProfile& Receiver::board() const { return core_->board(); }
const NavigationState& Receiver::state() const { return core_->state(); }

std::shared_ptr<const NavigationState> Receiver::kept_state() const { return core_->kept_state(); }

std::optional<GpsTime> Receiver::report_time() const { return core_->report_time(); }
std::string Receiver::persistent_text() const { return core_->store().persistent_text(); }
Result<void> Receiver::configure(const std::map<std::uint32_t, std::uint64_t>& items) {
    return core_->configure(items);
}
Result<void> Receiver::restore(const std::string& text, const std::string& name) { return core_->restore(text, name); }
void Receiver::remember(const Geodetic& position, Metres geoid_undulation) {
    core_->remember(position, geoid_undulation);
}

namespace {

using namespace std::chrono_literals;

// CFG-RST resetMode (u-blox M8 interface description, 32.11.28).
enum ResetMode : std::uint8_t {
    reset_hardware = 0,
    reset_software = 1,
    reset_navigation = 2,
    reset_hardware_after_shutdown = 4,
    stop_navigation = 8,
    start_navigation = 9
};

std::vector<PortUnit> make_units(const BoardProfile& board, const ConfigStore& store) {
    std::vector<PortUnit> units;
    for (const PortId port : board.ports)
        units.emplace_back(port, configured_baud(store, port), board);
    return units;
}

std::string do_not_go_together(const BoardProfile& board) {
    return "these items do not go together: " + board.name +
           " would refuse them, as no system that gives a position, too many, or signals that exclude each other";
}

}  // namespace

Receiver::Core::Core(BoardProfile board, const ReceiverOptions& options)
    : board_(std::move(board)),
      options_(options),
      store_(initial_config(board_, options)),
      values_(board_, store_),
      legacy_(board_, store_),
      tracker_(board_),
      power_(board_.power),
      corrections_(board_.corrections),
      units_(make_units(board_, store_)),
      outbox_(units_),
      settings_(settings_of(store_, board_, options.settings)),
      latency_noise_(options.seed, "receiver.latency"),
      revision_(store_.revision()) {
    tracker_.start({}, {}, true);
    report(tracker_.state());
    adopt_settings();
    if (board_.personality == Personality::sbf) console_.emplace(board_, store_);
    jamming_told_elsewhere_ = console_ || knows(board_, SecSig1::message_id);
    if (!board_.messages.empty()) return;
    for (const std::string_view name : nmea_sentence_names)
        board_.messages.push_back(find_output_message(name)->id);
}

void Receiver::Core::start(GpsTime now) {
    if (options_.power_up) tracker_.boot(now);
    tracker_.start(now, Forgotten::of(options_.settings.start),
                   !options_.power_up && options_.settings.start == StartKind::hot);
    report(tracker_.state());
    if (!options_.power_up) return;
    const GpsTime awake = advanced(now, board_.timing.boot);
    deaf_until_ = awake;
    silent_until_ = advanced(awake, board_.timing.first_epoch);
    outbox_.plan(awake, [this](GpsTime t) { send_banner(t, true); });
}

Result<void> Receiver::Core::configure(const std::map<std::uint32_t, std::uint64_t>& items) {
    if (!items.empty() && board_.personality != Personality::ublox)
        return fail(ErrorCode::usage, board_.name + " is no u-blox receiver and has no configuration items");
    ConfigStore after = store_;
    for (const auto& [id, value] : items) {
        const ConfigKey* item = find_config_key(id);
        const std::string name = item == nullptr ? fmt::format("item 0x{:08x}", id) : std::string(item->name);
        if (!store_.has(id)) return fail(ErrorCode::usage, fmt::format("{} has no {}", board_.name, name));
        if (!is_in_range(board_, id, value))
            return fail(ErrorCode::usage,
                        fmt::format("{} is {}, which {} itself would refuse", name, value, board_.name));
        after.set(has_flash(board_) ? in_flash : in_battery, id, value);
    }
    if (spoils_start(board_, store_, after)) return fail(ErrorCode::usage, do_not_go_together(board_));
    store_ = std::move(after);
    begin_as_stored();
    return {};
}

Result<void> Receiver::Core::restore(const std::string& text, const std::string& name) {
    ConfigStore after = store_;
    // Settings that a u-blox receiver would refuse, it would go on to refuse with every later one.
    const bool judges = board_.personality == Personality::ublox;
    const auto allows = [&](std::uint32_t key, std::uint64_t value) {
        return !judges || is_in_range(board_, key, value);
    };
    const ConfigLayers layers = judges && !has_flash(board_) ? in_battery : in_battery | in_flash;
    if (auto restored = after.restore(text, name, allows, layers); !restored) return restored;
    if (judges && spoils_start(board_, store_, after))
        return fail(ErrorCode::input, name + ": " + do_not_go_together(board_));
    store_ = std::move(after);
    begin_as_stored();
    return {};
}

void Receiver::Core::begin_as_stored() {
    store_.reload();
    if (console_) console_.emplace(board_, store_);
    for (PortUnit& unit : units_)
        unit = PortUnit(unit.id, configured_baud(store_, unit.id), board_);
    adopt_settings();
}

void Receiver::Core::adopt_settings() {
    revision_ = store_.revision();
    const ReceiverSettings before = settings_;
    settings_ = settings_of(store_, board_, options_.settings);
    settings_.restarts = before.restarts;
    settings_.start = before.start;
    settings_.navigating = before.navigating;
    settings_.corrections = before.corrections;
    configured_period_ = settings_.navigation_period;
    power_.adopt(PowerSaveSettings::of(store_, board_));
    if (falling_asleep_ && falling_asleep_->saves_power && !power_.saves()) falling_asleep_.reset();
    follow_power();
    if (console_) settings_.subframes = wants_messages(console_->state().settings);
}

CorrectionState Receiver::Core::allowed(CorrectionState at_hand) const {
    return console_ ? allowed_corrections(console_->state().settings, at_hand) : at_hand;
}

// What a client has configured comes in force; other signals mean that tracking begins anew (RECEIVER.md 4.4).
void Receiver::Core::apply_changes(GpsTime now) {
    if (store_.revision() == revision_) return;
    const std::set<SystemSignal> signals = settings_.signals;
    adopt_settings();
    tracker_.adopt(store_);
    if (settings_.signals != signals) restart_navigation({}, now, board_.timing.signal_restart);
}

void Receiver::Core::restart_navigation(const Forgotten& forgotten, GpsTime now, Seconds silence) {
    settings_.start = forgotten.kind();
    ++settings_.restarts;
    corrections_.reset();
    settings_.corrections = CorrectionState::none;
    if (forgotten.rtc) told_time_ = false;
    tracker_.start(now, forgotten);
    power_.restart(!forgotten.ephemerides);
    follow_power();
    report(tracker_.state());
    silent_until_ = std::max(silent_until_, advanced(now, silence));
}

void Receiver::Core::reset(std::uint16_t nav_bbr_mask, std::uint8_t mode, GpsTime now) {
    Forgotten forgotten = Forgotten::by_mask(nav_bbr_mask);
    switch (mode) {
        case reset_hardware:
        case reset_hardware_after_shutdown:
            if (board_.quirks.hardware_reset_clears_battery) {
                store_.clear(in_battery);
                forgotten = Forgotten::of(StartKind::cold);
            }
            return reboot(forgotten, now, BootCause::hardware_reset);
        case reset_software:
            return reboot(forgotten, now, BootCause::software_reset);
        case reset_navigation:
            settings_.navigating = true;
            return restart_navigation(forgotten, now, board_.timing.signal_restart);
        case stop_navigation:
            return stop_navigating(now);
        case start_navigation:
            return start_navigating(now);
        default:
            return;  // other modes are not defined: nothing happens, and nothing is answered
    }
}

void Receiver::Core::switch_navigating(bool on, GpsTime now) {
    if (on != settings_.navigating) on ? start_navigating(now) : stop_navigating(now);
}

void Receiver::Core::stop_navigating(GpsTime now) {
    settings_.navigating = false;
    tell_of_navigating("Stopping GNSS", now);
}

void Receiver::Core::start_navigating(GpsTime now) {
    settings_.navigating = true;
    tell_of_navigating("Starting GNSS", now);
    restart_navigation({}, now, Seconds(0));
}

// As u-blox words it; others say nothing.
void Receiver::Core::tell_of_navigating(const char* text, GpsTime now) {
    if (board_.personality == Personality::ublox) send_text(text_notice, text, now);
}

void Receiver::Core::reboot(const Forgotten& forgotten, GpsTime now, BootCause cause, bool banner) {
    boot(forgotten, now, {.takes = board_.timing.boot, .banner = banner, .cause = cause});
}

// RAM and transmit queue are lost, the configuration is built from its layers, the banner comes at the stored speed.
void Receiver::Core::boot(const Forgotten& forgotten, GpsTime now, const Boot& how) {
    outbox_.clear();
    sleep_.reset();
    falling_asleep_.reset();
    if (!how.keeps_ram) store_.reload();
    if (console_) console_->restart(store_);
    adopt_settings();
    settings_.navigating = true;
    for (PortUnit& unit : units_) {
        const PortId id = unit.id;
        const PortTotals totals = unit.totals;
        unit = PortUnit(id, configured_baud(store_, id), board_);
        unit.totals = totals;
    }
    values_.cancel();
    busy_until_ = last_answer_ = last_burst_ = now;
    forced_speed_.reset();
    told_antenna_.reset();
    mavlink_sent_ = {};
    const GpsTime awake = advanced(now, how.takes);
    deaf_until_ = awake;
    tracker_.boot(now, how.cause);
    restart_navigation(forgotten, now, how.takes + board_.timing.first_epoch);
    const bool woken = how.cause == BootCause::backup;
    if (how.banner) outbox_.plan(awake, [this, woken](GpsTime t) { send_banner(t, woken); });
}

}  // namespace skyloop::firmware
