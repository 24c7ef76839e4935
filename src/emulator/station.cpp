#include "skyloop/emulator/station.hpp"

#include <algorithm>

#include "skyloop/emulator/wires.hpp"

namespace skyloop {
namespace {

using firmware::PortId;

PortSpeed speed_of(PortId port, std::uint32_t baud) { return firmware::is_uart(port) ? PortSpeed(baud) : PortSpeed(); }

}  // namespace

PortSpeed port_speed(const firmware::Receiver& receiver, PortId port) { return speed_of(port, receiver.baud(port)); }

void Station::start(GpsTime now) {
    parts_.receiver.start(now);
    grid_.start(now, parts_.receiver.settings().navigation_period);
}

bool Station::busy() const {
    return parts_.receiver.drained_at().has_value() ||
           std::any_of(parts_.wires.begin(), parts_.wires.end(),
                       [](const Wire& w) { return w.link.connected() || w.link.input_pending(); });
}

void Station::exchange(const LoopTime& time) {
    for (std::size_t i = 0; i < parts_.wires.size(); ++i)
        hear(i, time.now);
    speak(time);
    follow_settings(time.now);
}

void Station::hear(std::size_t wire, GpsTime now) {
    auto& [port, link] = parts_.wires[wire];
    link.look(now);
    while (const auto heard = link.receive(speed(port), now)) {
        if (heard->empty()) continue;
        parts_.receiver.input(port, *heard, now);
        if (parts_.recorder) parts_.recorder->record_input(*heard, wire);
    }
}

void Station::speak(const LoopTime& time) {
    const std::vector<firmware::Receiver::Sent> pieces = parts_.receiver.output(time.now);
    const bool at_rest = !parts_.receiver.drained_at().has_value();
    for (auto& [port, link] : parts_.wires) {
        for (const firmware::Receiver::Sent& piece : pieces)
            if (piece.port == port) link.send(piece.bytes, speed_of(port, piece.baud), false);
        link.send({}, speed(port), at_rest);
    }
    if (!parts_.recorder) return;
    for (std::size_t i = 0; i < std::max<std::size_t>(parts_.wires.size(), 1); ++i) {
        // Without a wire, what would leave by the port of an unnamed one is kept.
        const PortId port = parts_.wires.empty() ? default_port(parts_.receiver.board()) : parts_.wires[i].port;
        for (const firmware::Receiver::Sent& piece : pieces)
            if (piece.port == port) parts_.recorder->record_output(piece.bytes, time, i);
    }
}

// What measurement and solution respect is handed to them with each epoch; the loop itself respects the period.
void Station::follow_settings(GpsTime now) { grid_.follow(now, parts_.receiver.settings().navigation_period); }

Trace Station::observe() {
    const GpsTime now = grid_.next();
    grid_.pass();
    return parts_.simulation.run(now, parts_.receiver.settings());
}

void Station::relate(Trace& trace, const Trace* base) {
    if (!parts_.moving_base) return;
    if (!base) return parts_.moving_base->lose();
    trace.epoch.relative = parts_.moving_base->relate(*base, trace);
    // The vector is exact, the place is only as good as the base's own: its accuracies stay.
    if (trace.epoch.relative)
        trace.epoch.fix.type = trace.epoch.relative->fixed ? FixType::rtk_fixed : FixType::rtk_float;
}

void Station::report(const Trace& trace, Nanoseconds lateness, bool safe) {
    parts_.receiver.on_epoch(trace.epoch);
    if (parts_.recorder) {
        parts_.recorder->record(trace, parts_.simulation.navigation());
        if (safe) parts_.recorder->flush();
    }
    ++counts_.epochs;
    if (trace.epoch.fix.has_position()) ++counts_.epochs_with_fix;
    counts_.lateness.add(lateness);
    follow_settings(trace.truth.time);
}

std::set<PortId> Station::wired_ports() const {
    std::set<PortId> ports;
    for (const Wire& wire : parts_.wires)
        ports.insert(wire.port);
    if (ports.empty()) ports.insert(default_port(parts_.receiver.board()));
    return ports;
}

std::uint64_t Station::messages_sent() const {
    std::uint64_t count = 0;
    for (const PortId port : wired_ports())
        count += parts_.receiver.port_status(port).messages_out;
    return count;
}

std::uint64_t Station::messages_dropped() const {
    std::uint64_t count = 0;
    for (const PortId port : wired_ports())
        count += parts_.receiver.port_status(port).messages_dropped;
    return count;
}

void Station::keep_state(GpsTime now) {
    if (parts_.state && parts_.state->due(now)) parts_.state->keep(parts_.receiver.persistent_text(), now);
}

void Station::finish(GpsTime now) {
    if (parts_.recorder) parts_.recorder->flush();
    if (parts_.state) parts_.state->keep(parts_.receiver.persistent_text(), now);
}

}  // namespace skyloop
