// MON-COMMS, TXBUF, RXBUF, IO and MSGPP (RECEIVER.md 1.5, 3.2).
#include <algorithm>

#include "firmware/messages/field_values.hpp"
#include "firmware/messages/monitor_parts.hpp"
#include "receiver/protocol/ubx_ports.hpp"

namespace skyloop::firmware {
namespace {

constexpr std::size_t port_slots = 6;  // DDC, UART1, UART2, USB, SPI, none

std::size_t port_slot(const PortStatus& port) { return static_cast<std::size_t>(port.id); }

// A counter of four bytes goes round.
std::uint32_t byte_counter(std::uint64_t bytes) { return static_cast<std::uint32_t>(bytes & 0xFFFF'FFFFu); }

std::uint16_t pending_field(const PortStatus& port) {
    return static_cast<std::uint16_t>(std::min<std::size_t>(port.pending, 0xFFFF));
}

// The second serial port of the ZED-F9P is 0x0201 (RECEIVER.md 1.5).
std::uint16_t comms_port_id(PortId port, const BoardProfile& board) {
    const auto number = static_cast<std::uint16_t>(static_cast<unsigned>(port) << 8);
    return port == PortId::uart2 && is_high_precision(board) ? static_cast<std::uint16_t>(number | 1) : number;
}

MonComms communications(const ReportContext& context) {
    constexpr std::uint8_t nothing = 255, spartn = 6;
    constexpr unsigned buffer_full = 1u << 1, output_port_shift = 2;  // 1 DDC, 2 UART1, …
    MonComms m;
    m.prot_ids = {0, 1, 5, is_high_precision(context.board) ? spartn : nothing};
    unsigned errors = 0;
    if (context.board.comms_output_port) errors |= (static_cast<unsigned>(context.port) + 1) << output_port_shift;
    for (const PortStatus& port : context.ports) {
        if (port.transmit_full) errors |= buffer_full;
        if (port.bytes_out == 0 && port.bytes_in == 0) continue;
        MonCommsItem item;
        item.port_id = comms_port_id(port.id, context.board);
        item.tx_pending = pending_field(port);
        item.tx_bytes = byte_counter(port.bytes_out);
        item.tx_usage = field<std::uint8_t>(port.usage_percent);
        item.tx_peak_usage = field<std::uint8_t>(port.peak_usage_percent);
        item.rx_bytes = byte_counter(port.bytes_in);
        item.overrun_errs = port.overruns;
        item.msgs = port.messages_in;
        item.skipped = port.skipped;
        m.ports.push_back(item);
    }
    m.tx_errors = static_cast<std::uint8_t>(errors);
    return m;
}

// Errors: the bit of each port whose buffer was full, and 7 for all of them.
MonTxbuf transmit_buffers(const ReportContext& context) {
    MonTxbuf m;
    for (const PortStatus& port : context.ports) {
        const std::size_t slot = port_slot(port);
        m.pending[slot] = pending_field(port);
        m.usage[slot] = field<std::uint8_t>(port.usage_percent);
        m.peak_usage[slot] = field<std::uint8_t>(port.peak_usage_percent);
        m.t_usage = std::max(m.t_usage, m.usage[slot]);
        m.t_peak_usage = std::max(m.t_peak_usage, m.peak_usage[slot]);
        if (port.transmit_full) m.errors = static_cast<std::uint8_t>(m.errors | 1u << slot | 0x80);
    }
    return m;
}

MonIo input_output(const ReportContext& context) {
    MonIo m;
    m.ports.resize(port_slots);
    for (const PortStatus& port : context.ports) {
        MonIoItem& item = m.ports[port_slot(port)];
        item.rx_bytes = byte_counter(port.bytes_in);
        item.tx_bytes = byte_counter(port.bytes_out);
        item.overrun_errs = port.overruns;
    }
    return m;
}

// Protocols of a port: UBX 0, NMEA 1, RTCM 3 5, SPARTN 6 of eight.
MonMsgpp messages_by_port(const ReportContext& context) {
    constexpr std::size_t protocols = 8, places[] = {0, 1, 5, 6};
    MonMsgpp m;
    for (const PortStatus& port : context.ports) {
        for (std::size_t i = 0; i < port.messages_in.size(); ++i)
            m.msg[port_slot(port) * protocols + places[i]] = port.messages_in[i];
        m.skipped[port_slot(port)] = port.skipped;
    }
    return m;
}

}  // namespace

std::vector<Bytes> make_port_message(UbxMessageId message, const ReportContext& context) {
    if (message == MonComms::message_id) return ubx_frames_of(communications(context));
    if (message == MonTxbuf::message_id) return ubx_frames_of(transmit_buffers(context));
    // What arrives is taken at once: the receive buffers are empty.
    if (message == MonRxbuf::message_id) return ubx_frames_of(MonRxbuf{});
    if (message == MonIo::message_id) return ubx_frames_of(input_output(context));
    if (message == MonMsgpp::message_id) return ubx_frames_of(messages_by_port(context));
    return {};
}

}  // namespace skyloop::firmware
