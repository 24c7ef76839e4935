#include "run/emulator/status_board.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "base/geo/geodetic.hpp"
#include "firmware/core/told_baseline.hpp"
#include "run/emulator/timing.hpp"

namespace skyloop::inline run {
namespace {

constexpr std::int64_t watched_interval_ns = 100'000'000, unwatched_interval_ns = 1'000'000'000;
// Who has asked or commanded asks again soon.
constexpr std::int64_t followed_ns = 2'000'000'000;

template <class Line>
void keep_last(std::deque<std::shared_ptr<const Line>>& lines, Line line, std::size_t most) {
    if (lines.size() >= most) lines.pop_front();
    lines.push_back(std::make_shared<const Line>(std::move(line)));
}

// What is counted together, of a DialogueLine and of a MessageCount.
template <class Message>
auto message_key(const Message& message) {
    return std::tie(message.receiver, message.wire, message.from_client, message.kind, message.name);
}

// Of a pair in one run no messages come; its vector tells the base.
std::optional<CorrectionsStatus> corrections_of(const firmware::NavigationState& reported) {
    const firmware::CorrectionStatus& told = reported.corrections;
    const auto baseline = firmware::told_baseline(reported);
    if (!told.age && !baseline) return std::nullopt;
    CorrectionsStatus status;
    if (baseline) {
        status.solution = baseline->solution;
        status.baseline = baseline->vector;
    }
    status.age = told.age ? *told.age : baseline->vector.age;
    status.station = told.station ? *told.station : baseline ? baseline->vector.base_station : 0;
    if (told.base) status.base = to_geodetic(*told.base);
    return status;
}

}  // namespace

StatusBoard::StatusBoard(StatusSetup setup, const std::vector<Station>* stations, StatusSources sources)
    : setup_(std::move(setup)),
      stations_(stations),
      sources_(std::move(sources)),
      silence_(setup_.start),
      bars_(setup_.timeline) {
    for (std::size_t i = 0; stations_ != nullptr && i < stations_->size(); ++i) {
        take_wires(i, receiver(i));
        taken_at_[i] = 0;
    }
    publish(setup_.start, clock());
    published_at_ = 0;  // the first epoch is shown at once
}

std::int64_t StatusBoard::clock() const { return sources_.clock ? sources_.clock() : steady_clock_ns(); }

std::int64_t StatusBoard::interval(std::int64_t clock_ns) const {
    const bool watched = watchers() > 0 || news_ || clock_ns < followed_until_;
    return watched ? watched_interval_ns : unwatched_interval_ns;
}

// Of the epochs between two snapshots nobody sees any but the last; a fast run need not pay for them.
bool StatusBoard::is_wanted(const EpochSeen& seen, std::int64_t clock_ns) const {
    return setup_.every_epoch || stepping_ || clock_ns - taken_at_[seen.station] >= interval(clock_ns) * 9 / 10;
}

ReceiverStatus& StatusBoard::receiver(std::size_t station) {
    if (station >= receivers_.size()) {
        receivers_.resize(station + 1);
        taken_at_.resize(station + 1, 0);
    }
    return receivers_[station];
}

void StatusBoard::take_epoch(const EpochSeen& seen, bool silent, ReceiverStatus& status) const {
    status.epoch = seen.now;
    status.truth = seen.trace.truth.geodetic;
    status.true_speed = seen.trace.arrivals.antenna_speed;
    status.interference =
        std::max(seen.trace.epoch.front_end.interference, seen.trace.epoch.front_end.lower_interference);
    status.lateness = seen.lateness;
    status.satellites = satellites_seen(seen);
    if (seen.leaves) return take_report(seen, status);
    if (!silent) return;
    status.fix.type = FixType::none;
    status.fix_ok = false;
    status.satellites_used = 0;
    status.error.reset();
    status.corrections.reset();
}

void StatusBoard::take_report(const EpochSeen& seen, ReceiverStatus& status) const {
    const Fix& fix = seen.reported.epoch.fix;
    std::vector<SatelliteStatus> none;
    status.fix = fix;
    status.fix.satellites.swap(none);
    status.fix_ok = seen.reported.fix_ok;
    status.satellites_used = fix.satellites_used();
    status.error.reset();
    if (fix.has_position()) status.error = enu_error(seen.trace.truth, fix);
    status.corrections = corrections_of(seen.reported);
    status.jamming_state = seen.reported.monitors.told_jamming_state();
    status.spoofing = static_cast<int>(seen.reported.monitors.spoofing);
}

void StatusBoard::take_wires(std::size_t station, ReceiverStatus& status) const {
    if (stations_ == nullptr || station >= stations_->size()) return;
    const Station& source = (*stations_)[station];
    status.name = source.name();
    status.board = source.receiver().board().name;
    status.rate_hz = 1e9 / std::max(static_cast<double>(source.receiver().settings().navigation_period.count()), 1e6);
    status.epochs = source.counts().epochs;
    status.wires.clear();
    for (const Wire& wire : source.wires()) {
        WireStatus shown;
        const LinkCounters& counts = wire.link.counters();
        const firmware::PortTotals port = source.receiver().port_totals(wire.port);
        shown.port = firmware::port_names[static_cast<std::size_t>(wire.port)];
        shown.description = wire.link.transport().description();
        shown.other_end = wire.link.transport().other_end();
        shown.baud = source.speed(wire.port);
        shown.connected = wire.link.connected();
        shown.bytes_out = counts.bytes_out;
        shown.bytes_in = counts.bytes_in;
        shown.bytes_lost = counts.bytes_lost;
        shown.bytes_unheard = counts.bytes_unheard;
        shown.bytes_garbled = counts.bytes_garbled;
        shown.messages_sent = port.messages_out;
        shown.messages_dropped = port.messages_dropped;
        for (const Belief& belief : beliefs_)
            if (belief.station == station && belief.wire == status.wires.size()) {
                shown.belief = belief.reason;
                shown.trusted = belief.trusts;
            }
        status.wires.push_back(std::move(shown));
    }
}

void StatusBoard::on_epoch(const EpochSeen& seen) {
    const std::int64_t clock_ns = clock();
    ReceiverStatus& status = receiver(seen.station);
    const bool silent = silence_.is_silent(seen, seen.now);
    if (is_wanted(seen, clock_ns)) {
        take_epoch(seen, silent, status);
        taken_at_[seen.station] = clock_ns;
    }
    if (clock_ns - published_at_ >= interval(clock_ns)) publish(seen.now, clock_ns);
}

void StatusBoard::on_message(const MessageSeen& seen) {
    DialogueLine line;
    line.sequence = ++dialogue_count_;
    line.time = seen.now;
    line.receiver = seen.station;
    line.wire = seen.wire;
    line.from_client = seen.from_client;
    line.kind = seen.kind;
    line.name = seen.name.substr(0, 64);
    line.size = seen.bytes.size();
    const ByteSpan kept = seen.bytes.first(std::min(seen.bytes.size(), dialogue_bytes));
    line.bytes.assign(kept.begin(), kept.end());
    count_message(line);
    keep_last(dialogue_, std::move(line), most_dialogue_lines);
}

void StatusBoard::count_message(const DialogueLine& line) {
    const auto less = [](const MessageCount& one, const DialogueLine& other) {
        return message_key(one) < message_key(other);
    };
    auto found = std::lower_bound(messages_.begin(), messages_.end(), line, less);
    if (found == messages_.end() || message_key(*found) != message_key(line)) {
        if (messages_.size() >= most_message_counts) return;
        found = messages_.insert(found, {line.receiver, line.wire, line.from_client, line.kind, line.name, 0});
    }
    ++found->count;
}

void StatusBoard::add_event(GpsTime now, std::string what, std::string text) {
    news_ = true;
    keep_last(events_, EventLine{++event_count_, now, std::move(what), std::move(text)}, most_events);
}

// The bar of this occurrence; else the planned one of that name; else a new one.
TimelineBar& StatusBoard::bar_of(const FaultSeen& seen) {
    const auto same = [&](const TimelineBar& bar) { return !bar.command && bar.name == seen.name; };
    for (TimelineBar& bar : bars_)
        if (same(bar) && bar.occurrence == seen.occurrence) return bar;
    for (TimelineBar& bar : bars_)
        if (same(bar) && bar.occurrence == 0) return bar;
    const std::size_t planned = setup_.timeline.size();
    if (bars_.size() >= planned + most_live_bars) {
        const auto over = std::find_if(bars_.begin() + static_cast<std::ptrdiff_t>(planned), bars_.end(),
                                       [](const TimelineBar& bar) { return !bar.active; });
        bars_.erase(over == bars_.end() ? bars_.begin() + static_cast<std::ptrdiff_t>(planned) : over);
    }
    TimelineBar& bar = bars_.emplace_back();
    const bool scripted = std::any_of(setup_.timeline.begin(), setup_.timeline.end(), same);
    bar.name = seen.name;
    bar.kind = seen.kind;
    bar.live = !scripted;
    return bar;
}

void StatusBoard::on_fault(const FaultSeen& seen) {
    TimelineBar& bar = bar_of(seen);
    bar.occurrence = seen.occurrence;
    bar.active = seen.begins;
    if (seen.begins)
        bar.begins = seen.now;
    else
        bar.ends = seen.now;
    add_event(seen.now, seen.begins ? "fault begins" : "fault ends",
              seen.occurrence > 1 ? fmt::format("{} ({}) #{}", seen.name, seen.kind, seen.occurrence)
                                  : fmt::format("{} ({})", seen.name, seen.kind));
}

void StatusBoard::on_command(const CommandSeen& seen) {
    std::string text(seen.name);
    if (!seen.command.source.empty()) text += " by " + seen.command.source;
    if (!seen.ignored.empty()) text += fmt::format(", ignored: {}", seen.ignored);
    add_event(seen.now, "command", std::move(text));
    followed_until_ = clock() + followed_ns;
    stepping_ = seen.command.verb == CommandVerb::step;
}

void StatusBoard::on_belief(const BeliefSeen& seen) {
    const auto same = [&](const Belief& b) { return b.station == seen.station && b.wire == seen.wire; };
    auto found = std::find_if(beliefs_.begin(), beliefs_.end(), same);
    if (found == beliefs_.end()) found = beliefs_.insert(beliefs_.end(), {seen.station, seen.wire, false, {}});
    found->trusts = seen.trusts;
    found->reason = seen.reason;
    add_event(seen.now, "belief", fmt::format("{}: {}", seen.trusts ? "trusts" : "does not trust", seen.reason));
}

void StatusBoard::look(GpsTime now) {
    const std::int64_t clock_ns = clock();
    const bool asked = heard_asks_ != answered_asks_;
    if (asked) followed_until_ = clock_ns + followed_ns;
    if ((asked || clock_ns - published_at_ >= interval(clock_ns)) && publish(now, clock_ns))
        answered_asks_ = heard_asks_;
    heard_asks_ = asks_;
}

void StatusBoard::publish_now(GpsTime now) {
    heard_asks_ = asks_;
    publish(now, clock());
}

bool StatusBoard::publish(GpsTime now, std::int64_t clock_ns) {
    for (std::size_t i = 0; i < receivers_.size(); ++i)
        take_wires(i, receivers_[i]);
    auto snapshot = std::make_shared<StatusSnapshot>();
    snapshot->sequence = snapshot_count_ + 1;
    snapshot->answers = heard_asks_;
    snapshot->time = now;
    snapshot->start = setup_.start;
    snapshot->end = setup_.end;
    snapshot->title = setup_.title;
    if (!receivers_.empty()) snapshot->leap_seconds = receivers_.front().fix.leap_seconds;
    if (sources_.pace) snapshot->pace = sources_.pace();
    if (sources_.caster) snapshot->caster = sources_.caster();
    if (sources_.verdicts) snapshot->verdicts = sources_.verdicts();
    snapshot->receivers = receivers_;
    snapshot->timeline = bars_;
    for (TimelineBar& bar : snapshot->timeline)
        if (sources_.strength && !bar.command && bar.occurrence > 0)
            bar.strength = sources_.strength(bar.name, bar.occurrence, now);
        else
            bar.strength = bar.active ? 1 : 0;
    snapshot->dialogue.assign(dialogue_.begin(), dialogue_.end());
    snapshot->messages = messages_;
    snapshot->events.assign(events_.begin(), events_.end());
    std::shared_ptr<const StatusSnapshot> next = std::move(snapshot);
    {
        const std::unique_lock lock(mutex_, std::try_to_lock);
        if (!lock) return false;  // a reader is at it: the next look tries again
        latest_.swap(next);
    }
    ++snapshot_count_;
    news_ = false;
    published_at_ = clock_ns;
    return true;
}

std::shared_ptr<const StatusSnapshot> StatusBoard::latest() const {
    const std::scoped_lock lock(mutex_);
    return latest_;
}

}  // namespace skyloop::inline run
