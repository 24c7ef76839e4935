// Classes MON and SEC: who the receiver is, and how it does (RECEIVER.md 2.1, 3.2, 4.11).
// MON-COMMS, TXBUF, RXBUF, IO and MSGPP (RECEIVER.md 1.5, 3.2).

#include <algorithm>
#include <cmath>

#include "firmware/messages/field_values.hpp"
#include "firmware/messages/make_message.hpp"
#include "receiver/protocol/ubx_hardware.hpp"
#include "receiver/protocol/ubx_mon.hpp"

namespace skyloop::firmware {
namespace {

// Hardware of the X20, the first whose SEC-SIG has version 2 (RECEIVER.md 3.2).
constexpr std::string_view x20_hardware = "000B";
constexpr int jamming_warning = 2;

MonVer version(const ReportContext& context) {
    const Identity& identity = context.board.identity;
    MonVer m;
    m.sw_version = padded_text<30>(identity.software);
    m.hw_version = padded_text<10>(identity.hardware);
    for (const std::string& text : identity.extensions)
        m.extensions.push_back({padded_text<30>(text)});
    return m;
}

// Bits of MON-GNSS.
struct SystemBit {
    Constellation constellation;
    std::uint8_t bit;
};
constexpr SystemBit system_bits[] = {
    {Constellation::gps, 1}, {Constellation::glonass, 2}, {Constellation::beidou, 4}, {Constellation::galileo, 8}};

MonGnss systems(const ReportContext& context) {
    const BoardProfile& board = context.board;
    MonGnss m;
    m.supported = board.gnss_supported;
    m.simultaneous = board.gnss_simultaneous;
    for (const SystemBit& system : system_bits) {
        const bool from_factory =
            std::ranges::find(board.constellations, system.constellation) != board.constellations.end();
        if (from_factory) m.default_gnss |= system.bit;
        if (context.config.has_on(system.constellation)) m.enabled |= system.bit;
    }
    return m;
}

// MON-SYS bootType by BootCause: 1 cold, 3 and 6 resets, 5 of the software's own doing (RECEIVER.md 3.2).
constexpr std::array<std::uint8_t, 4> boot_types{1, 3, 6, 5};

// The load that tracking takes: that of a captured ZED-F9P, 22 % with 20 satellites.
MonSys system_load(const ReportContext& context) {
    constexpr double idle_percent = 8, percent_per_satellite = 0.7;
    const auto& satellites = context.state.epoch.fix.satellites;
    const auto tracked = std::ranges::count_if(satellites, [](const SatelliteStatus& s) { return s.cn0.has_value(); });
    MonSys m;
    m.boot_type = boot_types[static_cast<std::size_t>(context.state.boot_cause)];
    m.cpu_load = m.cpu_load_max =
        nearest<std::uint8_t>(std::min(100.0, idle_percent + percent_per_satellite * static_cast<double>(tracked)));
    m.mem_usage = 8;
    m.mem_usage_max = 19;
    for (const PortStatus& port : context.ports) {
        m.io_usage = std::max(m.io_usage.raw, nearest<std::uint8_t>(port.usage_percent));
        m.io_usage_max = std::max(m.io_usage_max.raw, nearest<std::uint8_t>(port.peak_usage_percent));
    }
    m.run_time.set(std::floor(context.state.since_boot.value()));
    m.temp_value = nearest<std::int8_t>(context.state.monitors.temperature);
    return m;
}

SecUniqid unique_id(const ReportContext& context) {
    SecUniqid m;
    m.unique_id = context.board.identity.unique_id;
    m.unique_id.resize(m.unique_id.size() > 5 ? 6 : 5);
    m.version = m.unique_id.size() == 6 ? 2 : 1;
    return m;
}

std::vector<Bytes> signal_security(const ReportContext& context) {
    const MonitorStatus& monitors = context.state.monitors;
    const int spoofing = static_cast<int>(monitors.spoofing);
    const int jam_flags = (context.config.watches_interference ? 1 : 0) | std::clamp(monitors.jamming_state(), 0, 3)
                                                                              << 1;
    if (!context.board.identity.hardware.starts_with(x20_hardware)) {
        SecSig1 m;
        m.jam_flags = static_cast<std::uint8_t>(jam_flags);
        m.spf_flags = static_cast<std::uint8_t>(1 | spoofing << 1);
        return ubx_frames_of(m);
    }
    // Its jamming states end at 2. L1, L2 and the lower end of L5, as captured, kHz.
    SecSig2 m;
    const int jamming = std::clamp(monitors.jamming_state(), 0, jamming_warning);
    m.sig_sec_flags = static_cast<std::uint8_t>((jam_flags & 1) | jamming << 1 | 8 | spoofing << 4);
    const std::uint8_t upper = monitors.upper.jamming_state >= jamming_warning ? 1 : 0;
    const std::uint8_t lower = monitors.lower.jamming_state >= jamming_warning ? 1 : 0;
    m.bands = {{1575420, upper}, {1227600, lower}, {1207140, lower}};
    return ubx_frames_of(m);
}

// What goes on now; the receiver's state keeps no older events.
SecSiglog security_log(const ReportContext& context) {
    constexpr std::uint8_t simulated_signal = 0, jamming = 4, triggered = 2;
    const MonitorStatus& monitors = context.state.monitors;
    SecSiglog m;
    if (monitors.jamming_state() >= jamming_warning) m.events.push_back({0, jamming, triggered, {}});
    if (monitors.spoofing == SpoofingIndication::indicated || monitors.spoofing == SpoofingIndication::several)
        m.events.push_back({0, simulated_signal, triggered, {}});
    return m;
}

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
        item.tx_usage.set(port.usage_percent);
        item.tx_peak_usage.set(port.peak_usage_percent);
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
        m.usage.set(slot, port.usage_percent);
        m.peak_usage.set(slot, port.peak_usage_percent);
        m.t_usage = std::max(m.t_usage.raw, m.usage[slot]);
        m.t_peak_usage = std::max(m.t_peak_usage.raw, m.peak_usage[slot]);
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

// What arrives is taken at once: the receive buffers are empty.
MonRxbuf receive_buffers(const ReportContext&) { return {}; }
MonPatch patches(const ReportContext&) { return {}; }
MonRxr awake(const ReportContext&) { return {1}; }

constexpr UbxMaker monitor_makers[] = {maker<version>,
                                       maker<systems>,
                                       maker<system_load>,
                                       maker<patches>,
                                       maker<awake>,
                                       maker<unique_id>,
                                       {SecSig1::message_id, signal_security},
                                       maker<security_log>,
                                       maker<communications>,
                                       maker<transmit_buffers>,
                                       maker<receive_buffers>,
                                       maker<input_output>,
                                       maker<messages_by_port>};

}  // namespace

std::vector<Bytes> make_monitor_message(UbxMessageId message, const ReportContext& context) {
    std::vector<Bytes> frames = made_by(monitor_makers, message, context);
    return frames.empty() ? make_hardware_message(message, context) : frames;
}

}  // namespace skyloop::firmware
