/// MultiWii Serial Protocol: frames of version 1 and 2 and the two messages by which a receiver feeds an autopilot.
///
/// Frames: the INAV project's page "MSP V2" (native version 2, version 1); messages: RECEIVER.md 7, rank 1.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include "receiver/protocol/field_list.hpp"

namespace skyloop::inline receiver {

/// One checked frame; the payload lives as long as the bytes that were parsed.
struct MspFrameView {
    int version = 2;       ///< 1 ("$M") or 2 ("$X")
    char direction = '<';  ///< '<' to the autopilot, '>' from it, '!' a refusal
    std::uint16_t function = 0;
    ByteSpan payload;
};

/// Bytes of a version 1 frame before its payload, and of a version 2 frame; one byte of checksum follows it.
inline constexpr std::size_t msp_v1_head_size = 5, msp_v2_head_size = 8;
/// The longest payload of version 1: a length of 255 announces a longer form, which is not read here.
inline constexpr std::size_t msp_v1_largest_payload = 254;

/// CRC-8/DVB-S2: polynomial 0xD5, start 0 (ETSI EN 302 307-1, 5.1.6).
std::uint8_t crc8_dvb_s2(ByteSpan bytes);

/// A version 1 frame "$M<", its checksum the exclusive or from the length on. Empty when function or payload do not
/// fit into their byte.
Bytes encode_msp_v1(std::uint16_t function, ByteSpan payload);
/// A version 2 frame "$X<" without flags. Empty for a payload of more than 65535 bytes.
Bytes encode_msp_v2(std::uint16_t function, ByteSpan payload);

/// Bytes of the frame of either version that begins here, by its length field: nothing when none does or the length is
/// not there yet.
std::optional<std::size_t> msp_frame_size(ByteSpan bytes);
/// Reads exactly one frame; nothing when start, length or checksum do not hold.
std::optional<MspFrameView> parse_msp(ByteSpan bytes);

/// MSP2_SENSOR_GPS: a receiver's solution, 52 bytes in a version 2 frame.
struct MspSensorGps {
    static constexpr std::uint16_t function = 0x1F03;
    static constexpr std::string_view message_name = "MSP2_SENSOR_GPS";
    U1<"instance"> instance{};
    U2<"gps_week!65535"> gps_week = 0xFFFF;  ///< not wrapped; 65535 unknown
    U4<"tow_s*1e-3"> ms_tow{};
    U1<"fix_type">
        fix_type{};  ///< 0 no receiver or no fix, 1 none, 2 2D, 3 3D, 4 differential, 5 RTK float, 6 RTK fixed
    U1<"satellites"> satellites{};  ///< used
    U2<"h_acc_m*1e-2!65535"> h_acc = 0xFFFF;
    U2<"v_acc_m*1e-2!65535"> v_acc = 0xFFFF;
    U2<"speed_acc_mps*1e-2!65535"> speed_acc = 0xFFFF;
    U2<"dop*1e-2"> dop = 9999;  ///< ArduPilot takes it for HDOP
    I4<"lon_deg*1e-7"> longitude{};
    I4<"lat_deg*1e-7"> latitude{};
    I4<"msl_m*1e-2"> msl_altitude{};
    I4<"vel_north_mps*1e-2"> vel_north{};
    I4<"vel_east_mps*1e-2"> vel_east{};
    I4<"vel_down_mps*1e-2"> vel_down{};
    U2<"course_deg*1e-2"> course{};
    U2<"yaw_deg*1e-2!65535"> true_yaw = 0xFFFF;  ///< 65535 none
    U2<"year"> year{};                           ///< UTC
    U1<"month"> month{};
    U1<"day"> day{};
    U1<"hour"> hour{};
    U1<"minute"> minute{};
    U1<"second"> second{};
};

/// MSP_SET_RAW_GPS: the older, short form, 14 bytes in a version 1 frame.
struct MspSetRawGps {
    static constexpr std::uint16_t function = 201;
    static constexpr std::string_view message_name = "MSP_SET_RAW_GPS";
    U1<"fix"> fix{};  ///< 0 none, 1 there is one
    U1<"satellites"> satellites{};
    I4<"lat_deg*1e-7"> latitude{};
    I4<"lon_deg*1e-7"> longitude{};
    U2<"altitude_m"> altitude{};  ///< above mean sea level, none below it
    U2<"speed_mps*1e-2"> speed{};
};

/// The frames of the two messages.
inline Bytes encode_msp(const MspSensorGps& m) { return encode_msp_v2(MspSensorGps::function, encode_payload(m)); }
inline Bytes encode_msp(const MspSetRawGps& m) { return encode_msp_v1(MspSetRawGps::function, encode_payload(m)); }

}  // namespace skyloop::inline receiver
