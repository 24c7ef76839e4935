/// UBX messages of base stations: NAV-RELPOSNED and NAV-SVIN.
///
/// Numbers are as on the wire; a member's comment gives unit and scale. Each message names where its layout stands: a
/// section of RECEIVER.md, or the message of that name in the M8 (UBX-13003221), F9 (HPG 1.32, UBX-22008968) or M10
/// (SPG 5.10) interface description.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "receiver/protocol/ubx_fields.hpp"

namespace skyloop {

/// NAV-RELPOSNED version 0: from base to rover, 40 bytes (M8P; RECEIVER.md 3.1).
struct NavRelposned0 {
    static constexpr UbxMessageId message_id{0x01, 0x3C};
    std::uint8_t version = 0;  ///< 0
    std::uint8_t reserved1 = 0;
    std::uint16_t ref_station_id = 0;         ///< 0 to 4095
    std::uint32_t i_tow = 0;                  ///< ms, GPS time of week of the epoch
    std::array<std::int32_t, 3> rel_pos{};    ///< cm north, east, down
    std::array<std::int8_t, 3> rel_pos_hp{};  ///< 0.1 mm, to add
    std::uint8_t reserved2 = 0;
    std::array<std::uint32_t, 3> acc{};  ///< 0.1 mm north, east, down
    std::uint32_t flags =
        0;  ///< bits: 0 fix ok, 1 differential, 2 vector valid, 3-4 carrier solution, 5 moving base, 6-7 base missed
};

/// NAV-RELPOSNED version 1: from base to rover, 64 bytes (F9; RECEIVER.md 3.1).
struct NavRelposned {
    static constexpr UbxMessageId message_id{0x01, 0x3C};
    std::uint8_t version = 1;  ///< 1
    std::uint8_t reserved0 = 0;
    std::uint16_t ref_station_id = 0;       ///< 0 to 4095
    std::uint32_t i_tow = 0;                ///< ms, GPS time of week of the epoch
    std::array<std::int32_t, 3> rel_pos{};  ///< cm north, east, down
    std::int32_t rel_pos_length = 0;        ///< cm
    std::int32_t rel_pos_heading = 0;       ///< 1e-5 deg
    std::array<std::uint8_t, 4> reserved1{};
    std::array<std::int8_t, 3> rel_pos_hp{};  ///< 0.1 mm, to add
    std::int8_t rel_pos_length_hp = 0;        ///< 0.1 mm, to add
    std::array<std::uint32_t, 3> acc{};       ///< 0.1 mm north, east, down
    std::uint32_t acc_length = 0;             ///< 0.1 mm
    std::uint32_t acc_heading = 0;            ///< 1e-5 deg
    std::array<std::uint8_t, 4> reserved2{};
    std::uint32_t flags = 0;  ///< bits: 0 fix ok, 1 differential, 2 vector valid, 3-4 carrier solution, 5 moving base,
                              ///< 6-7 base missed, 8 heading
};

/// NAV-SVIN: survey of the base's place (RECEIVER.md 3.1).
struct NavSvin {
    static constexpr UbxMessageId message_id{0x01, 0x3B};
    std::uint8_t version = 0;  ///< 0
    std::array<std::uint8_t, 3> reserved1{};
    std::uint32_t i_tow = 0;               ///< ms, GPS time of week of the epoch
    std::uint32_t dur = 0;                 ///< s
    std::array<std::int32_t, 3> mean{};    ///< cm, Earth-fixed
    std::array<std::int8_t, 3> mean_hp{};  ///< 0.1 mm, to add
    std::uint8_t reserved2 = 0;
    std::uint32_t mean_acc = 0;  ///< 0.1 mm
    std::uint32_t obs = 0;       ///< positions used
    std::uint8_t valid = 0;
    std::uint8_t active = 0;
    std::array<std::uint8_t, 2> reserved3{};
};

}  // namespace skyloop
