#include "firmware/core/port_input.hpp"

namespace skyloop::firmware {
namespace {

using namespace std::chrono_literals;

// A frame that was begun and not ended within this belongs to a client's hunt for the speed.
constexpr Nanoseconds frame_timeout = 2s;

void count_input(PortStatus& status, const StreamPiece& piece) {
    switch (piece.kind) {
        case StreamKind::ubx:
            ++status.messages_in[0];
            break;
        case StreamKind::nmea:
            ++status.messages_in[1];
            break;
        case StreamKind::rtcm3:
            ++status.messages_in[2];
            break;
        case StreamKind::command:
        case StreamKind::casic:
            break;
        default:
            status.skipped += static_cast<std::uint32_t>(piece.bytes.size());
            break;
    }
}

}  // namespace

void PortInput::receive(PortUnit& unit, ByteSpan bytes, GpsTime now) {
    unit.status.bytes_in += bytes.size();
    give_up_unfinished(unit, now);
    give_way(unit, now);
    unit.last_input = now;
    const auto damaged = [&] { return unit.splitter.counts().bad[static_cast<std::size_t>(StreamKind::rtcm3)]; };
    std::uint64_t known = damaged();
    const std::vector<StreamPiece> pieces = parts_.maker->cut(unit, bytes, now);
    for (; known < damaged(); ++known)
        damaged_(unit, now);
    work_off(unit, pieces, now);
    plan_to_give_way(unit);
}

// Planned, so that what comes out does not depend on when one looks.
void PortInput::plan_to_give_way(const PortUnit& unit) {
    const std::optional<GpsTime> at = unit.splitter.gives_way_at();
    if (at && parts_.maker->has_frames())
        parts_.outbox.plan(*at, [this, port = unit.id](GpsTime t) { give_way(*find_unit(parts_.units, port), t); });
}

void PortInput::give_way(PortUnit& unit, GpsTime now) {
    const std::optional<GpsTime> at = unit.splitter.gives_way_at();
    if (!at || now < *at || !parts_.maker->has_frames()) return;
    work_off(unit, unit.splitter.give_way(), *at);
}

void PortInput::give_up_unfinished(PortUnit& unit, GpsTime now) {
    if (now - unit.last_input <= frame_timeout) return;
    give_way(unit, now);
    unit.last_input = now;
    work_off(unit, unit.splitter.finish(), now);
}

void PortInput::work_off(PortUnit& unit, const std::vector<StreamPiece>& pieces, GpsTime now) {
    for (const StreamPiece& piece : pieces) {
        count_input(unit.status, piece);
        const std::uint32_t baud = unit.configured_baud;
        // What follows was sent at a speed that the port no longer has, or to a receiver that starts.
        if (handle_(unit, piece, now) && unit.configured_baud == baud) continue;
        return unit.forget_input();
    }
}

}  // namespace skyloop::firmware
