/// Boards and payloads for tests of the configuration.
#pragma once

#include <filesystem>
#include <initializer_list>
#include <string>
#include <utility>
#include <vector>

#include "firmware/ublox/config/config_handler.hpp"
#include "receiver/protocol/ubx_cfg.hpp"

namespace skyloop::firmware {

/// Items that several tests set.
inline constexpr std::uint32_t period_item = key::rate_meas, cycles_item = key::rate_nav,
                               reference_item = key::rate_timeref, pvt_item = 0x20910007, gps_item = 0x1031001F,
                               galileo_item = 0x10310021, beidou_item = 0x10310022, glonass_item = 0x10310025;

/// A receiver of generation 9 with everything that the list of items has.
inline BoardProfile whole_board() {
    BoardProfile board;
    board.name = "test";
    board.maker = MakerKind::ublox;
    board.identity.generation = 9;
    board.baud = 38400;
    board.bauds = {9600, 38400, 115200};
    board.ports = {PortId::i2c, PortId::uart1, PortId::uart2, PortId::usb, PortId::spi};
    board.constellations = {Constellation::gps, Constellation::galileo, Constellation::sbas};
    board.sentences = {{NmeaSentence::gga, 1}, {NmeaSentence::gsv, 5}};
    return board;
}

using KeyValues = std::vector<std::pair<std::uint32_t, std::uint64_t>>;

inline Bytes valset_payload(std::uint8_t layers, const KeyValues& pairs, std::uint8_t version = 0,
                            std::uint8_t transaction = 0) {
    CfgValset message{.version = version, .layers = layers, .transaction = transaction, .reserved = 0, .pairs = {}};
    for (const auto& [key, value] : pairs)
        message.pairs.push_back({key, value});
    return encode_payload(message);
}

inline Bytes valget_payload(std::uint8_t layer, std::vector<std::uint32_t> keys, std::uint16_t position = 0) {
    return encode_payload(CfgValgetPoll{.version = 0, .layer = layer, .position = position, .keys = std::move(keys)});
}

inline Bytes valdel_payload(std::uint8_t layers, std::vector<std::uint32_t> keys, std::uint8_t version = 0,
                            std::uint8_t transaction = 0) {
    return encode_payload(CfgValdel{
        .version = version, .layers = layers, .transaction = transaction, .reserved = 0, .keys = std::move(keys)});
}

}  // namespace skyloop::firmware
