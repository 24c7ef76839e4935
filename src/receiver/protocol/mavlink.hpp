/// MAVLink: frames of version 1 and 2 and the messages between a GNSS receiver and an autopilot.
///
/// Frames, truncation and checksums: the MAVLink developer guide, "Packet Serialization"; messages: its common.xml,
/// with the fields in the order of the wire (by descending size, extensions behind).
///
/// What flight modes are called that HEARTBEAT tells as numbers.
///
/// Names and numbers: ArduPilot by COPTER_MODE, PLANE_MODE and ROVER_MODE of MAVLink's ardupilotmega.xml, named as its
/// ground stations do (FBWA, not FLY_BY_WIRE_A); PX4 by the main modes and the submodes of AUTO in its
/// src/modules/commander/px4_custom_mode.h. Kinds of vehicles: MAV_TYPE of minimal.xml.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "receiver/protocol/field_list.hpp"

namespace skyloop::inline receiver {

/// Who sends a frame, and which of its frames it is.
struct MavlinkSource {
    std::uint8_t system = 1;
    std::uint8_t component = 220;  ///< 220: MAV_COMP_ID_GPS
    std::uint8_t sequence = 0;     ///< one more with every frame, modulo 256
    bool operator==(const MavlinkSource&) const = default;
};

/// One checked frame; the payload lives as long as the bytes that were parsed and may be cut short of its zeros.
struct MavlinkFrameView {
    int version = 2;
    MavlinkSource source;
    std::uint32_t message = 0;
    bool is_signed = false;  ///< a signature follows, which nobody has checked
    ByteSpan payload;
};

inline constexpr std::uint8_t mavlink_v1_start = 0xFE, mavlink_v2_start = 0xFD;
inline constexpr std::size_t mavlink_v1_head_size = 6, mavlink_v2_head_size = 10;
inline constexpr std::size_t mavlink_crc_size = 2, mavlink_signature_size = 13;

/// CRC-16/MCRF4XX, which MAVLink calls X.25: polynomial 0x1021 reflected, start 0xFFFF. `crc` goes on with an earlier
/// result.
std::uint16_t crc16_x25(ByteSpan bytes, std::uint16_t crc = 0xFFFF);

/// The byte that a message's definition adds to its checksum. Nothing for messages that are not known here: their
/// frames cannot be told from noise.
std::optional<std::uint8_t> mavlink_crc_extra(std::uint32_t message);

/// A version 2 frame without signature; zeros at the payload's end are left out, but for its first byte. Empty when the
/// message is not known or the payload exceeds 255 bytes.
Bytes encode_mavlink_v2(MavlinkSource source, std::uint32_t message, ByteSpan payload);
/// A version 1 frame. Empty as above, and for messages above 255.
Bytes encode_mavlink_v1(MavlinkSource source, std::uint32_t message, ByteSpan payload);

/// Bytes of the frame that begins here, by its head: nothing when none does or the head is not whole.
std::optional<std::size_t> mavlink_frame_size(ByteSpan bytes);
/// The message that the head names: nothing when the head is not whole.
std::optional<std::uint32_t> mavlink_message_id(ByteSpan bytes);
/// Reads exactly one frame; nothing when the checksum does not hold, the message is not known or flags that must be
/// understood are not.
std::optional<MavlinkFrameView> parse_mavlink(ByteSpan bytes);

/// The frames of one datagram, in their order. What is no frame is passed over; so are frames of unknown messages, with
/// wrong checksums or flags, by the length in their head. The views live as long as the bytes.
std::vector<MavlinkFrameView> mavlink_frames(ByteSpan datagram);

/// HEARTBEAT: a component is alive.
struct MavlinkHeartbeat {
    static constexpr std::uint32_t message_id = 0;
    static constexpr std::uint8_t crc_extra = 50;
    static constexpr std::size_t base_size = 9;
    static constexpr std::string_view message_name = "HEARTBEAT";
    static constexpr std::string_view field_names =
        "custom_mode type autopilot base_mode system_status mavlink_version";
    std::uint32_t custom_mode = 0;
    std::uint8_t type = 41;      ///< 41: MAV_TYPE_GPS
    std::uint8_t autopilot = 8;  ///< 8: none
    std::uint8_t base_mode = 0;
    std::uint8_t system_status = 4;  ///< 4: active
    std::uint8_t mavlink_version = 3;
};

/// COMMAND_LONG: asks a component to do something; what the parameters mean depends on the command (MAV_CMD).
struct MavlinkCommandLong {
    static constexpr std::uint32_t message_id = 76;
    static constexpr std::uint8_t crc_extra = 152;
    static constexpr std::size_t base_size = 33;
    static constexpr std::string_view message_name = "COMMAND_LONG";
    static constexpr std::string_view field_names =
        "param1 param2 param3 param4 param5 param6 param7 command target_system target_component confirmation";
    float param1 = 0, param2 = 0, param3 = 0, param4 = 0, param5 = 0, param6 = 0, param7 = 0;
    std::uint16_t command = 0;
    std::uint8_t target_system = 0;     ///< 0: all
    std::uint8_t target_component = 0;  ///< 0: all
    std::uint8_t confirmation = 0;      ///< how often it has been sent before
};

/// COMMAND_INT: as COMMAND_LONG, with a place in whole numbers.
struct MavlinkCommandInt {
    static constexpr std::uint32_t message_id = 75;
    static constexpr std::uint8_t crc_extra = 158;
    static constexpr std::size_t base_size = 35;
    static constexpr std::string_view message_name = "COMMAND_INT";
    static constexpr std::string_view field_names =
        "param1 param2 param3 param4 x y z command target_system target_component frame current autocontinue";
    float param1 = 0, param2 = 0, param3 = 0, param4 = 0;
    std::int32_t x = 0;  ///< 1e-7 deg of latitude or 1e-4 m, by `frame`
    std::int32_t y = 0;  ///< … of longitude
    float z = 0;         ///< m
    std::uint16_t command = 0;
    std::uint8_t target_system = 0;     ///< 0: all
    std::uint8_t target_component = 0;  ///< 0: all
    std::uint8_t frame = 0;
    std::uint8_t current = 0;
    std::uint8_t autocontinue = 0;
};

/// COMMAND_ACK: what becomes of a command.
struct MavlinkCommandAck {
    static constexpr std::uint32_t message_id = 77;
    static constexpr std::uint8_t crc_extra = 143;
    static constexpr std::size_t base_size = 3;
    static constexpr std::string_view message_name = "COMMAND_ACK";
    static constexpr std::string_view field_names =
        "command result progress result_param2 target_system target_component";
    std::uint16_t command = 0;
    std::uint8_t result = 0;         ///< MavlinkResult
    std::uint8_t progress = 0;       ///< %; this and what follows are extensions
    std::int32_t result_param2 = 0;  ///< depends on the command
    std::uint8_t target_system = 0;  ///< of who has asked
    std::uint8_t target_component = 0;
};

/// MAV_RESULT of common.xml, as far as it is used here.
enum class MavlinkResult : std::uint8_t { accepted = 0, temporarily_rejected = 1, denied = 2, unsupported = 3 };

/// GPS_INPUT: a receiver's solution for an autopilot.
struct MavlinkGpsInput {
    static constexpr std::uint32_t message_id = 232;
    static constexpr std::uint8_t crc_extra = 151;
    static constexpr std::size_t base_size = 63;
    static constexpr std::string_view message_name = "GPS_INPUT";
    static constexpr std::string_view field_names =
        "unix_time_s*1e-6 tow_s*1e-3 lat_deg*1e-7 lon_deg*1e-7 msl_m hdop!65535 vdop!65535 vel_north_mps vel_east_mps "
        "vel_down_mps speed_acc_mps h_acc_m v_acc_m ignore_flags gps_week gps_id fix_type satellites yaw_deg*1e-2!0";
    std::uint64_t time_usec = 0;     ///< us since 1970, as POSIX counts
    std::uint32_t time_week_ms = 0;  ///< ms, GPS time of week
    std::int32_t lat = 0;            ///< 1e-7 deg
    std::int32_t lon = 0;            ///< 1e-7 deg
    float alt = 0;                   ///< m above mean sea level
    float hdop = 65535;              ///< 65535 unknown
    float vdop = 65535;
    float vn = 0;                    ///< m/s
    float ve = 0;                    ///< m/s
    float vd = 0;                    ///< m/s
    float speed_accuracy = 0;        ///< m/s
    float horiz_accuracy = 0;        ///< m
    float vert_accuracy = 0;         ///< m
    std::uint16_t ignore_flags = 0;  ///< bits: 0 alt, 1 hdop, 2 vdop, 3 vn ve, 4 vd, 5 to 7 the accuracies
    std::uint16_t time_week = 0;     ///< GPS week, not wrapped; 0 unknown
    std::uint8_t gps_id = 0;
    std::uint8_t fix_type = 0;  ///< 0 no receiver, 1 none, 2 2D, 3 3D, 4 differential, 5 RTK float, 6 RTK fixed
    std::uint8_t satellites_visible = 0;
    std::uint16_t yaw = 0;  ///< 0.01 deg, 36000 for north; 0 unknown; an extension
};

/// GPS_RAW_INT: what an autopilot's receiver reports to the ground.
struct MavlinkGpsRawInt {
    static constexpr std::uint32_t message_id = 24;
    static constexpr std::uint8_t crc_extra = 24;
    static constexpr std::size_t base_size = 30;
    static constexpr std::string_view message_name = "GPS_RAW_INT";
    static constexpr std::string_view field_names =
        "time_s*1e-6 lat_deg*1e-7 lon_deg*1e-7 msl_m*1e-3 hdop*1e-2!65535 vdop*1e-2!65535 speed_mps*1e-2!65535 "
        "course_deg*1e-2!65535 fix_type satellites!255 height_m*1e-3 h_acc_m*1e-3 v_acc_m*1e-3 speed_acc_mps*1e-3 "
        "course_acc_deg*1e-5 yaw_deg*1e-2!0";
    std::uint64_t time_usec = 0;  ///< us, of 1970 or of the start
    std::int32_t lat = 0;         ///< 1e-7 deg
    std::int32_t lon = 0;         ///< 1e-7 deg
    std::int32_t alt = 0;         ///< mm above mean sea level
    std::uint16_t eph = 0xFFFF;   ///< HDOP, 0.01
    std::uint16_t epv = 0xFFFF;   ///< VDOP, 0.01
    std::uint16_t vel = 0xFFFF;   ///< cm/s
    std::uint16_t cog = 0xFFFF;   ///< 0.01 deg
    std::uint8_t fix_type = 0;    ///< as MavlinkGpsInput::fix_type
    std::uint8_t satellites_visible = 0xFF;
    std::int32_t alt_ellipsoid = 0;  ///< mm; this and what follows are extensions
    std::uint32_t h_acc = 0;         ///< mm
    std::uint32_t v_acc = 0;         ///< mm
    std::uint32_t vel_acc = 0;       ///< mm/s
    std::uint32_t hdg_acc = 0;       ///< 1e-5 deg
    std::uint16_t yaw = 0;           ///< 0.01 deg, 36000 for north; 0 unknown
};

/// GPS_RTCM_DATA: a piece of an RTCM stream on its way to a receiver.
struct MavlinkGpsRtcmData {
    static constexpr std::uint32_t message_id = 233;
    static constexpr std::uint8_t crc_extra = 35;
    static constexpr std::size_t base_size = 182;
    static constexpr std::string_view message_name = "GPS_RTCM_DATA";
    static constexpr std::string_view field_names = "flags length data";
    std::uint8_t flags = 0;  ///< bits: 0 a fragment, 1-2 which, 3-7 of which message
    std::uint8_t length = 0;
    std::array<std::uint8_t, 180> data{};
};

/// The version 2 frame of a message.
template <class Message>
Bytes encode_mavlink(MavlinkSource source, const Message& message) {
    return encode_mavlink_v2(source, Message::message_id, encode_payload(message));
}

/// The message of a payload that may be cut short of its zeros or, from an older sender, of its extensions; bytes that
/// a later one has added are ignored.
template <class Message>
Message decode_mavlink(ByteSpan payload) {
    Bytes whole(payload.begin(), payload.end());
    whole.resize(std::max(whole.size(), wire_size(Message{})));
    return *decode_front<Message>(whole);
}

inline constexpr std::uint8_t mavlink_autopilot_ardupilot = 3, mavlink_autopilot_none = 8, mavlink_autopilot_px4 = 12;
/// Bits of HEARTBEAT's base_mode: custom_mode holds, motors may turn.
inline constexpr std::uint8_t mavlink_custom_mode_enabled = 1, mavlink_safety_armed = 128;

/// "AUTO", "RTL", of PX4 "POSCTL" or with its submode "AUTO.MISSION"; empty when the mode, the autopilot or the kind of
/// vehicle is not known here, or custom_mode does not hold.
std::string mavlink_mode_name(const MavlinkHeartbeat& heartbeat);

/// True when `name` is the mode `mode` or the one that has it as a submode: "AUTO.MISSION" is "AUTO", too. Letters may
/// be of either case.
bool is_mavlink_mode(std::string_view mode, std::string_view name);

/// All names that mavlink_mode_name() can give, ascending, without repetition.
const std::vector<std::string>& mavlink_mode_names();

}  // namespace skyloop::inline receiver
