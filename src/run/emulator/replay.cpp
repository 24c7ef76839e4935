#include "run/emulator/replay.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "run/emulator/timing.hpp"

namespace skyloop::inline run {
namespace {

constexpr Nanoseconds grace{500'000'000};     // for clients to read the rest
constexpr Nanoseconds line_rests{5'000'000};  // without bytes for so long, half a character is over

// The clock of a recording begins with its first write.
GpsTime on_clock(Nanoseconds time) { return GpsTime(time); }

}  // namespace

Replay::Replay(Parts parts) : parts_(std::move(parts)), done_(parts_.ports.size(), 0) {
    for (std::unique_ptr<Transport>& wire : parts_.wires)
        links_.emplace_back(std::move(wire), parts_.baud);
}

std::optional<Nanoseconds> Replay::next_write() const {
    std::optional<Nanoseconds> next;
    for (std::size_t i = 0; i < parts_.ports.size(); ++i) {
        const std::vector<RecordedWrite>& writes = parts_.ports[i].writes;
        if (done_[i] < writes.size() && (!next || writes[done_[i]].at < *next)) next = writes[done_[i]].at;
    }
    return next;
}

bool Replay::all_ended() const {
    return std::all_of(links_.begin(), links_.end(), [](const Link& link) { return link.ended(); });
}

void Replay::look(Nanoseconds now) {
    for (Link& link : links_) {
        link.look(on_clock(now));
        while (link.receive(parts_.baud, on_clock(now))) {
        }
    }
}

void Replay::write_due(Nanoseconds now, Nanoseconds late) {
    for (std::size_t i = 0; i < parts_.ports.size(); ++i) {
        const RecordedPort& port = parts_.ports[i];
        for (; done_[i] < port.writes.size() && port.writes[done_[i]].at <= now; ++done_[i]) {
            const RecordedWrite& write = port.writes[done_[i]];
            if (links_[i].ended()) continue;
            links_[i].send(ByteSpan(port.bytes).subspan(write.offset, write.length), parts_.baud, false);
            lateness_.add(late +
                          Nanoseconds(std::llround(static_cast<double>((now - write.at).count()) / parts_.speed)));
            ++writes_;
        }
        if (done_[i] == port.writes.size() || port.writes[done_[i]].at > now + line_rests)
            links_[i].send({}, parts_.baud, true);
    }
}

void Replay::await_clients(const Stop& stop) {
    const auto connected = [](const Link& link) { return link.connected(); };
    for (look(Nanoseconds(0)); !stop() && !std::all_of(links_.begin(), links_.end(), connected); look(Nanoseconds(0)))
        Pacer::rest();
}

void Replay::play(const Stop& stop) {
    RealtimePacer pacer(on_clock(Nanoseconds(0)), steady_clock_ns(), parts_.speed);
    Nanoseconds now{0};
    std::optional<Nanoseconds> end;
    while (!stop() && (!end || now < *end) && !all_ended()) {
        const auto next = next_write();
        if (!next && !end) end = now + Nanoseconds(std::llround(static_cast<double>(grace.count()) * parts_.speed));
        const Nanoseconds due = std::min(next ? *next : *end, now + pacer.tick(true));
        const auto late = pacer.wait_until(on_clock(due));
        if (!late) continue;
        now = due;
        look(now);
        write_due(now, *late);
    }
}

}  // namespace skyloop::inline run
