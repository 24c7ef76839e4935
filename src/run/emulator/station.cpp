#include "run/emulator/station.hpp"

#include <algorithm>
#include <iterator>

#include "run/emulator/antenna_path.hpp"
#include "run/emulator/wires.hpp"

namespace skyloop::inline run {
namespace {

using firmware::PortId;

PortSpeed speed_of(PortId port, std::uint32_t baud) { return firmware::is_uart(port) ? PortSpeed(baud) : PortSpeed(); }

}  // namespace

PortSpeed port_speed(const firmware::Receiver& receiver, PortId port) { return speed_of(port, receiver.baud(port)); }

std::uint32_t first_baud(const firmware::Receiver& receiver) {
    return port_speed(receiver, default_port(receiver.board())).value_or(receiver.board().baud);
}

// Of the wires beside those of the ports: random numbers of their own.
constexpr std::size_t corrections_wire = 1000, first_listener = 1001;

Station::Station(Parts parts) : parts_(std::move(parts)), corrections_wire_(parts_.seed, corrections_wire) {
    for (std::size_t i = 0; i < std::max<std::size_t>(parts_.wires.size(), 1); ++i)
        faulty_wires_.emplace_back(parts_.seed, i);
    if (!parts_.overheard) return;
    overheard_ = std::make_shared<Bytes>();
    add_tap(default_port(parts_.receiver.board()),
            [kept = overheard_](ByteSpan bytes, GpsTime) { kept->insert(kept->end(), bytes.begin(), bytes.end()); });
}

void Station::add_tap(PortId port, Tap tap) {
    listeners_.push_back({port, FaultyWire(parts_.seed, first_listener + listeners_.size()), std::move(tap)});
}

void Station::start(GpsTime now) {
    parts_.receiver.start(now);
    grid_.start(now, parts_.receiver.settings().navigation_period);
}

bool Station::busy() const {
    return parts_.receiver.drained_at().has_value() ||
           std::any_of(parts_.wires.begin(), parts_.wires.end(),
                       [](const Wire& w) { return w.link.connected() || w.link.input_pending(); });
}

// A frame of corrections amid one of a client's would break both.
bool Station::has_to_wait(std::size_t wire) const {
    const Wire& own = parts_.wires[wire];
    return own.one_way && std::any_of(parts_.wires.begin(), parts_.wires.end(), [&](const Wire& other) {
               return !other.one_way && other.port == own.port && other.link.input_pending();
           });
}

// A client in simulated time acts on all that has left by now.
void Station::carry_out(const LoopTime& time, Dialogue* dialogue) {
    speak(time, dialogue);
    for (Wire& wire : parts_.wires)
        wire.link.look(time.now);
}

// Bytes that have crossed a wire by now did so under what was wrong with it before.
void Station::take_in(const LoopTime& time, Dialogue* dialogue) {
    bool heard = hear_again(time.now, dialogue);
    for (std::size_t i = 0; i < faulty_wires_.size(); ++i)
        heard = hear(i, time.now, dialogue) || heard;
    hear_corrections({}, time.now);
    if (heard) speak(time, dialogue);
    follow_faults(time.now);
    follow_settings(time.now);
}

// Byte by byte: one may change the speed, and with it what the next means. A recording does not tell which bytes came
// together, so that they must not be taken together the first time either.
void Station::input(PortId port, ByteSpan bytes, GpsTime now) {
    for (const std::uint8_t byte : bytes)
        parts_.receiver.input(port, ByteSpan(&byte, 1), now);
}

void Station::hear_corrections(Bytes bytes, GpsTime now) {
    input(default_port(parts_.receiver.board()), corrections_wire_.to_receiver(std::move(bytes), now), now);
}

bool Station::hear_again(GpsTime now, Dialogue* dialogue) {
    const std::size_t before = heard_again_;
    for (; heard_again_ < parts_.repeated.size() && parts_.repeated[heard_again_].at <= now; ++heard_again_) {
        const HeardBytes& heard = parts_.repeated[heard_again_];
        if (dialogue != nullptr) dialogue->client_said(heard.wire, heard.bytes, now);
        input(heard.port, heard.bytes, now);
        if (parts_.recorder && heard.wire < faulty_wires_.size())
            parts_.recorder->record_input(heard.bytes, now, heard.wire);
    }
    return heard_again_ > before;
}

// What has ended is taken back at the first look after it.
void Station::follow_faults(GpsTime now) {
    for (const firmware::ReceiverEvent& event : faults_.settle(now))
        parts_.receiver.happen(event, now);
    if (faults_.empty() && !faults_act_) return;
    faults_act_ = !faults_.empty();
    parts_.receiver.set_faults(faults_.firmware(now));
    WireConditions conditions = faults_.wire(now);
    follow_faults_of_corrections(conditions, now);
    if (!parts_.repeated.empty()) conditions.to_receiver.garbage.clear();  // it was heard, and is heard again
    for (FaultyWire& wire : faulty_wires_)
        wire.set(conditions, now);
    conditions.to_receiver = {};
    for (Listener& listener : listeners_)
        listener.wire.set(conditions, now);
    for (Wire& wire : parts_.wires)
        wire.link.set_plugged(!conditions.unplugged);
    if (parts_.power) parts_.power->want(conditions.power_cut ? PowerState::cut : PowerState::on);
}

// The way in of the wire from another receiver.
void Station::follow_faults_of_corrections(WireConditions conditions, GpsTime now) {
    if (!parts_.corrections_from) return;
    wrong_corrections_from_ = conditions.corrections_from;
    conditions.to_client = {};
    corrections_wire_.set(conditions, now);
}

// An end without a wire hears what its bare contacts pick up.
bool Station::hear(std::size_t wire, GpsTime now, Dialogue* dialogue) {
    FaultyWire& faulty = faulty_wires_[wire];
    bool any = false;
    const auto take = [&](Bytes bytes) {
        any = hand_over(wire, faulty.to_receiver(std::move(bytes), now), now, dialogue) || any;
    };
    if (wire < parts_.wires.size() && !has_to_wait(wire)) {
        while (auto heard = parts_.wires[wire].link.receive(line_speed(wire), now))
            if (!heard->empty()) take(std::move(*heard));
    }
    take({});  // what was held, and garbage, come without a client's doing
    if (dialogue == nullptr || wire >= parts_.wires.size()) return any;
    SimulatedEnd* end = parts_.wires[wire].link.simulated_end();
    if (const auto belief = end != nullptr ? end->new_belief() : std::nullopt)
        dialogue->client_believes(wire, *belief, now);
    return any;
}

bool Station::hand_over(std::size_t wire, const Bytes& heard, GpsTime now, Dialogue* dialogue) {
    if (heard.empty() || parts_.mute_wires.contains(wire)) return false;
    if (dialogue != nullptr) dialogue->client_said(wire, heard, now);
    input(port_of(wire), heard, now);
    if (parts_.recorder) parts_.recorder->record_input(heard, now, wire);
    return true;
}

PortId Station::port_of(std::size_t wire) const {
    // Without a wire, what would leave by the port of an unnamed one is kept.
    return parts_.wires.empty() ? default_port(parts_.receiver.board()) : parts_.wires[wire].port;
}

void Station::speak(const LoopTime& time, Dialogue* dialogue) {
    const std::vector<firmware::Receiver::Sent> pieces = parts_.receiver.output(time.now);
    const bool at_rest = !parts_.receiver.drained_at().has_value();
    show(pieces, time.now);
    for (std::size_t i = 0; i < faulty_wires_.size(); ++i) {
        if (i < parts_.wires.size() && parts_.wires[i].one_way) continue;
        std::vector<firmware::Receiver::Sent> own;
        for (const firmware::Receiver::Sent& piece : pieces) {
            if (piece.port != port_of(i)) continue;
            if (dialogue != nullptr) dialogue->receiver_said(i, piece.bytes, time.now);
            own.push_back(piece);
        }
        own = faulty_wires_[i].to_client(std::move(own), time.now);
        if (i < parts_.wires.size()) send_on_wire(i, own, at_rest);
        if (!parts_.recorder) continue;
        for (const firmware::Receiver::Sent& piece : own)
            parts_.recorder->record_output(piece.bytes, time, i);
    }
}

void Station::show(const std::vector<firmware::Receiver::Sent>& pieces, GpsTime now) {
    for (Listener& listener : listeners_) {
        std::vector<firmware::Receiver::Sent> own;
        std::copy_if(pieces.begin(), pieces.end(), std::back_inserter(own),
                     [&](const firmware::Receiver::Sent& piece) { return piece.port == listener.port; });
        for (const firmware::Receiver::Sent& piece : listener.wire.to_client(std::move(own), now))
            listener.tap(piece.bytes, now);
    }
}

void Station::send_on_wire(std::size_t wire, const std::vector<firmware::Receiver::Sent>& pieces, bool at_rest) {
    Link& link = parts_.wires[wire].link;
    const PortId port = parts_.wires[wire].port;
    const std::optional<std::uint32_t> line_baud = faulty_wires_[wire].line_baud();
    for (const firmware::Receiver::Sent& piece : pieces)
        link.send(piece.bytes, speed_of(port, line_baud.value_or(piece.baud)), false);
    link.send({}, line_speed(wire), at_rest);
}

PortSpeed Station::line_speed(std::size_t wire) const {
    const PortSpeed own = speed(parts_.wires[wire].port);
    const std::optional<std::uint32_t> line_baud = faulty_wires_[wire].line_baud();
    return own && line_baud ? line_baud : own;
}

void Station::happen(const firmware::ReceiverEvent& event, GpsTime now) { parts_.receiver.happen(event, now); }

void Station::lead_along(std::unique_ptr<Trajectory> path) {
    parts_.simulation.replace_trajectory([&](const std::unique_ptr<Trajectory>&) { return std::move(path); });
}

void Station::move_to(const Geodetic& place, GpsTime now) {
    parts_.simulation.replace_trajectory(
        [&](std::unique_ptr<Trajectory> path) { return MovedPath::moved(std::move(path), place, now); });
}

std::optional<GpsTime> Station::next_change(GpsTime now) const {
    std::optional<GpsTime> next = faults_.next_faded();
    if (const auto at = parts_.receiver.next_change(); at && (!next || *at < *next)) next = at;
    if (heard_again_ < parts_.repeated.size() && (!next || parts_.repeated[heard_again_].at < *next))
        next = parts_.repeated[heard_again_].at;
    const auto look_at = [&](const FaultyWire& wire) {
        if (const auto at = wire.next_at(now); at && (!next || *at < *next)) next = at;
    };
    std::for_each(faulty_wires_.begin(), faulty_wires_.end(), look_at);
    look_at(corrections_wire_);
    for (const Listener& listener : listeners_)
        look_at(listener.wire);
    return next;
}

std::optional<GpsTime> Station::next_output() const {
    std::optional<GpsTime> next;
    for (std::size_t i = 0; i < faulty_wires_.size(); ++i)
        if (const auto at = parts_.receiver.next_output(port_of(i)); at && (!next || *at < *next)) next = at;
    return next;
}

std::optional<GpsTime> Station::next_input(GpsTime now) const {
    std::optional<GpsTime> next;
    for (std::size_t i = 0; i < parts_.wires.size(); ++i) {
        const Link& link = parts_.wires[i].link;
        const SimulatedEnd* end = link.simulated_end();
        for (const auto& at : {link.next_arrival(line_speed(i)), end != nullptr ? end->acts_at(now) : std::nullopt})
            if (at && (!next || *at < *next)) next = at;
    }
    return next;
}

bool Station::has_scripted_client() const {
    return std::any_of(parts_.wires.begin(), parts_.wires.end(), [](const Wire& w) {
        const SimulatedEnd* end = w.link.simulated_end();
        return end != nullptr && end->acts_at({});
    });
}

// What measurement and solution respect is handed to them with each epoch; the loop itself respects the period.
void Station::follow_settings(GpsTime now) { grid_.follow(now, parts_.receiver.settings().navigation_period); }

Trace Station::observe() {
    const GpsTime now = grid_.next();
    grid_.pass();
    if (faults_.empty()) return parts_.simulation.run(now, parts_.receiver.settings_at(now), nullptr);
    ReceiverSettings settings = parts_.receiver.settings_at(now);
    if (faults_.wire(now).power_cut) settings.navigating = false;
    return parts_.simulation.run(now, settings, &faults_);
}

void Station::relate(Trace& trace, const Trace* base) {
    if (!parts_.moving_base) return;
    if (trace.measures) return parts_.simulation.relate(trace, base);
    if (base)
        trace.epoch.relative = parts_.moving_base->relate(*base, trace);
    else
        parts_.moving_base->hold(trace);
    // The vector is exact, the place is only as good as the base's own: its accuracies stay.
    trace.epoch.fix.type = parts_.moving_base->fix_type().value_or(trace.epoch.fix.type);
}

void Station::report(const Trace& trace, Nanoseconds lateness, bool safe) {
    firmware::ReportEdit edit;
    if (!faults_.empty()) edit = [&](firmware::NavigationState& state) { faults_.edit_report(state, trace); };
    parts_.receiver.on_epoch(trace.epoch, edit);
    if (parts_.recorder) {
        parts_.recorder->record(trace, parts_.simulation.navigation());
        if (safe) parts_.recorder->flush();
    }
    ++counts_.epochs;
    if (trace.epoch.fix.has_position()) ++counts_.epochs_with_fix;
    counts_.lateness.add(lateness);
    follow_settings(trace.truth.time);
    tell_position();
}

// Casters make corrections for a place.
void Station::tell_position() {
    for (const Wire& wire : parts_.wires) {
        if (wire.corrections == nullptr || !wire.corrections->wants_position()) continue;
        if (std::string sentence = parts_.receiver.position_sentence(); !sentence.empty())
            wire.corrections->tell_position(std::move(sentence));
    }
}

std::uint64_t Station::total(std::uint64_t firmware::PortTotals::*of) const {
    std::set<PortId> ports;
    for (const Wire& wire : parts_.wires)
        ports.insert(wire.port);
    if (ports.empty()) ports.insert(default_port(parts_.receiver.board()));
    std::uint64_t count = 0;
    for (const PortId port : ports)
        count += parts_.receiver.port_totals(port).*of;
    return count;
}

void Station::keep_state(GpsTime now) {
    if (parts_.state && parts_.state->due(now)) parts_.state->keep(parts_.receiver.persistent_text(), now);
}

void Station::finish(GpsTime now) {
    if (parts_.recorder) parts_.recorder->flush();
    if (parts_.state) parts_.state->keep(parts_.receiver.persistent_text(), now);
    if (parts_.power) parts_.power->finish();
}

}  // namespace skyloop::inline run
