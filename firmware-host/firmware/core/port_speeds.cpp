#include "firmware/core/port_speeds.hpp"

#include <algorithm>

namespace skyloop::firmware {

// Until a client sets another one.
bool PortSpeeds::holds_forced() const {
    return forced_ &&
           parts_.config().port(PortId::uart1).baud == (forced_->is_setting ? forced_->speed : forced_->before);
}

// A forced speed that the board cannot be set to stands in no setting: the receiver would refuse all that it is sent,
// and what it saved.
std::uint32_t PortSpeeds::wanted(PortId port) const {
    if (port != PortId::uart1 || !holds_forced()) return parts_.config().port(port).baud;
    return std::clamp(forced_->speed, slowest_baud, fastest_baud);
}

bool PortSpeeds::is_set(PortId port) const { return wanted(port) == find_unit(parts_.units, port)->configured_baud; }

bool PortSpeeds::are_set() const {
    return std::ranges::all_of(parts_.units, [&](const PortUnit& unit) { return is_set(unit.id); });
}

void PortSpeeds::plan_changes(GpsTime at) {
    const bool drain = parts_.board.quirks.speed_change == SpeedChangeAnswer::at_old_speed;
    for (PortUnit& unit : parts_.units) {
        if (is_set(unit.id)) continue;
        unit.configured_baud = wanted(unit.id);
        parts_.outbox.plan(at, [this, port = unit.id, drain](GpsTime t) {
            const Port& line = find_unit(parts_.units, port)->transmit;
            const GpsTime when = drain ? line.drained_at().value_or(t) : line.between_bytes(t);
            parts_.outbox.plan(when, [this, port](GpsTime then) { change(port, then); });
        });
    }
}

void PortSpeeds::change_now(GpsTime now) {
    for (PortUnit& unit : parts_.units) {
        if (is_set(unit.id)) continue;
        unit.configured_baud = wanted(unit.id);
        parts_.outbox.plan(unit.transmit.between_bytes(now),
                           [this, port = unit.id](GpsTime then) { change(port, then); });
    }
}

void PortSpeeds::change(PortId port, GpsTime at) {
    PortUnit& unit = *find_unit(parts_.units, port);
    unit.transmit.set_baud(unit.configured_baud, at);
    unit.forget_input();
}

void PortSpeeds::force(const ForceBaud& wanted) {
    const bool holds = holds_forced();
    if (holds) parts_.maker->set_speed(forced_->before);
    if (wanted.baud == 0) return release();
    if (!holds && wanted.given_back) return;
    forced_ = Forced{wanted.baud, parts_.config().port(PortId::uart1).baud, parts_.maker->takes_speed(wanted.baud)};
    if (forced_->is_setting) parts_.maker->set_speed(wanted.baud);
}

}  // namespace skyloop::firmware
