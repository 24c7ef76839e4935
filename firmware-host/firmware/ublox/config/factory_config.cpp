#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "firmware/ublox/config/config_handler.hpp"
#include "firmware/ublox/config/config_keys.hpp"
#include "firmware/ublox/config/legacy_keys.hpp"
#include "firmware/ublox/config/signal_keys.hpp"
#include "receiver/protocol/ubx_cfg.hpp"

namespace skyloop::firmware {
namespace {

// The port that an item belongs to: by its group, by the order of CFG-INFMSG, by the end of its name in CFG-MSGOUT.
std::optional<PortId> port_of(const ConfigKey& key) {
    constexpr struct {
        PortId port;
        std::uint32_t itself, in_protocols, out_protocols;
    } groups[] = {{PortId::i2c, 0x51, 0x71, 0x72},
                  {PortId::uart1, 0x52, 0x73, 0x74},
                  {PortId::uart2, 0x53, 0x75, 0x76},
                  {PortId::usb, 0x65, 0x77, 0x78},
                  {PortId::spi, 0x64, 0x79, 0x7A}};
    constexpr std::uint32_t infmsg = 0x92;
    const std::uint32_t group = key.id >> 16 & 0xFF;
    if (group == infmsg) return static_cast<PortId>(((key.id & 0xFFFF) - 1) % ublox_port_count);
    if (key.name.starts_with("CFG-MSGOUT-")) {
        const auto ends = [&key](std::string_view ending) { return key.name.ends_with(ending); };
        const auto ending = std::ranges::find_if(rate_key_endings, ends);
        return static_cast<PortId>(ending - rate_key_endings.begin());
    }
    for (const auto& [port, itself, in, out] : groups)
        if (group == itself || group == in || group == out) return port;
    return std::nullopt;
}

ConfigValues items_of_board(const BoardProfile& board) {
    ConfigValues values;
    for (const ConfigKey& key : config_keys()) {
        const auto port = port_of(key);
        const bool missing = port && std::ranges::find(board.ports, *port) == board.ports.end();
        const bool stored = is_on_the_wire(board, key.id) || !is_of_ublox(key.id) || (key.lists & listed::kept) != 0;
        if (!missing && stored && !board.absent_keys.contains(key.id)) values.emplace(key.id, key.default_value);
    }
    return values;
}

// Sets an item that the board has; others are left out.
class FactoryWriter {
public:
    explicit FactoryWriter(ConfigValues& values) : values_(values) {}
    void set(std::uint32_t key, std::uint64_t value) {
        if (const auto found = values_.find(key); found != values_.end() && found->first == key) found->second = value;
    }

private:
    ConfigValues& values_;
};

std::uint64_t number_of(NmeaVersion version) {
    constexpr std::uint64_t of_4_0 = 40;
    const auto* const found = std::ranges::find(numbered_nmea_versions, version, &NumberedNmeaVersion::version);
    return found == numbered_nmea_versions.end() ? of_4_0 : found->item;
}

// 0 for one that has no number: by the systems.
std::uint64_t number_of_talker(std::string_view talker) {
    const auto found = std::ranges::find(numbered_talkers, talker);
    return found == numbered_talkers.end() ? 0 : static_cast<std::uint64_t>(found - numbered_talkers.begin());
}

void write_signals(const BoardProfile& board, FactoryWriter& writer) {
    const auto& enabled = board.constellations;
    for (const SystemKeys& system : system_keys_of_signals) {
        const bool on = std::ranges::find(enabled, system.constellation) != enabled.end();
        writer.set(system.enable, on);
        const auto second = second_signal(system.constellation, board.second_band);
        for (const SignalKey& s : signal_keys)
            if (second && s.signal == SystemSignal{system.constellation, *second})
                writer.set(s.enable, board.dual_frequency);
        if (system.constellation == Constellation::navic) writer.set(system.first[0], on);
    }
}

void write_sentences(const BoardProfile& board, FactoryWriter& writer) {
    constexpr std::uint8_t nmea_class = 0xF0;
    for (const OutputMessage& message : output_messages()) {
        if (message.id.message_class != nmea_class) continue;
        std::uint64_t rate = 0;
        for (const SentenceRate& sentence : board.sentences)
            if (nmea_sentence_names[static_cast<std::size_t>(sentence.sentence)] == message.name)
                rate = static_cast<std::uint64_t>(sentence.every_epochs);
        for (std::uint32_t port = 0; port < ublox_port_count; ++port)
            writer.set(message.i2c_key + port, rate);
    }
}

// What CFG-USB answers: texts lie in four items of eight characters, the first one lowest.
void write_usb(const UsbDescription& usb, FactoryWriter& writer) {
    writer.set(legacy_key::usb_vendor_id, usb.vendor_id);
    writer.set(legacy_key::usb_product_id, usb.product_id);
    const auto write_text = [&](std::uint32_t first_key, std::string_view text) {
        for (std::uint32_t part = 0; part < 4; ++part) {
            std::uint64_t value = 0;
            for (std::size_t i = 0; i < 8 && 8 * part + i < text.size(); ++i)
                value |= std::uint64_t{static_cast<unsigned char>(text[8 * part + i])} << (8 * i);
            writer.set(first_key + part, value);
        }
    };
    write_text(legacy_key::usb_vendor_string, usb.manufacturer);
    write_text(legacy_key::usb_product_string, usb.product);
    write_text(legacy_key::usb_serial_number, usb.serial);
}

std::uint64_t measurement_period_ms(const BoardProfile& board) {
    constexpr long long longest = 65535;
    return static_cast<std::uint64_t>(std::clamp(std::llround(1000 / board.default_rate_hz), 1LL, longest));
}

// What a value may be: within one of the rows of its item; an item without a row takes any value.
struct AllowedRange {
    std::uint32_t key;
    std::int64_t least, most;
};

constexpr std::uint32_t time_grid_1 = 0x2005000C, time_grid_2 = 0x20050017;  // CFG-TP-TIMEGRID_TP1, _TP2

// Enumerations of the F9 interface description HPG 1.32, section 6.9; those of M8 lie within (RECEIVER.md 3.3, 3.5.1).
constexpr AllowedRange allowed_ranges[] = {
    {key::tmode_mode, 0, 2},                                          // disabled, survey-in, fixed
    {legacy_key::tmode_pos_type, 0, 1},                               // CFG-TMODE-POS_TYPE: ECEF, LLH
    {legacy_key::tmode_geodetic, -900'000'000, 900'000'000},          // CFG-TMODE-LAT, 1e-7°
    {legacy_key::tmode_geodetic + 1, -1'800'000'000, 1'800'000'000},  // CFG-TMODE-LON
    {time_grid_1, 0, 5},                                              // UTC and five systems
    {time_grid_1, 15, 15},                                            // local
    {time_grid_2, 0, 5},
    {time_grid_2, 15, 15},
    {0x20050023, 0, 1},                       // CFG-TP-PULSE_DEF: period, frequency
    {0x20050030, 0, 1},                       // CFG-TP-PULSE_LENGTH_DEF: ratio, length
    {0x20090009, 0, 2},                       // CFG-RTCM-DF003_IN_FILTER: disabled, relaxed, strict
    {key::navspg_fixmode, 1, 3},              // 2D, 3D, auto
    {key::navspg_utcstandard, 0, 0},          // auto
    {key::navspg_utcstandard, 3, 3},          // USNO
    {key::navspg_utcstandard, 5, 8},          // EU, SU, NTSC, NPLI
    {key::navspg_dynmodel, 0, 0},             // portable
    {key::navspg_dynmodel, 2, 9},             // stationary … wrist
    {key::navspg_min_elev, -90, 90},          // degrees
    {0x201100D6, 0, 63},                      // CFG-NAVSPG-SIGATTCOMP: off, fixed level
    {0x201100D6, 255, 255},                   // automatic
    {key::navhpg_dgnssmode, 2, 3},            // float, fixed
    {key::rate_timeref, 0, 5},                // UTC and five systems
    {0x20220005, 0, 4},                       // CFG-ODO-PROFILE: running … custom
    {0x20240011, 0, 5},                       // CFG-GEOFENCE-CONFLVL: standard deviations
    {0x20240013, 0, 1},                       // CFG-GEOFENCE-PINPOL
    {0x40240021, -900'000'000, 900'000'000},  // CFG-GEOFENCE-FENCE1_LAT, 1e-7°
    {0x40240022, -1'800'000'000, 1'800'000'000},
    {0x40240031, -900'000'000, 900'000'000},  // CFG-GEOFENCE-FENCE2_LAT, 1e-7°
    {0x40240032, -1'800'000'000, 1'800'000'000},
    {0x40240041, -900'000'000, 900'000'000},  // CFG-GEOFENCE-FENCE3_LAT, 1e-7°
    {0x40240042, -1'800'000'000, 1'800'000'000},
    {0x40240051, -900'000'000, 900'000'000},  // CFG-GEOFENCE-FENCE4_LAT, 1e-7°
    {0x40240052, -1'800'000'000, 1'800'000'000},
    {0x20340009, 0, 2},           // CFG-BDS-D1D2_NAVDATA
    {0x20410010, 0, 2},           // CFG-ITFM-ANTSETTING: unknown, passive, active
    {0x20520002, 0, 3},           // CFG-UART1-STOPBITS: half, one, one and a half, two
    {0x20520003, 0, 1},           // CFG-UART1-DATABITS: eight, seven
    {0x20520004, 0, 2},           // CFG-UART1-PARITY: none, odd, even
    {0x20530002, 0, 3},           // CFG-UART2-STOPBITS
    {0x20530003, 0, 1},           // CFG-UART2-DATABITS
    {0x20530004, 0, 2},           // CFG-UART2-PARITY
    {key::nmea_protver, 21, 21},  // 2.1
    {key::nmea_protver, 23, 23},  // 2.3
    {key::nmea_protver, 40, 42},  // 4.0, 4.10, 4.11
    {key::nmea_maxsvs, 0, 0},     // as many as there are
    {key::nmea_maxsvs, 8, 8},
    {key::nmea_maxsvs, 12, 12},
    {key::nmea_maxsvs, 16, 16},
    {key::nmea_svnumbering, 0, 1},  // strict, extended
    {key::nmea_main_talker, 0, 7},  // by the systems, GP, GL, GN, GA, GB, GI, GQ
    {key::nmea_gsv_talker, 0, 1},   // by the systems, the main one
    {0x20A20005, 0, 4},             // CFG-TXREADY-INTERFACE
    {0x20A70001, 0, 1},             // CFG-SPARTN-USE_SOURCE: IP, L-band
    {0x20C70003, 0, 30},            // CFG-RINV-DATA_SIZE
    {0x20D00001, 0, 2},             // CFG-PM-OPERATEMODE: full, on and off, cyclic
    {0x20D0000B, 0, 1},             // CFG-PM-EXTINTSEL
};

// Per cent, CFG-TP-DUTY_…; CFG-NAVSPG has numbers of that type too.
bool is_duty(std::uint32_t key) {
    constexpr std::uint32_t time_pulse_group = 0x05;
    return (key >> 16 & 0xFF) == time_pulse_group && find_config_key(key)->type == ConfigType::r8;
}

std::int64_t as_number(const ConfigKey& key, std::uint64_t value) {
    using enum ConfigType;
    const bool is_signed = key.type == i1 || key.type == i2 || key.type == i4 || key.type == i8;
    if (!is_signed) return static_cast<std::int64_t>(value);
    const std::size_t unused_bits = 64 - 8 * config_value_size(key.id);
    return static_cast<std::int64_t>(value << unused_bits) >> unused_bits;
}

// What depends on the board; nothing for other items.
std::optional<bool> is_in_range_of_board(const BoardProfile& board, std::uint32_t key, std::uint64_t value) {
    // navRate: 1 … 127, on receivers before generation 9 up to 128 (RECEIVER.md 2.6).
    const std::uint64_t most_cycles = board.identity.generation >= 9 ? 127 : 128;
    // u-blox 6 knows NMEA 2.1 and 2.3 (ROS's ublox_msgs, CfgNMEA6) and what its board has at the factory; the model of
    // a wrist came with protocol 18.
    constexpr int newest_with_nmea_2 = 6, first_with_wrist = 8;
    constexpr std::uint64_t wrist = 9;
    // Up to protocol 18 time has four systems: GPS, GLONASS, BeiDou and Galileo (M8 interface description, UBX-CFG-RATE
    // and UBX-CFG-TP5).
    constexpr int first_with_navic_time = 9;
    constexpr std::uint64_t navic_time = 5;
    switch (key) {
        case key::rate_meas:
            return value >= static_cast<std::uint64_t>(board.least_measurement_period_ms);
        case key::rate_nav:
            return value >= 1 && value <= most_cycles;
        case key::uart1_baudrate:
        case key::uart2_baudrate:
            return takes_baud(board, value);
        case key::nmea_protver:
            if (board.identity.generation > newest_with_nmea_2) return std::nullopt;
            return value == 21 || value == 23 || value == number_of(board.nmea_version);
        case key::navspg_dynmodel:
            if (value == wrist && board.identity.generation < first_with_wrist) return false;
            return std::nullopt;
        case key::rate_timeref:
        case time_grid_1:
        case time_grid_2:
            if (value == navic_time && board.identity.generation < first_with_navic_time) return false;
            return std::nullopt;
        default:
            return std::nullopt;
    }
}

bool is_on(const ConfigValues& values, std::uint32_t key) {
    const auto found = values.find(key);
    return found != values.end() && found->second != 0;
}

bool is_measured(const ConfigValues& values, SystemSignal signal) {
    return std::ranges::any_of(signal_keys,
                               [&](const SignalKey& s) { return s.signal == signal && is_on(values, s.enable); });
}

// A system that is off may have any.
bool has_half_of_its_bands(const BoardProfile& board, const ConfigValues& values, const SystemKeys& system) {
    const auto second = second_signal(system.constellation, board.second_band);
    if (!second || !is_on(values, system.enable)) return false;
    const bool first_on = is_measured(values, {system.constellation, first_signal(system.constellation)});
    const bool second_on = is_measured(values, {system.constellation, *second});
    const auto& alone = board.first_band_alone;
    const bool does_alone = std::ranges::find(alone, system.constellation) != alone.end();
    return first_on != second_on && !(first_on && does_alone);
}

}  // namespace

bool is_on_the_wire(const BoardProfile& board, std::uint32_t key) {
    const ConfigKey* found = find_config_key(key);
    if (found == nullptr || !is_of_ublox(key)) return false;
    return board.items_of == nullptr || (found->lists & board.items_of->bit) != 0;
}

ConfigValues factory_config(const BoardProfile& board) {
    ConfigValues values = items_of_board(board);
    FactoryWriter writer(values);
    writer.set(key::uart1_baudrate, board.baud);
    writer.set(key::rate_meas, measurement_period_ms(board));
    writer.set(key::navspg_min_elev, static_cast<std::uint8_t>(std::lround(board.elevation_mask.deg())));
    writer.set(key::nmea_protver, number_of(board.nmea_version));
    writer.set(key::nmea_svnumbering, board.satellite_numbering == NmeaNumbering::extended);
    writer.set(key::nmea_main_talker, number_of_talker(board.main_talker));
    writer.set(key::itfm_enable, board.quirks.default_interference_monitor);
    writer.set(key::ant_voltage_control, board.quirks.voltage_control);
    if (board.usb) write_usb(*board.usb, writer);
    write_signals(board, writer);
    write_sentences(board, writer);
    for (const auto& [key, value] : board.config)
        writer.set(key, value);
    return values;
}

bool is_in_range(const BoardProfile& board, std::uint32_t key, std::uint64_t value) {
    const ConfigKey* item = find_config_key(key);
    if (item == nullptr) return false;
    const std::size_t bytes = config_value_size(key);
    if (bytes < 8 && value >> 8 * bytes != 0) return false;
    if (const auto by_board = is_in_range_of_board(board, key, value)) return *by_board;
    if (is_duty(key)) {
        const double percent = std::bit_cast<double>(value);
        return percent >= 0 && percent <= 100;
    }
    bool limited = false;
    for (const AllowedRange& range : allowed_ranges) {
        if (range.key != key) continue;
        const std::int64_t number = as_number(*item, value);
        if (number >= range.least && number <= range.most) return true;
        limited = true;
    }
    return !limited;
}

const ConfigValues::value_type* first_out_of_range(const BoardProfile& board, const ConfigValues& values) {
    const auto in_range = [&board](const auto& item) { return is_in_range(board, item.first, item.second); };
    const auto found = std::ranges::find_if_not(values, in_range);
    return found == values.end() ? nullptr : &*found;
}

// QZSS, SBAS and NavIC give no position by themselves: a major system is needed, as CFG-GNSS needs one.
bool is_signal_plan(const BoardProfile& board, const ConfigValues& values) {
    int major = 0;
    for (const SystemKeys& system : system_keys_of_signals) {
        if (!system.is_major || !is_on(values, system.enable)) continue;
        const auto on = [&values](std::uint32_t key) { return key != 0 && is_on(values, key); };
        // A system without a signal is not tracked. It is taken: clients change B1I for B1C key by key.
        if (std::ranges::any_of(system.first, on)) ++major;
    }
    const auto is_half = [&](const SystemKeys& system) { return has_half_of_its_bands(board, values, system); };
    if (board.bands_together && std::ranges::any_of(system_keys_of_signals, is_half)) return false;
    const auto is_whole = [&values](const std::set<std::uint32_t>& conflict) {
        return std::ranges::all_of(conflict, [&](std::uint32_t key) { return is_on(values, key); });
    };
    return major > 0 && major <= board.most_systems && std::ranges::none_of(board.signal_conflicts, is_whole);
}

bool is_consistent(const BoardProfile& board, const ConfigValues& ram) {
    if (first_out_of_range(board, ram) != nullptr) return false;
    // A supply can only be cut where it is switched (RECEIVER.md 4.4).
    if (is_on(ram, key::ant_power_down) && !is_on(ram, key::ant_voltage_control)) return false;
    return is_signal_plan(board, ram);
}

// A change of the kept layers alone shows at the next start, which must have a system as well.
bool spoils_start(const BoardProfile& board, const ConfigStore& before, const ConfigStore& after) {
    return !is_consistent(board, after.values_at_start()) && is_consistent(board, before.values_at_start());
}

}  // namespace skyloop::firmware
