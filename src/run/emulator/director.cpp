#include "run/emulator/director.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/geo/local_frame.hpp"
#include "firmware/core/firmware_faults.hpp"
#include "run/emulator/command_queue.hpp"
#include "run/emulator/station.hpp"
#include "run/emulator/timing.hpp"
#include "run/fault/timeline_keys.hpp"

namespace skyloop::inline run {

bool CommandQueue::push(Command command) {
    const std::scoped_lock lock(mutex_);
    if (waiting_.size() >= most) return false;
    waiting_.push_back(std::move(command));
    return true;
}

std::vector<Command> CommandQueue::take() {
    const std::scoped_lock lock(mutex_);
    return std::exchange(waiting_, {});
}

namespace {

// At one instant: commands that start what starts them would go on for ever.
constexpr int most_rounds = 16;

bool waits_for_client(const TimelineEntry& entry) { return entry.when && !entry.when->client_sends.empty(); }

// What a climb or a fall adds is none of it.
MetresPerSecond ground_speed(const TruthState& truth) {
    const Eigen::Vector3d enu = LocalFrame(truth.geodetic).to_enu(truth.velocity).vector();
    return MetresPerSecond(std::hypot(enu.x(), enu.y()));
}

// All receivers have one clock: a fault of several must not act on it several times.
double faulty_pace(const std::vector<Station>& stations, GpsTime now) {
    double pace = 1;
    for (const Station& station : stations) {
        const double own = station.faults().empty() ? 1 : station.faults().pace(now).rate;
        if (std::abs(own - 1) > std::abs(pace - 1)) pace = own;
    }
    return pace;
}

}  // namespace

bool begins_new_fault(const Command& command) {
    return command.verb == CommandVerb::start_fault && command.parameters.has("kind");
}

std::string free_name(const std::string& wanted, const std::function<bool(const std::string&)>& is_taken) {
    std::string name = wanted;
    for (int number = 2; is_taken(name); ++number)
        name = fmt::format("{} {}", wanted, number);
    return name;
}

Director::Director(Parts parts) : parts_(std::move(parts)), timeline_({}, parts_.start, parts_.seed) {
    std::vector<TimelineEntry> entries;
    for (FaultEntry& fault : parts_.faults) {
        entries.push_back(fault.when);
        acts_.push_back({std::move(fault), std::nullopt, {}});
    }
    for (CommandEntry& command : parts_.commands) {
        entries.push_back(command.when);
        acts_.push_back({std::nullopt, std::move(command.command), {}});
    }
    speed_ = parts_.speed;
    hears_ = std::any_of(entries.begin(), entries.end(), waits_for_client);
    timeline_ = Timeline(std::move(entries), parts_.start, parts_.seed);
}

bool Director::wants_messages() const {
    return hears_ || std::any_of(observers_.begin(), observers_.end(),
                                 [](const RunObserver* observer) { return observer->wants_messages(); });
}

std::optional<GpsTime> Director::next_event() const {
    const auto next = timeline_.next_event();
    if (!pause_at_ || (next && *next < *pause_at_)) return next;
    return pause_at_;
}

void Director::advance(GpsTime now, std::vector<Station>& stations, Pacer& pacer) {
    if (parts_.live != nullptr)
        for (const Command& command : parts_.live->take())
            carry_out(command, command_name(command.verb), {now, stations, pacer});
    for (const Command& command : std::exchange(asked_, {}))
        carry_out(command, command_name(command.verb), {now, stations, pacer});
    // What a command begins is due at once, whether the command comes from outside or from the timeline: a repeated run
    // must not be an epoch behind.
    for (int round = 0; round < most_rounds; ++round) {
        const std::vector<TimelineEvent> due = timeline_.advance(now);
        if (due.empty()) break;
        for (const TimelineEvent& event : due)
            follow(event, {event.time, stations, pacer});
    }
    if (pause_at_ && now >= *pause_at_) {
        pause_at_.reset();
        paused_ = true;
        pacer.pause(now);
    }
    const double pace = faulty_pace(stations, now);
    if (pace == pace_) return;
    pace_ = pace;
    pacer.set_speed(speed_ * pace_, now);
}

void Director::follow(const TimelineEvent& event, const Scene& scene) {
    const Act& act = acts_[event.entry];
    if (act.command) return carry_out(*act.command, timeline_.entries()[event.entry].name, scene);
    for (const std::size_t receiver : act.fault->receivers)
        if (event.begins)
            begin_fault(event, scene.stations.at(receiver));
        else
            scene.stations.at(receiver).faults().end(event.entry, event.occurrence, event.time);
    const FaultSeen seen{event.time, timeline_.entries()[event.entry].name, act.fault->kind, event.occurrence,
                         event.begins};
    for (RunObserver* observer : observers_)
        observer->on_fault(seen);
}

void Director::begin_fault(const TimelineEvent& event, Station& station) {
    const FaultEntry& entry = *acts_[event.entry].fault;
    const TimelineEntry& times = timeline_.entries()[event.entry];
    const std::string name = event.occurrence == 1 ? times.name : fmt::format("{}#{}", times.name, event.occurrence);
    auto fault = find_fault_kind(entry.kind)->make(entry.parameters, {station.seed(), name});
    if (!fault) return;  // whoever made the entry has tried it
    const FaultSpan span{event.entry, event.occurrence, event.time, times.ramp_in, times.ramp_out};
    station.faults().begin(std::move(*fault), span);
}

void Director::carry_out(const Command& command, std::string_view name, const Scene& scene) {
    // Nobody stands by in virtual time who could wait for it.
    const bool comes_to_nothing = is_live_only(command.verb) && scene.pacer.is_virtual();
    const std::string ignored = comes_to_nothing ? "time is virtual, and waits for nobody" : ignored_because(command);
    const CommandSeen seen{scene.now, name, command, ignored};
    for (RunObserver* observer : observers_)
        observer->on_command(seen);
    if (!ignored.empty()) return;
    switch (command.verb) {
        case CommandVerb::start_fault:
            return begins_new_fault(command) ? begin_new_fault(command, scene) : start_or_stop(command, scene);
        case CommandVerb::stop_fault:
            return start_or_stop(command, scene);
        case CommandVerb::pause:
        case CommandVerb::resume:
        case CommandVerb::step:
        case CommandVerb::speed:
            return set_pace(command, scene);
        case CommandVerb::note:
            return;
        case CommandVerb::vehicle_state:
            return timeline_.tell(vehicle_state_of(command.parameters, timeline_.vehicle()));
        case CommandVerb::stop:
            stopped_ = true;
            return;
        case CommandVerb::move_to:
            for (Station& station : scene.stations) {
                const Metres height = station.simulation().truth_at(scene.now).geodetic.height.above_ellipsoid;
                if (const auto place = command.parameters.place("at", height)) station.move_to(*place, scene.now);
            }
            return;
        case CommandVerb::restart:
        case CommandVerb::reboot:
        case CommandVerb::forget_configuration:
        case CommandVerb::set_baud:
            for (Station& station : scene.stations)
                if (command.is_for(station.name())) station.happen(receiver_event(command), scene.now);
    }
}

// A fault that is under way does not begin a second time, what is not cannot end, and what nobody has named does
// neither.
std::string Director::ignored_because(const Command& command) const {
    if (command.verb == CommandVerb::speed && command.parameters.number("factor") != 1) return parts_.keeps_speed;
    const std::string name = command.parameters.text("fault");
    if (command.verb == CommandVerb::stop_fault && faults_to_stop(name).empty())
        return name.empty() ? "no fault is under way" : name + " is not under way";
    if (command.verb != CommandVerb::start_fault || begins_new_fault(command)) return {};
    const auto& entries = timeline_.entries();
    bool known = name.empty();  // all of them
    for (std::size_t i = 0; i < entries.size(); ++i) {
        if (acts_[i].command || entries[i].name != name) continue;
        if (timeline_.is_under_way(i)) return name + " is under way";
        known = true;
    }
    return known ? std::string() : "no fault is called " + name;
}

firmware::ReceiverEvent Director::receiver_event(const Command& command) {
    const StartKind start = firmware::start_kind(command.parameters.text("start")).value_or(StartKind::hot);
    switch (command.verb) {
        case CommandVerb::forget_configuration:
            return firmware::ForgetConfiguration{};
        case CommandVerb::set_baud:
            return firmware::ForceBaud{static_cast<std::uint32_t>(command.parameters.number("baud"))};
        case CommandVerb::restart:
            return firmware::RestartNavigation{start};
        default:
            return firmware::Reboot{start, true};
    }
}

// Those under way that have this name; where there are none, those that were asked for by it. @param name empty: all
std::vector<std::size_t> Director::faults_to_stop(const std::string& name) const {
    std::vector<std::size_t> named, asked;
    for (std::size_t i = 0; i < acts_.size(); ++i) {
        if (!acts_[i].fault || !timeline_.can_end(i)) continue;
        if (name.empty() || timeline_.entries()[i].name == name) named.push_back(i);
        if (acts_[i].asked == name) asked.push_back(i);
    }
    return named.empty() ? asked : named;
}

void Director::start_or_stop(const Command& command, const Scene& scene) {
    const std::string name = command.parameters.text("fault");
    if (command.verb == CommandVerb::stop_fault) {
        for (const std::size_t fault : faults_to_stop(name))
            timeline_.end(fault, scene.now);
        return;
    }
    const auto& entries = timeline_.entries();
    const auto length = command.parameters.optional_number("for_s");
    for (std::size_t i = 0; i < entries.size(); ++i)
        if (acts_[i].fault && (name.empty() || entries[i].name == name))
            timeline_.begin(i, scene.now, length ? std::optional(Seconds(*length)) : std::nullopt);
}

void Director::begin_new_fault(const Command& command, const Scene& scene) {
    FaultEntry entry;
    entry.kind = command.parameters.text("kind");
    if (find_fault_kind(entry.kind) == nullptr) return;
    entry.parameters = command.parameters;
    entry.when = read_timeline_entry(command.parameters).entry;
    entry.when.by_hand = true;
    const std::string asked = entry.when.name.empty() ? entry.kind : entry.when.name;
    entry.when.name = free_name(asked, [&](const std::string& name) {
        const auto& entries = timeline_.entries();
        return std::any_of(entries.begin(), entries.end(), [&](const TimelineEntry& e) { return e.name == name; });
    });
    for (std::size_t i = 0; i < scene.stations.size(); ++i)
        if (command.is_for(scene.stations[i].name())) entry.receivers.push_back(i);
    const std::size_t index = timeline_.add(entry.when);
    acts_.push_back({std::move(entry), std::nullopt, asked});
    timeline_.begin(index, scene.now);
}

void Director::set_pace(const Command& command, const Scene& scene) {
    const bool of_silence = command.source == silence_source;
    switch (command.verb) {
        case CommandVerb::pause:
            (of_silence ? waits_ : paused_) = true;
            return scene.pacer.pause(scene.now);
        case CommandVerb::resume:
            if (!of_silence) pause_at_.reset();
            return release(of_silence, scene);
        case CommandVerb::step:
            pause_at_ = advanced(scene.now, Seconds(command.parameters.number("seconds")));
            return release(false, scene);
        default:
            speed_ = command.parameters.number("factor");
            return scene.pacer.set_speed(speed_ * pace_, scene.now);
    }
}

// A run stands still until all let it go on that had it stand. Whoever asks for it where nobody else has paused the run
// does without the live source.
void Director::release(bool heard, const Scene& scene) {
    (heard || !paused_ ? waits_ : paused_) = false;
    if (!paused_ && !waits_) scene.pacer.resume(scene.now);
}

double Director::strength(std::string_view fault, int occurrence, GpsTime now,
                          const std::vector<Station>& stations) const {
    double most = 0;
    const auto& entries = timeline_.entries();
    for (const Station& station : stations)
        for (std::size_t i = 0; i < entries.size() && !station.faults().empty(); ++i)
            if (acts_[i].fault && entries[i].name == fault)
                most = std::max(most, station.faults().strength(i, occurrence, now));
    return most;
}

void Director::show(const EpochSeen& seen) {
    if (seen.station == 0) {
        const TruthState& truth = seen.trace.truth;
        timeline_.look(seen.now, {truth.geodetic, ground_speed(truth), seen.trace.epoch.fix.has_position()});
    }
    for (RunObserver* observer : observers_)
        observer->on_epoch(seen);
}

void Director::show(const MessageSeen& seen) {
    if (seen.from_client && hears_) timeline_.hear(seen.now, seen.name);
    for (RunObserver* observer : observers_)
        observer->on_message(seen);
}

void Director::show(const BeliefSeen& seen) {
    for (RunObserver* observer : observers_)
        observer->on_belief(seen);
}

}  // namespace skyloop::inline run
