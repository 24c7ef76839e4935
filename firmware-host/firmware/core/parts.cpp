#include "firmware/core/parts.hpp"

#include "receiver/protocol/casic_frame.hpp"
#include "receiver/protocol/ubx_frame.hpp"

namespace skyloop::firmware {
namespace {

BoardProfile with_sentences(BoardProfile board) {
    if (board.messages.empty())
        for (const std::uint8_t id : nmea_sentence_ids)
            board.messages.push_back({class_nmea, id});
    return board;
}

}  // namespace

UbxMessageId protocol_of(const Bytes& message) {
    constexpr std::uint8_t rtcm3_sync = 0xD3;
    if (message.front() == ubx_sync_1 || message.front() == casic_sync_1) return {};
    return {message.front() == rtcm3_sync ? class_rtcm : class_nmea, 0};
}

ReceiverParts::ReceiverParts(BoardProfile profile, const ReceiverOptions& options, const MakerRow& row)
    : board(with_sentences(std::move(profile))), maker(row.make(board, options)) {
    for (const PortId port : board.ports)
        units.emplace_back(port, config().port(port).baud, board, maker->hears());
}

void ReceiverParts::look_at_ports() {
    statuses.clear();
    for (PortUnit& unit : units) {
        unit.status.pending = unit.transmit.pending();
        statuses.push_back(unit.status);
    }
}

ReportContext ReceiverParts::context(PortId port) {
    look_at_ports();
    return context(port, *reported);
}

ReportContext ReceiverParts::context(PortId port, const NavigationState& state) const {
    return {board, config(), state, statuses, port};
}

void ReceiverParts::send(PortId port, const std::vector<Bytes>& messages, GpsTime now) {
    if (!faults.mute) outbox.queue(port, std::vector<ByteSpan>(messages.begin(), messages.end()), now);
}

void ReceiverParts::send_in_turn(PortId port, const std::vector<ByteSpan>& messages, GpsTime now) {
    if (!faults.mute) outbox.queue_in_turn(port, messages, now);
}

void ReceiverParts::send_text(int level, const std::string& text, GpsTime now) {
    for (const PortId port : board.ports)
        send(port, make_text_message(level, text, context(port)), now);
}

void ReceiverParts::restart_ports() {
    for (PortUnit& unit : units) {
        const PortTotals totals = unit.totals;
        unit = PortUnit(unit.id, config().port(unit.id).baud, board, maker->hears());
        unit.totals = totals;
    }
}

}  // namespace skyloop::firmware
