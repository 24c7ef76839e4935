/// Epochs and boards that the tests of the receiver share.
#pragma once

#include <string>

#include "base/time/utc_time.hpp"
#include "firmware/core/board_profile.hpp"
#include "world/flow/epoch.hpp"

namespace skyloop::firmware {

inline Fix sample_fix(const char* utc, double latitude, double longitude, double height_m) {
    Fix fix;
    fix.time = to_gps_time(*parse_utc(utc), LeapSeconds::announced());
    fix.leap_seconds = LeapSeconds::announced().offset(fix.time);
    fix.type = FixType::fix_3d;
    fix.position = Geodetic::degrees(latitude, longitude, height_m);
    fix.geoid_undulation = Metres(21.37);
    fix.speed = MetresPerSecond(12.5);
    fix.course = Angle::degrees(77.777);
    fix.dop = {2.41, 2.02, 1.1, 1.69, 1.31, 0.66, 0.88};
    fix.horizontal_accuracy = Metres(3.3);
    fix.vertical_accuracy = Metres(5.04);
    return fix;
}

/// `count` satellites from `first` on, spread over the sky; every fourth is not tracked, the others are used.
inline void add_satellites(Fix& fix, Constellation constellation, int first, int count) {
    for (int i = 0; i < count; ++i) {
        const bool tracked = i % 4 != 3;
        SatelliteStatus s{{constellation, first + i},
                          Angle::degrees(37.0 * i + 11.4),
                          Angle::degrees(8.0 + 17.3 * (i % 5)),
                          std::nullopt,
                          tracked};
        if (tracked) s.cn0 = DbHz(31.0 + 2.25 * (i % 7));
        fix.satellites.push_back(s);
    }
}

inline BoardProfile sample_board(NmeaVersion version, std::vector<Constellation> constellations) {
    BoardProfile board;
    board.name = "sample";
    board.constellations = std::move(constellations);
    board.nmea_version = version;
    using enum NmeaSentence;
    for (const NmeaSentence sentence : {rmc, vtg, gga, gsa, gsv, gll, gst, zda})
        board.sentences.push_back({sentence, 1});
    return board;
}

/// A u-blox of generation 9 with two UARTs and USB, all in its factory state but for silence on NMEA.
inline BoardProfile sample_ublox() {
    BoardProfile board = sample_board(NmeaVersion::v4_10, {Constellation::gps, Constellation::galileo});
    board.maker = MakerKind::ublox;
    board.identity = {9, "EXT CORE 4.04 (7f89f7)", "00190000", {"FWVER=SPG 4.04", "PROTVER=32.01"}, Bytes(5), {}, {}};
    board.identity.banner = {"HELLO", "FWVER=SPG 4.04"};
    board.baud = 38400;
    board.max_rate_hz = 25;
    board.ports = {PortId::i2c, PortId::uart1, PortId::uart2, PortId::usb};
    board.sentences.clear();
    board.messages = {{0x01, 0x07}, {0x01, 0x03}, {0xF0, 0x04}, {0xF0, 0x00}, {0x01, 0x04}, {0x01, 0x61}, {0x0A, 0x36}};
    board.polled = {{0x0A, 0x04}, {0x27, 0x03}};
    for (const std::uint8_t id : std::initializer_list<std::uint8_t>{0x00, 0x01, 0x02, 0x08, 0x09, 0x24, 0x3E})
        board.legacy[{0x06, id}] = LegacyAnswer::apply;
    return board;
}

}  // namespace skyloop::firmware
