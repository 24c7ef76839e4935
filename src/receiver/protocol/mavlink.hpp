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
    U4<"custom_mode"> custom_mode{};
    U1<"type"> type = 41;           ///< 41: MAV_TYPE_GPS
    U1<"autopilot"> autopilot = 8;  ///< 8: none
    U1<"base_mode"> base_mode{};
    U1<"system_status"> system_status = 4;  ///< 4: active
    U1<"mavlink_version"> mavlink_version = 3;
};

/// COMMAND_LONG: asks a component to do something; what the parameters mean depends on the command (MAV_CMD).
struct MavlinkCommandLong {
    static constexpr std::uint32_t message_id = 76;
    static constexpr std::uint8_t crc_extra = 152;
    static constexpr std::size_t base_size = 33;
    static constexpr std::string_view message_name = "COMMAND_LONG";
    R4<"param1"> param1{};
    R4<"param2"> param2{};
    R4<"param3"> param3{};
    R4<"param4"> param4{};
    R4<"param5"> param5{};
    R4<"param6"> param6{};
    R4<"param7"> param7{};
    U2<"command"> command{};
    U1<"target_system"> target_system{};        ///< 0: all
    U1<"target_component"> target_component{};  ///< 0: all
    U1<"confirmation"> confirmation{};          ///< how often it has been sent before
};

/// COMMAND_INT: as COMMAND_LONG, with a place in whole numbers.
struct MavlinkCommandInt {
    static constexpr std::uint32_t message_id = 75;
    static constexpr std::uint8_t crc_extra = 158;
    static constexpr std::size_t base_size = 35;
    static constexpr std::string_view message_name = "COMMAND_INT";
    R4<"param1"> param1{};
    R4<"param2"> param2{};
    R4<"param3"> param3{};
    R4<"param4"> param4{};
    I4<"x"> x{};  ///< 1e-7 deg of latitude or 1e-4 m, by `frame`
    I4<"y"> y{};  ///< … of longitude
    R4<"z"> z{};  ///< m
    U2<"command"> command{};
    U1<"target_system"> target_system{};        ///< 0: all
    U1<"target_component"> target_component{};  ///< 0: all
    U1<"frame"> frame{};
    U1<"current"> current{};
    U1<"autocontinue"> autocontinue{};
};

/// COMMAND_ACK: what becomes of a command.
struct MavlinkCommandAck {
    static constexpr std::uint32_t message_id = 77;
    static constexpr std::uint8_t crc_extra = 143;
    static constexpr std::size_t base_size = 3;
    static constexpr std::string_view message_name = "COMMAND_ACK";
    U2<"command"> command{};
    U1<"result"> result{};                ///< MavlinkResult
    U1<"progress"> progress{};            ///< %; this and what follows are extensions
    I4<"result_param2"> result_param2{};  ///< depends on the command
    U1<"target_system"> target_system{};  ///< of who has asked
    U1<"target_component"> target_component{};
};

/// MAV_RESULT of common.xml, as far as it is used here.
enum class MavlinkResult : std::uint8_t { accepted = 0, temporarily_rejected = 1, denied = 2, unsupported = 3 };

/// GPS_INPUT: a receiver's solution for an autopilot.
struct MavlinkGpsInput {
    static constexpr std::uint32_t message_id = 232;
    static constexpr std::uint8_t crc_extra = 151;
    static constexpr std::size_t base_size = 63;
    static constexpr std::string_view message_name = "GPS_INPUT";
    U8<"unix_time_s*1e-6"> time_usec{};  ///< since 1970, as POSIX counts
    U4<"tow_s*1e-3"> time_week_ms{};     ///< GPS time of week
    I4<"lat_deg*1e-7"> lat{};
    I4<"lon_deg*1e-7"> lon{};
    R4<"msl_m"> alt{};              ///< above mean sea level
    R4<"hdop!65535"> hdop = 65535;  ///< 65535 unknown
    R4<"vdop!65535"> vdop = 65535;
    R4<"vel_north_mps"> vn{};
    R4<"vel_east_mps"> ve{};
    R4<"vel_down_mps"> vd{};
    R4<"speed_acc_mps"> speed_accuracy{};
    R4<"h_acc_m"> horiz_accuracy{};
    R4<"v_acc_m"> vert_accuracy{};
    U2<"ignore_flags"> ignore_flags{};  ///< bits: 0 alt, 1 hdop, 2 vdop, 3 vn ve, 4 vd, 5 to 7 the accuracies
    U2<"gps_week"> time_week{};         ///< GPS week, not wrapped; 0 unknown
    U1<"gps_id"> gps_id{};
    U1<"fix_type"> fix_type{};  ///< 0 no receiver, 1 none, 2 2D, 3 3D, 4 differential, 5 RTK float, 6 RTK fixed
    U1<"satellites"> satellites_visible{};
    U2<"yaw_deg*1e-2!0"> yaw{};  ///< 36000 for north; 0 unknown; an extension
};

/// GPS_RAW_INT: what an autopilot's receiver reports to the ground.
struct MavlinkGpsRawInt {
    static constexpr std::uint32_t message_id = 24;
    static constexpr std::uint8_t crc_extra = 24;
    static constexpr std::size_t base_size = 30;
    static constexpr std::string_view message_name = "GPS_RAW_INT";
    U8<"time_s*1e-6"> time_usec{};  ///< of 1970 or of the start
    I4<"lat_deg*1e-7"> lat{};
    I4<"lon_deg*1e-7"> lon{};
    I4<"msl_m*1e-3"> alt{};  ///< above mean sea level
    U2<"hdop*1e-2!65535"> eph = 0xFFFF;
    U2<"vdop*1e-2!65535"> epv = 0xFFFF;
    U2<"speed_mps*1e-2!65535"> vel = 0xFFFF;
    U2<"course_deg*1e-2!65535"> cog = 0xFFFF;
    U1<"fix_type"> fix_type{};  ///< as MavlinkGpsInput::fix_type
    U1<"satellites!255"> satellites_visible = 0xFF;
    I4<"height_m*1e-3"> alt_ellipsoid{};  ///< this and what follows are extensions
    U4<"h_acc_m*1e-3"> h_acc{};
    U4<"v_acc_m*1e-3"> v_acc{};
    U4<"speed_acc_mps*1e-3"> vel_acc{};
    U4<"course_acc_deg*1e-5"> hdg_acc{};
    U2<"yaw_deg*1e-2!0"> yaw{};  ///< 36000 for north; 0 unknown
};

/// GPS_RTCM_DATA: a piece of an RTCM stream on its way to a receiver.
struct MavlinkGpsRtcmData {
    static constexpr std::uint32_t message_id = 233;
    static constexpr std::uint8_t crc_extra = 35;
    static constexpr std::size_t base_size = 182;
    static constexpr std::string_view message_name = "GPS_RTCM_DATA";
    U1<"flags"> flags{};  ///< bits: 0 a fragment, 1-2 which, 3-7 of which message
    U1<"length"> length{};
    U1<"data", 180> data{};
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
