// MON-HW, HW2, HW3, RF and SPAN (RECEIVER.md 3.2, 4.11).
#include <algorithm>
#include <cmath>

#include "base/core/random.hpp"
#include "firmware/messages/field_values.hpp"
#include "firmware/messages/make_message.hpp"
#include "receiver/protocol/ubx_hardware.hpp"

namespace skyloop::firmware {
namespace {

// Pins of a captured ZED-F9P, bit by pin.
constexpr std::uint32_t pins_peripheral = 0x000081C1, pins_bank = 0x00010000, pins_output = 0x00008000,
                        pins_value = 0x000067DF, pins_used = 0x0001FFBE, pins_pull_high = 0x00007BDB;
constexpr std::array<std::uint8_t, 25> virtual_pins{0xFF, 0x00, 0x01, 0x03, 0x02, 0x10, 0xFF, 0x12, 0x13,
                                                    0x14, 0x15, 0x0E, 0x0A, 0x0B, 0x0F, 0x44, 0x16, 0xFF,
                                                    0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF};
constexpr std::size_t pin_count = 17;
// Offsets and magnitudes of the samples of captured receivers.
constexpr std::int8_t offset_i = 15, offset_q = 11;
constexpr std::uint8_t magnitude_i = 149, magnitude_q = 146;

int shown_jamming_state(const MonitorStatus& monitors, const BandMonitor& band) {
    return monitors.jamming_hidden ? 0 : std::clamp(band.jamming_state, 0, 3);
}

template <class Message>
Message hardware(const MonitorStatus& monitors) {
    Message m;
    m.pin_sel = pins_peripheral;
    m.pin_bank = pins_bank;
    m.pin_dir = pins_output;
    m.pin_val = pins_value;
    m.noise_per_ms.set(monitors.upper.noise_per_ms);
    m.agc_cnt = std::min<std::uint16_t>(8191, nearest<std::uint16_t>(monitors.upper.agc));
    m.a_status = static_cast<std::uint8_t>(monitors.antenna);
    m.a_power.set(monitors.antenna_power);
    m.flags = static_cast<std::uint8_t>(1 | shown_jamming_state(monitors, monitors.upper) << 2);
    m.used_mask = pins_used;
    std::copy_n(virtual_pins.begin(), m.vp.size(), m.vp.begin());
    m.jam_ind.set(monitors.upper.jamming_indicator);
    m.pull_h = pins_pull_high;
    return m;
}

// u-blox 5 and 6: 68 bytes; 7, 8 and the F9P: 60; M9 and later: 56 (RECEIVER.md 2.3, 3.2).
std::vector<Bytes> hardware_message(const ReportContext& context) {
    const MonitorStatus& monitors = context.state.monitors;
    const int generation = context.board.identity.generation;
    if (generation <= 6) return ubx_frames_of(hardware<MonHwLong>(monitors));
    if (generation <= 8 || is_high_precision(context.board)) return ubx_frames_of(hardware<MonHw>(monitors));
    return ubx_frames_of(hardware<MonHwShort>(monitors));
}

MonHw2 front_end(const ReportContext& context) {
    constexpr std::uint8_t from_rom = 114, from_flash = 102;
    MonHw2 m;
    m.ofs_i = offset_i;
    m.mag_i = magnitude_i;
    m.ofs_q = offset_q;
    m.mag_q = magnitude_q;
    m.cfg_source = context.board.identity.software.starts_with("EXT") ? from_flash : from_rom;
    m.low_lev_cfg = 0xFFFF'FFFF;
    return m;
}

// pinMask: 0 peripheral, 1-3 bank, 4 output, 5 high, 6 virtual, 8 pull-up; the number stands in the upper byte of
// pinId.
MonHw3 pins(const ReportContext& context) {
    MonHw3 m;
    m.flags = 1;
    m.hw_version = padded_text<10>(context.board.identity.hardware);
    for (std::size_t i = 0; i < pin_count; ++i) {
        const auto bit = [i](std::uint32_t mask) { return mask >> i & 1u; };
        MonHw3Item item;
        item.pin_id = static_cast<std::uint16_t>(i << 8);
        item.pin_mask =
            static_cast<std::uint16_t>(bit(pins_peripheral) | bit(pins_bank) << 1 | bit(pins_output) << 4 |
                                       bit(pins_value) << 5 | bit(pins_used) << 6 | bit(pins_pull_high) << 8);
        item.vp = virtual_pins[i];
        m.pins.push_back(item);
    }
    return m;
}

// Of each front end, in the order of their blocks.
std::vector<BandMonitor> bands_of(const ReportContext& context) {
    const MonitorStatus& monitors = context.state.monitors;
    if (!context.board.dual_frequency) return {monitors.upper};
    return {monitors.upper, monitors.lower};
}

// All front ends hear through one antenna: of that they report the same.
MonRf radio(const ReportContext& context) {
    const MonitorStatus& monitors = context.state.monitors;
    MonRf m;
    const std::vector<BandMonitor> bands = bands_of(context);
    for (std::size_t block = 0; block < bands.size(); ++block) {
        const BandMonitor& band = bands[block];
        MonRfItem item;
        item.block_id = static_cast<std::uint8_t>(block);
        item.flags = static_cast<std::uint8_t>(shown_jamming_state(monitors, band));
        item.ant_status = static_cast<std::uint8_t>(monitors.antenna);
        item.ant_power.set(monitors.antenna_power);
        item.noise_per_ms.set(band.noise_per_ms);
        item.agc_cnt = std::min<std::uint16_t>(8191, nearest<std::uint16_t>(band.agc));
        item.jam_ind.set(band.jamming_indicator);
        item.ofs_i = offset_i;
        item.mag_i = magnitude_i;
        item.ofs_q = offset_q;
        item.mag_q = magnitude_q;
        m.blocks.push_back(item);
    }
    return m;
}

// The passband of the front end, and a peak of what the jamming indicator says at the carrier. From bin to bin it is as
// rough as an average of some twenty spectra (invented).
MonSpanItem spectrum(double centre_hz, const BandMonitor& monitor, RandomStream dice) {
    constexpr double step_hz = 500e3, floor_quarter_db = 27, passband_quarter_db = 80, passband_hz = 20e6,
                     jam_quarter_db = 0.4, jam_hz = 1e6, roughness_quarter_db = 2, most_roughness = 3;
    MonSpanItem item;
    item.span = 128'000'000;
    item.res = 500'000;
    item.center.set(centre_hz);
    item.pga.set(38.0 * monitor.agc / 8191.0 + 19.0);
    for (std::size_t i = 0; i < item.spectrum.size(); ++i) {
        const double offset_hz = (static_cast<double>(i) - 127.5) * step_hz;
        const double filter = passband_quarter_db / (1 + std::pow(offset_hz / passband_hz, 4));
        const double peak = jam_quarter_db * monitor.jamming_indicator / (1 + std::pow(offset_hz / jam_hz, 2));
        const double rough = roughness_quarter_db * std::clamp(dice.normal(), -most_roughness, most_roughness);
        item.spectrum[i] = nearest<std::uint8_t>(floor_quarter_db + filter + peak + rough);
    }
    return item;
}

MonSpan spectra(const ReportContext& context) {
    const double lower_hz = context.board.second_band == SecondBand::l5 ? 1176450000 : 1227600000;
    const double centres_hz[] = {1575420000, lower_hz};
    MonSpan m;
    const std::vector<BandMonitor> bands = bands_of(context);
    for (std::size_t block = 0; block < bands.size(); ++block)
        m.blocks.push_back(spectrum(centres_hz[block], bands[block],
                                    {context.state.monitors.dice, block == 0 ? "span.upper" : "span.lower"}));
    return m;
}

constexpr UbxMaker hardware_makers[] = {
    {MonHw::message_id, hardware_message}, maker<front_end>, maker<pins>, maker<radio>, maker<spectra>};

}  // namespace

std::vector<Bytes> make_hardware_message(UbxMessageId message, const ReportContext& context) {
    return made_by(hardware_makers, message, context);
}

}  // namespace skyloop::firmware
