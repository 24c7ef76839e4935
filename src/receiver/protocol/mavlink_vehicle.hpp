/// MAVLink messages that say where a vehicle is, how it moves and how it stands.
///
/// Fields, units and the bytes for the checksum: MAVLink's common.xml, in the order of the wire (by descending size,
/// extensions behind). North, east, down are those of the place; body axes are forward, right, down; quaternions have
/// the scalar first and turn body axes to north, east, down.
///
/// The one list of the MAVLink messages that are known here.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "receiver/protocol/mavlink.hpp"

namespace skyloop::inline receiver {

/// SYSTEM_TIME: the sender's clocks.
struct MavlinkSystemTime {
    static constexpr std::uint32_t message_id = 2;
    static constexpr std::uint8_t crc_extra = 137;
    static constexpr std::size_t base_size = 12;
    static constexpr std::string_view message_name = "SYSTEM_TIME";
    U8<"unix_time_s*1e-6!0"> time_unix_usec{};  ///< since 1970, as POSIX counts; 0 unknown
    U4<"boot_time_s*1e-3"> time_boot_ms{};      ///< since the start
};

/// ATTITUDE: as angles.
struct MavlinkAttitude {
    static constexpr std::uint32_t message_id = 30;
    static constexpr std::uint8_t crc_extra = 39;
    static constexpr std::size_t base_size = 28;
    static constexpr std::string_view message_name = "ATTITUDE";
    U4<"boot_time_s*1e-3"> time_boot_ms{};
    R4<"roll_rad"> roll{};
    R4<"pitch_rad"> pitch{};
    R4<"yaw_rad"> yaw{};                ///< from true north
    R4<"roll_rate_rad_s"> rollspeed{};  ///< about the body's axes
    R4<"pitch_rate_rad_s"> pitchspeed{};
    R4<"yaw_rate_rad_s"> yawspeed{};
};

/// ATTITUDE_QUATERNION: without the angles' poles.
struct MavlinkAttitudeQuaternion {
    static constexpr std::uint32_t message_id = 31;
    static constexpr std::uint8_t crc_extra = 246;
    static constexpr std::size_t base_size = 32;
    static constexpr std::string_view message_name = "ATTITUDE_QUATERNION";
    U4<"boot_time_s*1e-3"> time_boot_ms{};
    R4<"q", 4> q{};                     ///< w x y z
    R4<"roll_rate_rad_s"> rollspeed{};  ///< about the body's axes
    R4<"pitch_rate_rad_s"> pitchspeed{};
    R4<"yaw_rate_rad_s"> yawspeed{};
    R4<"repr_offset_q", 4> repr_offset_q{};  ///< for a display of tail-sitters; all zero: none; an extension
};

/// LOCAL_POSITION_NED: the filter's place in metres from its origin (GPS_GLOBAL_ORIGIN).
struct MavlinkLocalPositionNed {
    static constexpr std::uint32_t message_id = 32;
    static constexpr std::uint8_t crc_extra = 185;
    static constexpr std::size_t base_size = 28;
    static constexpr std::string_view message_name = "LOCAL_POSITION_NED";
    U4<"boot_time_s*1e-3"> time_boot_ms{};
    R4<"north_m"> x{};
    R4<"east_m"> y{};
    R4<"down_m"> z{};
    R4<"vel_north_mps"> vx{};
    R4<"vel_east_mps"> vy{};
    R4<"vel_down_mps"> vz{};
};

/// GLOBAL_POSITION_INT: the filter's place and velocity.
struct MavlinkGlobalPositionInt {
    static constexpr std::uint32_t message_id = 33;
    static constexpr std::uint8_t crc_extra = 104;
    static constexpr std::size_t base_size = 28;
    static constexpr std::string_view message_name = "GLOBAL_POSITION_INT";
    U4<"boot_time_s*1e-3"> time_boot_ms{};
    I4<"lat_deg*1e-7"> lat{};
    I4<"lon_deg*1e-7"> lon{};
    I4<"msl_m*1e-3"> alt{};                ///< above mean sea level
    I4<"relative_m*1e-3"> relative_alt{};  ///< above the home position
    I2<"vel_north_mps*1e-2"> vx{};
    I2<"vel_east_mps*1e-2"> vy{};
    I2<"vel_down_mps*1e-2"> vz{};
    U2<"heading_deg*1e-2!65535"> hdg = 0xFFFF;  ///< the vehicle's heading; 65535 unknown
};

/// GPS_GLOBAL_ORIGIN: where local places count from.
struct MavlinkGpsGlobalOrigin {
    static constexpr std::uint32_t message_id = 49;
    static constexpr std::uint8_t crc_extra = 39;
    static constexpr std::size_t base_size = 12;
    static constexpr std::string_view message_name = "GPS_GLOBAL_ORIGIN";
    I4<"lat_deg*1e-7"> latitude{};
    I4<"lon_deg*1e-7"> longitude{};
    I4<"msl_m*1e-3"> altitude{};    ///< above mean sea level
    U8<"time_s*1e-6"> time_usec{};  ///< of 1970 or of the start; an extension
};

/// SIM_STATE: a simulator's truth. ArduPilot puts 1e7 times the degrees into `lat` and `lon`.
struct MavlinkSimState {
    static constexpr std::uint32_t message_id = 108;
    static constexpr std::uint8_t crc_extra = 32;
    static constexpr std::size_t base_size = 84;
    static constexpr std::string_view message_name = "SIM_STATE";
    R4<"q", 4> q{};  ///< w x y z
    R4<"roll_rad"> roll{};
    R4<"pitch_rad"> pitch{};
    R4<"yaw_rad"> yaw{};
    R4<"specific_force_x_mps2"> xacc{};  ///< along the body's axes, as accelerometers feel it
    R4<"specific_force_y_mps2"> yacc{};
    R4<"specific_force_z_mps2"> zacc{};
    R4<"roll_rate_rad_s"> xgyro{};
    R4<"pitch_rate_rad_s"> ygyro{};
    R4<"yaw_rate_rad_s"> zgyro{};
    R4<"lat"> lat{};  ///< deg
    R4<"lon"> lon{};  ///< deg
    R4<"height_m"> alt{};
    R4<"std_horizontal"> std_dev_horz{};
    R4<"std_vertical"> std_dev_vert{};
    R4<"vel_north_mps"> vn{};
    R4<"vel_east_mps"> ve{};
    R4<"vel_down_mps"> vd{};
    I4<"lat_deg*1e-7!0"> lat_int{};  ///< 0 unknown; this and what follows are extensions
    I4<"lon_deg*1e-7!0"> lon_int{};  ///< 0 unknown
};

/// HIL_GPS: a simulated receiver's solution for an autopilot.
struct MavlinkHilGps {
    static constexpr std::uint32_t message_id = 113;
    static constexpr std::uint8_t crc_extra = 124;
    static constexpr std::size_t base_size = 36;
    static constexpr std::string_view message_name = "HIL_GPS";
    U8<"time_s*1e-6"> time_usec{};  ///< of 1970 or of the start
    I4<"lat_deg*1e-7"> lat{};
    I4<"lon_deg*1e-7"> lon{};
    I4<"msl_m*1e-3"> alt{};  ///< above mean sea level
    U2<"hdop*1e-2!65535"> eph = 0xFFFF;
    U2<"vdop*1e-2!65535"> epv = 0xFFFF;
    U2<"speed_mps*1e-2!65535"> vel = 0xFFFF;  ///< over ground
    I2<"vel_north_mps*1e-2"> vn{};
    I2<"vel_east_mps*1e-2"> ve{};
    I2<"vel_down_mps*1e-2"> vd{};
    U2<"course_deg*1e-2!65535"> cog = 0xFFFF;
    U1<"fix_type"> fix_type{};  ///< 0 and 1 none, 2 2D, 3 3D
    U1<"satellites!255"> satellites_visible = 0xFF;
    U1<"id"> id{};               ///< of the receiver, from 0; this and what follows are extensions
    U2<"yaw_deg*1e-2!0"> yaw{};  ///< 36000 for north; 0 unknown
};

/// HIL_STATE_QUATERNION: a simulator's truth for an autopilot, and PX4's of its own simulation.
struct MavlinkHilStateQuaternion {
    static constexpr std::uint32_t message_id = 115;
    static constexpr std::uint8_t crc_extra = 4;
    static constexpr std::size_t base_size = 64;
    static constexpr std::string_view message_name = "HIL_STATE_QUATERNION";
    U8<"time_s*1e-6"> time_usec{};      ///< of 1970 or of the start; 0 unknown
    R4<"q", 4> q{};                     ///< w x y z
    R4<"roll_rate_rad_s"> rollspeed{};  ///< about the body's axes
    R4<"pitch_rate_rad_s"> pitchspeed{};
    R4<"yaw_rate_rad_s"> yawspeed{};
    I4<"lat_deg*1e-7"> lat{};
    I4<"lon_deg*1e-7"> lon{};
    I4<"msl_m*1e-3"> alt{};  ///< above mean sea level
    I2<"vel_north_mps*1e-2"> vx{};
    I2<"vel_east_mps*1e-2"> vy{};
    I2<"vel_down_mps*1e-2"> vz{};
    U2<"indicated_airspeed_mps*1e-2"> ind_airspeed{};
    U2<"true_airspeed_mps*1e-2"> true_airspeed{};
    I2<"xacc_g*1e-3"> xacc{};  ///< along the body's axes
    I2<"yacc_g*1e-3"> yacc{};
    I2<"zacc_g*1e-3"> zacc{};
};

/// ODOMETRY: place and motion in frames that the message names.
struct MavlinkOdometry {
    static constexpr std::uint32_t message_id = 331;
    static constexpr std::uint8_t crc_extra = 91;
    static constexpr std::size_t base_size = 230;
    static constexpr std::string_view message_name = "ODOMETRY";
    U8<"time_s*1e-6"> time_usec{};  ///< of 1970 or of the start
    R4<"x_m"> x{};                  ///< axes by frame_id
    R4<"y_m"> y{};
    R4<"z_m"> z{};
    R4<"q", 4> q{};     ///< w x y z, from child_frame_id to frame_id
    R4<"vx_mps"> vx{};  ///< axes by child_frame_id
    R4<"vy_mps"> vy{};
    R4<"vz_mps"> vz{};
    R4<"roll_rate_rad_s"> rollspeed{};  ///< axes by child_frame_id
    R4<"pitch_rate_rad_s"> pitchspeed{};
    R4<"yaw_rate_rad_s"> yawspeed{};
    R4<"pose_covariance", 21>
        pose_covariance{};  ///< upper triangle by rows of x y z roll pitch yaw; first NaN: unknown
    R4<"velocity_covariance", 21> velocity_covariance{};
    U1<"frame_id"> frame_id = 1;               ///< 1 NED, 4 ENU, 20 local forward right down, 21 local forward left up
    U1<"child_frame_id"> child_frame_id = 12;  ///< 12 body forward right down; 8 and 9 are old names of it
    U1<"reset_counter"> reset_counter{};       ///< one more with every jump; this and what follows are extensions
    U1<"estimator_type"> estimator_type{};
    I1<"quality"> quality{};  ///< %; 0 unknown, −1 failed
};

using KnownMavlinkMessages =
    MessageTypes<MavlinkHeartbeat, MavlinkSystemTime, MavlinkGpsRawInt, MavlinkAttitude, MavlinkAttitudeQuaternion,
                 MavlinkLocalPositionNed, MavlinkGlobalPositionInt, MavlinkGpsGlobalOrigin, MavlinkCommandInt,
                 MavlinkCommandLong, MavlinkCommandAck, MavlinkSimState, MavlinkHilGps, MavlinkHilStateQuaternion,
                 MavlinkGpsInput, MavlinkGpsRtcmData, MavlinkOdometry>;

}  // namespace skyloop::inline receiver
