#include "run/emulator/emulator.hpp"

#include <algorithm>

#include "base/core/threads.hpp"
#include "detail/recorded_files.hpp"

namespace skyloop::inline run {
namespace {

constexpr Nanoseconds no_time{0};

}  // namespace

Emulator::Emulator(Parts parts, GpsTime start)
    : parts_(std::move(parts)), now_(start), traces_(parts_.stations.size()) {
    for (std::size_t i = 0; i < parts_.stations.size(); ++i)
        dialogues_.emplace_back(i,
                                Dialogue::Listener{[this](const MessageSeen& seen) { parts_.director.show(seen); },
                                                   [this](const BeliefSeen& seen) { parts_.director.show(seen); }},
                                parts_.stations[i].receiver().board().maker == firmware::MakerKind::sbf);
    for (Station& station : parts_.stations)
        station.start(start);
    if (parts_.feeds) parts_.director.add_observer(parts_.feeds.get());
    if (parts_.feeds) parts_.feeds->begin(start, parts_.pacer->due_at(start));
}

Result<void> Emulator::begin() {
    if (const auto begun = begin_recordings(); !begun) return begun;
    for (Station& station : parts_.stations)
        for (std::size_t i = 0; i < station.wires().size(); ++i)
            station.transport(i).begin();
    return {};
}

Result<void> Emulator::begin_recordings() {
    if (recorder() == nullptr) return {};
    const bool former = holds_recording(recorder()->folder());
    for (Station& station : parts_.stations)
        if (Recorder* own = station.recorder())
            if (const auto begun = own->begin({std::max<std::size_t>(station.wires().size(), 1), former,
                                               station.simulation().precise() != nullptr});
                !begun)
                return begun;
    if (former) remove_recordings_from(recorder()->folder(), parts_.stations.size());
    return {};
}

GpsTime Emulator::next_instant(GpsTime end) const {
    GpsTime next = end;
    bool busy = false, wired = false;
    for (const Station& station : parts_.stations) {
        next = std::min(next, station.next_epoch());
        busy = busy || station.busy();
        wired = wired || !station.wires().empty();
        if (const auto change = station.next_change(now_)) next = std::min(next, std::max(now_, *change));
        // The clock's own ticks are good enough for clients that have a clock of their own.
        const bool scripted = station.has_scripted_client();
        if (!parts_.pacer->is_virtual() && !scripted) continue;
        if (const auto input = station.next_input(now_)) next = std::min(next, std::max(now_, *input));
        // Whoever keeps the times of messages, or judges by them, wants them as they leave.
        if (!scripted && !station.recorder() && !parts_.director.wants_messages() && !station.is_overheard()) continue;
        if (const auto output = station.next_output()) next = std::min(next, std::max(now_, *output));
    }
    if (const auto event = parts_.director.next_event()) next = std::min(next, std::max(now_, *event));
    const Nanoseconds tick = parts_.pacer->tick(busy);
    if (tick > no_time && wired) next = std::min(next, now_ + tick);
    // What the leader has let the run do is done to the end before he is told so.
    if (parts_.feeds && parts_.feeds->leads())
        if (const auto horizon = parts_.feeds->horizon(); horizon && *horizon > now_) next = std::min(next, *horizon);
    return next;
}

bool Emulator::all_connected() {
    bool all = true;
    for (Station& station : parts_.stations)
        for (std::size_t i = 0; i < station.wires().size(); ++i)
            all = (station.transport(i).line().connected || station.wires()[i].one_way) && all;
    return all;
}

void Emulator::await_clients(const std::atomic<bool>& stop) {
    parts_.pacer->pause(now_);
    while (!stop && !all_connected()) {
        Pacer::rest();
        look();
    }
    parts_.pacer->resume(now_);
}

void Emulator::await_feeds(const std::atomic<bool>& stop, const std::function<void()>& meanwhile) {
    if (!parts_.feeds || parts_.feeds->all_heard()) return;
    parts_.pacer->pause(now_);
    while (!stop && !parts_.feeds->all_heard()) {
        Pacer::rest();
        (void)all_connected();  // a host on the wire must be answered while time rests
        hear_feeds();
        if (meanwhile) meanwhile();
        look();
    }
    parts_.pacer->resume(now_);
}

void Emulator::run_until(GpsTime end, const std::atomic<bool>& stop) {
    advance_to(end, stop);
    finish();
}

bool Emulator::goes_on(GpsTime end, LastInstant last) const {
    if (now_ < end || last == LastInstant::left) return now_ < end;
    return now_ == end && next_event() <= now_;
}

void Emulator::advance_to(GpsTime end, const std::atomic<bool>& stop, LastInstant last) {
    // What is wrong from the first instant on is so before the first byte.
    direct_stations();
    while (goes_on(end, last) && !stop && !stopped()) {
        hear_feeds();
        if (parts_.pacer->paused()) {
            Pacer::rest();
            stand_by();
            continue;
        }
        const GpsTime next = next_instant(end);
        if (!may_go_to(next)) {
            stand_by();
            continue;
        }
        const auto lateness = parts_.pacer->wait_until(next);
        if (stop) break;
        if (!lateness) continue;
        now_ = next;
        const LoopTime time{now_, parts_.pacer->monotonic_ns(now_)};
        carry_out(time);
        direct();
        take_in(time);
        if (now_ < end || last == LastInstant::included) run_epochs(*lateness);
        look();
        if (recording_failed()) break;
    }
}

void Emulator::finish() {
    for (Station& station : parts_.stations)
        station.finish(now_);
}

void Emulator::hear_feeds() {
    if (!parts_.feeds) return;
    auto due_ns = parts_.pacer->due_at(now_);
    if (due_ns && parts_.pacer->paused()) due_ns = steady_clock_ns();  // time stands still: this is when it goes on
    for (Command& command : parts_.feeds->pump(now_, due_ns))
        parts_.director.ask(std::move(command));
}

// Waits a little where a source leads the run's time and has not come so far.
bool Emulator::may_go_to(GpsTime next) {
    if (!parts_.feeds || !parts_.feeds->leads()) return true;
    const auto horizon = parts_.feeds->horizon();
    if (horizon && next <= *horizon) return true;
    parts_.feeds->rest(bytes_out());
    return false;
}

std::uint64_t Emulator::bytes_out() const {
    std::uint64_t bytes = 0;
    for (const Station& station : parts_.stations)
        for (const Wire& wire : station.wires())
            bytes += wire.link.counters().bytes_out;
    return bytes;
}

// Time rests, and commands do not: what has a plug or a switch in the world outside follows them at once.
void Emulator::stand_by() {
    (void)all_connected();  // a host on the wire must be answered while time rests
    direct_stations();
    look();
}

void Emulator::direct_stations() {
    direct();
    for (Station& station : parts_.stations)
        station.follow_faults(now_);
}

void Emulator::direct() { parts_.director.advance(now_, parts_.stations, *parts_.pacer); }

void Emulator::look() const {
    for (const auto& callback : looks_)
        callback(now_);
}

bool Emulator::recording_failed() const {
    return std::any_of(parts_.stations.begin(), parts_.stations.end(),
                       [](const Station& s) { return s.recorder() && s.recorder()->failure(); });
}

void Emulator::carry_out(const LoopTime& time) {
    const bool heard = parts_.director.wants_messages();
    for (std::size_t i = 0; i < parts_.stations.size(); ++i) {
        dialogues_[i].listen(heard);
        parts_.stations[i].carry_out(time, &dialogues_[i]);
    }
    std::vector<Bytes> said;
    for (Station& station : parts_.stations)
        said.push_back(station.take_overheard());
    for (Station& station : parts_.stations)
        if (const auto from = heard_from(station); from && !said[*from].empty())
            station.hear_corrections(said[*from], time.now);
}

// A name that nobody has is a mount point without a receiver.
std::optional<std::size_t> Emulator::heard_from(const Station& station) const {
    const auto& wrong = station.wrong_corrections_from();
    if (!wrong || !station.corrections_from()) return station.corrections_from();
    const auto found = std::find_if(parts_.stations.begin(), parts_.stations.end(),
                                    [&](const Station& other) { return other.name() == *wrong; });
    if (found == parts_.stations.end()) return std::nullopt;
    return static_cast<std::size_t>(found - parts_.stations.begin());
}

void Emulator::take_in(const LoopTime& time) {
    for (std::size_t i = 0; i < parts_.stations.size(); ++i) {
        Station& station = parts_.stations[i];
        station.take_in(time, &dialogues_[i]);
        // As fast as the machine can, the end of the run is soon enough.
        if (!parts_.pacer->is_virtual()) station.keep_state(now_);
    }
}

// All that is due is solved before any of it is reported: a rover needs what its base has at the same instant.
void Emulator::run_epochs(Nanoseconds lateness) {
    auto& stations = parts_.stations;
    for (std::size_t i = 0; i < stations.size(); ++i) {
        traces_[i].reset();
        if (stations[i].next_epoch() == now_) traces_[i] = stations[i].observe();
    }
    const bool any = std::any_of(traces_.begin(), traces_.end(), [](const auto& trace) { return trace.has_value(); });
    if (any && parts_.feeds) parts_.feeds->note_epoch(now_);
    for (std::size_t i = 0; i < stations.size(); ++i) {
        const auto base = stations[i].base();
        if (traces_[i] && base) stations[i].relate(*traces_[i], traces_[*base] ? &*traces_[*base] : nullptr);
    }
    for (std::size_t i = 0; i < stations.size(); ++i) {
        if (!traces_[i]) continue;
        stations[i].report(*traces_[i], lateness, !parts_.pacer->is_virtual());
        const firmware::Receiver& receiver = stations[i].receiver();
        parts_.director.show(EpochSeen{now_, i, *traces_[i], receiver.state(), lateness, receiver.report_time()});
        if (status_) status_({now_, &*traces_[i], lateness, i});
    }
}

std::vector<std::string> receiver_names(const Emulator& emulator) {
    std::vector<std::string> names;
    for (const Station& station : emulator.stations())
        names.push_back(station.name());
    return names;
}

std::vector<std::string> probe_environment(const Emulator& emulator) {
    if (emulator.wires().empty()) return {};
    const std::string description = emulator.wires().front().link.transport().description();
    return {"SKYLOOP_PORT=" + description.substr(0, description.rfind(" ("))};
}

}  // namespace skyloop::inline run
