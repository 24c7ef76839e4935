/// Boards with what legacy configuration messages need, and a receiver's configuration to send them to.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "firmware/ublox/config/config_handler.hpp"

namespace skyloop::firmware {

/// Bytes from hexadecimal digits; spaces do not count.
inline Bytes hex(std::string_view text) {
    Bytes bytes;
    int digits = 0;
    unsigned value = 0;
    for (const char c : text) {
        if (c == ' ') continue;
        value = value << 4 | static_cast<unsigned>(c <= '9' ? c - '0' : (c | 0x20) - 'a' + 10);
        if (++digits % 2 == 0) bytes.push_back(static_cast<std::uint8_t>(value & 0xFF));
    }
    return bytes;
}

inline constexpr UbxMessageId cfg(int id) { return {0x06, static_cast<std::uint8_t>(id)}; }
inline constexpr UbxMessageId nav(int id) { return {0x01, static_cast<std::uint8_t>(id)}; }

/// What the three boards have in common: every legacy message, speeds, ports, the messages that clients name.
inline BoardProfile legacy_board() {
    BoardProfile board;
    for (const int id : {0x00, 0x01, 0x02, 0x08, 0x09, 0x11, 0x13, 0x16, 0x17, 0x1B, 0x1E,
                         0x23, 0x24, 0x31, 0x39, 0x3E, 0x47, 0x69, 0x86, 0x06, 0x34, 0x3B})
        board.legacy[cfg(id)] = LegacyAnswer::apply;
    board.bauds = {4800, 9600, 19200, 38400, 57600, 115200, 230400, 460800, 921600};
    board.ports = {PortId::i2c, PortId::uart1, PortId::uart2, PortId::usb, PortId::spi};
    for (const int id : {0x01, 0x02, 0x03, 0x04, 0x07, 0x11, 0x12, 0x20, 0x21, 0x22, 0x26, 0x35, 0x61})
        board.messages.push_back(nav(id));
    for (std::uint8_t id = 0; id < 6; ++id)
        board.messages.push_back({0xF0, id});
    board.messages.push_back({0x0A, 0x09});
    board.polled = {{0x0A, 0x04}};
    board.sentences = {{NmeaSentence::rmc}, {NmeaSentence::vtg}, {NmeaSentence::gga},
                       {NmeaSentence::gsa}, {NmeaSentence::gsv}, {NmeaSentence::gll}};
    return board;
}

/// A list of items by its firmware.
inline const FirmwareList* items_of(std::string_view firmware) {
    return &*std::ranges::find(firmware_lists(), firmware, &FirmwareList::name);
}

/// u-blox M8, SPG 3.01 (RECEIVER.md 2).
inline BoardProfile legacy_m8() {
    BoardProfile board = legacy_board();
    board.identity.generation = 8;
    board.identity.software = "EXT CORE 3.01 (107900)";
    board.identity.extensions = {"FWVER=SPG 3.01", "PROTVER=18.00"};
    board.quirks.value_config = ValueConfigSupport::refuse;
    board.constellations = {Constellation::gps, Constellation::sbas, Constellation::qzss, Constellation::glonass};
    board.most_systems = 3;
    board.least_measurement_period_ms = 50;
    board.messages.insert(board.messages.end(), {nav(0x06), nav(0x30)});
    board.gnss_channels_hardware = board.gnss_channels_used = 32;
    board.gnss_blocks = {{0, 8, 16, 0x01010001}, {1, 1, 3, 0x01010001}, {2, 4, 8, 0x01010000}, {3, 8, 16, 0x01010000},
                         {4, 0, 8, 0x03010000},  {5, 0, 3, 0x05010001}, {6, 8, 14, 0x01010001}};
    board.config = {
        {key::navspg_wknrollover, 1867}, {0x10230001, 0}, {0x50360006, 0x851}, {0x40050026, 4}, {0x4005000F, 125000}};
    for (const PortId port : board.ports) {
        for (const std::uint32_t protocol : {4U, 5U})  // RTCM 3, SPARTN
            board.absent_keys.insert(key::in_protocol(port, protocol));
        board.absent_keys.insert(key::out_protocol(port, 4));
    }
    return board;
}

/// NEO-M9N, SPG 4.04.
inline BoardProfile legacy_m9() {
    BoardProfile board = legacy_board();
    board.identity.generation = 9;
    board.identity.software = "EXT CORE 4.04 (7f89f7)";
    board.identity.extensions = {"FWVER=SPG 4.04", "PROTVER=32.01"};
    board.baud = 38400;
    board.nmea_version = NmeaVersion::v4_10;
    board.constellations = {Constellation::gps,    Constellation::sbas, Constellation::galileo,
                            Constellation::beidou, Constellation::qzss, Constellation::glonass};
    board.gnss_channels_hardware = board.gnss_channels_used = 42;
    board.gnss_blocks = {{0, 8, 16, 0x01010001}, {1, 3, 3, 0x01010001}, {2, 8, 12, 0x01010001},
                         {3, 2, 5, 0x01010001},  {5, 3, 4, 0x01050001}, {6, 8, 12, 0x01010001}};
    board.items_of = items_of("SPG 4.04");
    return board;
}

/// ZED-F9P, HPG 1.32.
inline BoardProfile legacy_f9p() {
    BoardProfile board = legacy_m9();
    board.identity.software = "EXT CORE 1.00 (0fa0ae)";
    board.identity.extensions = {"FWVER=HPG 1.32", "PROTVER=27.31", "MOD=ZED-F9P"};
    board.dual_frequency = true;
    board.legacy[cfg(0x70)] = board.legacy[cfg(0x71)] = LegacyAnswer::apply;
    board.gnss_channels_hardware = 0;
    board.gnss_channels_used = 60;
    board.gnss_blocks = {{0, 8, 16, 0x01110001}, {1, 3, 3, 0x01010001}, {2, 10, 18, 0x01210001},
                         {3, 2, 5, 0x01110001},  {5, 0, 4, 0x01110001}, {6, 8, 12, 0x01110001}};
    board.config = {{key::navspg_wknrollover, 0x832}};
    board.items_of = items_of("HPG 1.32");
    return board;
}

/// One receiver's configuration.
struct LegacyBench {
    explicit LegacyBench(BoardProfile profile) : board(std::move(profile)) {}
    BoardProfile board;
    ConfigStore store{factory_config(board)};
    LegacyConfig config{board, store};
    ValueConfig values{board, store};

    ConfigOutcome send(UbxMessageId id, const Bytes& payload, PortId from = PortId::uart1) {
        return config.handle(id, payload, from);
    }
    Verdict set(UbxMessageId id, const Bytes& payload, PortId from = PortId::uart1) {
        const ConfigOutcome outcome = send(id, payload, from);
        return outcome.answers.empty() ? outcome.verdict : Verdict::silence;
    }
    /// The payload of the one answer to an acknowledged poll; empty when there was none.
    Bytes poll(UbxMessageId id, const Bytes& selector = {}, PortId from = PortId::uart1) {
        const ConfigOutcome outcome = send(id, selector, from);
        if (outcome.verdict != Verdict::acknowledge || outcome.answers.size() != 1) return {};
        const auto frame = parse_frame(outcome.answers.front());
        if (!frame || frame->id != id) return {};
        return {frame->payload.begin(), frame->payload.end()};
    }
    /// By CFG-VALSET into RAM; the bytes of key and value.
    Verdict valset(std::string_view pairs) { return values.valset(hex("00 01 00 00 " + std::string(pairs))).verdict; }
};

}  // namespace skyloop::firmware
