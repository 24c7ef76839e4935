#include "firmware/core/core.hpp"

#include <algorithm>
#include <iterator>

#include "base/core/std_additions.hpp"

namespace skyloop::firmware {
namespace {

using namespace std::chrono_literals;

// What measures was handed its corrections before; of models that measure nothing the fix has got those of now.
CorrectionState solved_with(const Epoch& epoch, CorrectionState handed, CorrectionState now) {
    return epoch.observations.signals.empty() ? now : handed;
}

// What of the corrections is in the solution: with few satellites, or none, it is less than there could be, and where
// those of SBAS are, nothing.
CorrectionState in_solution(const Fix& fix, CorrectionState at_most) {
    if (at_most == CorrectionState::none || fix.sbas_source) return CorrectionState::none;
    switch (fix.type) {
        case FixType::dgnss:
            return CorrectionState::differential;
        case FixType::rtk_float:
            return CorrectionState::rtk_float;
        case FixType::rtk_fixed:
            return CorrectionState::rtk_fixed;
        default:
            return CorrectionState::none;
    }
}

// Ephemerides last so long: after more the start is no hot one.
constexpr Nanoseconds ephemeris_life = 4h;

}  // namespace

Receiver::Core::Core(BoardProfile board, const ReceiverOptions& options, const MakerRow& row)
    : parts_(std::move(board), options, row),
      options_(options),
      tracker_(parts_.board, options.seed),
      power_(parts_.board.power),
      corrections_(parts_.board.corrections),
      input_(
          parts_, [this](PortUnit& u, const StreamPiece& piece, GpsTime t) { return receive(u, piece, t); },
          [this](PortUnit& u, GpsTime t) {
              if (accepts(u.id, StreamKind::rtcm3)) report_corrections(CorrectionInput::answer_to_damaged(), t);
          }),
      speeds_(parts_),
      reporter_(parts_, options.seed),
      sleep_(parts_, [this] { power_off(); }),
      settings_(parts_.config().settings) {
    tracker_.start({}, {}, true);
    parts_.report(tracker_.state());
    adopt_settings();
}

void Receiver::Core::start(GpsTime now) {
    if (options_.power_up) tracker_.boot(now);
    tracker_.start(now, Forgotten::of(options_.settings.start),
                   !options_.power_up && options_.settings.start == StartKind::hot);
    parts_.report(tracker_.state());
    if (!options_.power_up) return parts_.maker->begin(now);
    const GpsTime awake = advanced(now, parts_.board.timing.boot);
    parts_.maker->begin(awake);
    deaf_until_ = awake;
    silent_until_ = advanced(awake, parts_.board.timing.first_epoch);
    parts_.outbox.plan(awake, [this](GpsTime t) { send_banner(t, true); });
}

void Receiver::Core::input(PortId port, ByteSpan bytes, GpsTime now) {
    counters_.bytes_received += bytes.size();
    PortUnit* unit = find_unit(parts_.units, port);
    wake_by_clock(now);
    if (unit == nullptr || parts_.faults.deaf || bytes.empty()) return;
    if (sleep_.is_off()) {
        // The edge that wakes it is not heard, nor what follows until it listens again.
        if (sleep_.is_ended_by(port)) wake(now);
        return;
    }
    if (now >= deaf_until_) input_.receive(*unit, bytes, now);
}

std::vector<Receiver::Sent> Receiver::Core::output(GpsTime now) {
    for (PortUnit& unit : parts_.units)
        input_.give_up_unfinished(unit, now);
    std::vector<Sent> sent;
    act_until(now, sent);
    std::ranges::move(parts_.outbox.run(now), std::back_inserter(sent));
    while (sleep_.is_over(now)) {
        wake_by_clock(now);
        std::ranges::move(parts_.outbox.run(now), std::back_inserter(sent));
    }
    return sent;
}

// What it sends by itself, each at its time among what is planned.
void Receiver::Core::act_until(GpsTime now, std::vector<Sent>& sent) {
    for (auto at = parts_.maker->acts_at(); at && *at <= now; at = parts_.maker->acts_at()) {
        std::ranges::move(parts_.outbox.run(*at), std::back_inserter(sent));
        if (parts_.maker->acts_at() != at) continue;  // it has started anew
        for (const PortMessage& message : parts_.maker->act(*at, parts_.faults))
            if (!sleep_.is_off()) parts_.send(message.port, {message.bytes}, *at);
    }
}

std::optional<GpsTime> Receiver::Core::next_change() const {
    const std::optional<GpsTime> sleep = sleep_.next_change(), act = parts_.maker->acts_at();
    return sleep && act ? std::min(*sleep, *act) : sleep ? sleep : act;
}

ReceiverCounters Receiver::Core::counters() const {
    ReceiverCounters counters = counters_;
    for (const PortUnit& unit : parts_.units) {
        counters.messages_sent += unit.totals.messages_out;
        counters.messages_dropped += unit.totals.messages_dropped;
    }
    return counters;
}

bool Receiver::Core::accepts(PortId port, StreamKind kind) const {
    const PortConfig& config = parts_.config().port(port);
    if (!config.on) return false;
    switch (kind) {
        case StreamKind::ubx:
        case StreamKind::casic:
            return config.in.ubx;
        case StreamKind::nmea:
            return config.in.nmea;
        case StreamKind::rtcm3:
            return config.in.rtcm3;
        default:
            return kind == StreamKind::command;
    }
}

// False: the receiver does not listen to what follows.
bool Receiver::Core::receive(PortUnit& unit, const StreamPiece& piece, GpsTime now) {
    if (sleep_.is_off() || now < deaf_until_) return false;
    if (!accepts(unit.id, piece.kind)) return true;
    if (piece.kind == StreamKind::rtcm3)
        report_corrections(corrections_.take(piece.bytes, now, tracker_.state().epoch.fix.leap_seconds), now);
    else
        carry_out(
            unit,
            parts_.maker->receive(piece, {unit.id, now, parts_.faults, tracker_.state().time, parts_.context(unit.id)}),
            now);
    return now >= deaf_until_;
}

void Receiver::Core::report_corrections(const CorrectionAnswer& answer, GpsTime now) {
    const auto reports = parts_.maker->correction_reports(answer, parts_.faults);
    if (!reports) return;
    const GpsTime at = answer_time(now, Seconds(0));
    for (const PortMessage& report : *reports)
        parts_.outbox.plan(at, [this, report](GpsTime t) { parts_.send(report.port, {report.bytes}, t); });
}

// Commands are worked off one after the other; each takes the board's usual time and what it has to do besides.
GpsTime Receiver::Core::answer_time(GpsTime now, Seconds work) {
    busy_until_ = advanced(advanced(std::max(now, busy_until_), parts_.board.timing.answer), work);
    last_answer_ = std::max(last_answer_, advanced(busy_until_, parts_.faults.answer_delay));
    return last_answer_;
}

bool Receiver::Core::stays_silent_to(UbxMessageId message) const {
    return parts_.faults.unanswering || parts_.faults.unanswered.contains(message);
}

void Receiver::Core::carry_out(PortUnit& unit, CommandOutcome outcome, GpsTime now) {
    apply_changes(now);
    for (const std::string& warning : outcome.warnings)
        parts_.send_text(text_warning, warning, now);
    if (outcome.resets_odometer) reset_odometer();
    const bool answered = !outcome.answers.empty() && !stays_silent_to(outcome.to);
    const bool spoke = answered || outcome.verdict;
    reply(unit, outcome, now);
    if (outcome.navigating && *outcome.navigating != settings_.navigating) set_navigating(*outcome.navigating, now);
    if (outcome.sleep)
        plan_sleep(*outcome.sleep, now, spoke ? std::max(now, last_answer_) : answer_time(now, Seconds(0)));
    if (!outcome.reset) return;
    if (!answered) return reset(*outcome.reset, now);
    // What acknowledges a restart leaves before it.
    parts_.outbox.plan(last_answer_, [this, port = unit.id, how = *outcome.reset](GpsTime t) {
        const GpsTime left = find_unit(parts_.units, port)->transmit.drained_at().value_or(t);
        parts_.outbox.plan(left, [this, how](GpsTime then) { reset(how, then); });
    });
}

// Answers leave before the verdict. A new speed of the port of arrival comes in force with the answer, or after it, or
// swallows it, as the board's maker has it.
void Receiver::Core::reply(PortUnit& unit, CommandOutcome& outcome, GpsTime now) {
    const PortId port = unit.id;
    const SpeedChangeAnswer way = parts_.board.quirks.speed_change;
    const bool swallowed = way == SpeedChangeAnswer::lost && !speeds_.is_set(port);
    if (stays_silent_to(outcome.to))
        outcome.answers.clear();
    else if (outcome.verdict && !swallowed)
        outcome.answers.push_back(*outcome.verdict);
    const bool anything = !outcome.answers.empty();
    if (!anything && speeds_.are_set()) return;
    const GpsTime at = answer_time(now, outcome.work);
    if (way != SpeedChangeAnswer::at_old_speed) speeds_.plan_changes(at);
    if (anything)
        parts_.outbox.plan(at, [this, port, messages = std::move(outcome.answers)](GpsTime t) {
            std::vector<Bytes> let_out;
            for (const Bytes& message : messages)
                if (parts_.config().port(port).lets_out(protocol_of(message))) let_out.push_back(message);
            parts_.send(port, let_out, t);
        });
    if (way == SpeedChangeAnswer::at_old_speed) speeds_.plan_changes(at);
}

const ReceiverSettings& Receiver::Core::settings_at(GpsTime epoch) {
    settings_.corrections = corrections_.usable(epoch, parts_.config().corrections);
    settings_.corrections.at_most = parts_.maker->allowed(settings_.corrections.at_most);
    return settings_;
}

void Receiver::Core::on_epoch(const Epoch& epoch, const ReportEdit& edit) {
    const GpsTime time = epoch.fix.time;
    report_time_.reset();
    wake_by_clock(time);
    if (sleep_.is_planned() || time < silent_until_) return;
    const ReceiverConfig& config = parts_.config();
    CorrectionStatus corrections = corrections_.status(time, config.corrections);
    corrections.come = corrections.state != CorrectionState::none;
    corrections.state = parts_.maker->allowed(corrections.state);
    const CorrectionState used = solved_with(epoch, settings_.corrections.at_most, corrections.state);
    const auto state = std::make_shared<NavigationState>(tracker_.update(epoch, config, corrections));
    state->corrections.state = in_solution(state->epoch.fix, used);
    state->monitors.jamming_hidden = parts_.faults.jamming_hidden;
    state->monitors.told_elsewhere = config.reports_jamming_elsewhere;
    carry_to_clock_instant(*state);
    const std::optional<PowerSave::Rest> off = settings_.navigating ? power_.update(*state) : std::nullopt;
    state->power_save = power_.state();
    follow_power();
    parts_.maker->restrict(*state);
    if (edit) edit(*state);
    remember_for_late_sentences(*state);
    parts_.reported = state;
    ++counters_.epochs;
    if (!settings_.navigating) return;
    const GpsTime burst = reporter_.plan(state, time);
    if (state->reports > 0 && !parts_.faults.mute) report_time_ = burst;
    if (off) sleep_.plan({.until = off->until, .wakes = wake_by_every_pin | wake_by_usb, .saves_power = true}, burst);
}

// A board without late sentences keeps nothing.
void Receiver::Core::remember_for_late_sentences(NavigationState& state) {
    std::size_t farthest = 0;
    for (const auto& [message, epochs] : parts_.board.style.late)
        farthest = std::max(farthest, static_cast<std::size_t>(epochs));
    if (farthest == 0) return;
    if (state.epoch_index == 0) earlier_.clear();
    const auto copy = std::make_shared<NavigationState>(state);
    state.earlier = earlier_;
    earlier_.insert(earlier_.begin(), copy);
    earlier_.resize(std::min(earlier_.size(), farthest));
}

void Receiver::Core::reset_odometer() {
    tracker_.reset_odometer();
    NavigationState shown = *parts_.reported;
    shown.odometer_m = shown.odometer_deviation_m = 0;
    parts_.report(shown);
}

void Receiver::Core::plan_sleep(const SleepRequest& request, GpsTime now, GpsTime from) {
    sleep_.plan({.until = request.length ? std::optional(now + *request.length) : std::nullopt, .wakes = request.wakes},
                from);
}

void Receiver::Core::follow_power() {
    settings_.navigation_period = power_.navigation_period(parts_.config().settings.navigation_period);
}

// What is reported then is for whoever looks at it from outside; nothing leaves it.
void Receiver::Core::power_off() {
    settings_.navigating = false;
    power_.go_off();
    follow_power();
    NavigationState shown = *parts_.reported;
    Fix nothing;
    nothing.time = shown.epoch.fix.time;
    nothing.leap_seconds = shown.epoch.fix.leap_seconds;
    shown.epoch = {nothing};
    shown.fix_ok = false;
    shown.power_save = PowerSaveState::inactive;
    parts_.report(shown);
}

void Receiver::Core::wake_by_clock(GpsTime now) {
    if (const auto at = sleep_.over_at(now)) wake(*at);
}

void Receiver::Core::wake(GpsTime now) {
    const Sleep slept = sleep_.end();
    Forgotten forgotten;
    forgotten.ephemerides = now - slept.since > ephemeris_life;
    const PowerAbility& ability = parts_.board.power;
    boot(forgotten, now,
         {.takes = ability.wake, .banner = ability.banner, .keeps_ram = ability.keeps_ram, .cause = BootCause::backup});
}

}  // namespace skyloop::firmware
