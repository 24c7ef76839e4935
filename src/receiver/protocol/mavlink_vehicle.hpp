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
    static constexpr std::string_view field_names = "unix_time_s*1e-6!0 boot_time_s*1e-3";
    std::uint64_t time_unix_usec = 0;  ///< us since 1970, as POSIX counts; 0 unknown
    std::uint32_t time_boot_ms = 0;    ///< ms since the start
};

/// ATTITUDE: as angles.
struct MavlinkAttitude {
    static constexpr std::uint32_t message_id = 30;
    static constexpr std::uint8_t crc_extra = 39;
    static constexpr std::size_t base_size = 28;
    static constexpr std::string_view message_name = "ATTITUDE";
    static constexpr std::string_view field_names =
        "boot_time_s*1e-3 roll_rad pitch_rad yaw_rad roll_rate_rad_s pitch_rate_rad_s yaw_rate_rad_s";
    std::uint32_t time_boot_ms = 0;
    float roll = 0;       ///< rad
    float pitch = 0;      ///< rad
    float yaw = 0;        ///< rad from true north
    float rollspeed = 0;  ///< rad/s about the body's axes
    float pitchspeed = 0;
    float yawspeed = 0;
};

/// ATTITUDE_QUATERNION: without the angles' poles.
struct MavlinkAttitudeQuaternion {
    static constexpr std::uint32_t message_id = 31;
    static constexpr std::uint8_t crc_extra = 246;
    static constexpr std::size_t base_size = 32;
    static constexpr std::string_view message_name = "ATTITUDE_QUATERNION";
    static constexpr std::string_view field_names =
        "boot_time_s*1e-3 q roll_rate_rad_s pitch_rate_rad_s yaw_rate_rad_s repr_offset_q";
    std::uint32_t time_boot_ms = 0;
    std::array<float, 4> q{};  ///< w x y z
    float rollspeed = 0;       ///< rad/s about the body's axes
    float pitchspeed = 0;
    float yawspeed = 0;
    std::array<float, 4> repr_offset_q{};  ///< for a display of tail-sitters; all zero: none; an extension
};

/// LOCAL_POSITION_NED: the filter's place in metres from its origin (GPS_GLOBAL_ORIGIN).
struct MavlinkLocalPositionNed {
    static constexpr std::uint32_t message_id = 32;
    static constexpr std::uint8_t crc_extra = 185;
    static constexpr std::size_t base_size = 28;
    static constexpr std::string_view message_name = "LOCAL_POSITION_NED";
    static constexpr std::string_view field_names =
        "boot_time_s*1e-3 north_m east_m down_m vel_north_mps vel_east_mps vel_down_mps";
    std::uint32_t time_boot_ms = 0;
    float x = 0;   ///< m north
    float y = 0;   ///< m east
    float z = 0;   ///< m down
    float vx = 0;  ///< m/s
    float vy = 0;
    float vz = 0;
};

/// GLOBAL_POSITION_INT: the filter's place and velocity.
struct MavlinkGlobalPositionInt {
    static constexpr std::uint32_t message_id = 33;
    static constexpr std::uint8_t crc_extra = 104;
    static constexpr std::size_t base_size = 28;
    static constexpr std::string_view message_name = "GLOBAL_POSITION_INT";
    static constexpr std::string_view field_names =
        "boot_time_s*1e-3 lat_deg*1e-7 lon_deg*1e-7 msl_m*1e-3 relative_m*1e-3 vel_north_mps*1e-2 vel_east_mps*1e-2 "
        "vel_down_mps*1e-2 heading_deg*1e-2!65535";
    std::uint32_t time_boot_ms = 0;
    std::int32_t lat = 0;           ///< 1e-7 deg
    std::int32_t lon = 0;           ///< 1e-7 deg
    std::int32_t alt = 0;           ///< mm above mean sea level
    std::int32_t relative_alt = 0;  ///< mm above the home position
    std::int16_t vx = 0;            ///< cm/s north
    std::int16_t vy = 0;            ///< cm/s east
    std::int16_t vz = 0;            ///< cm/s down
    std::uint16_t hdg = 0xFFFF;     ///< 0.01 deg, the vehicle's heading; 65535 unknown
};

/// GPS_GLOBAL_ORIGIN: where local places count from.
struct MavlinkGpsGlobalOrigin {
    static constexpr std::uint32_t message_id = 49;
    static constexpr std::uint8_t crc_extra = 39;
    static constexpr std::size_t base_size = 12;
    static constexpr std::string_view message_name = "GPS_GLOBAL_ORIGIN";
    static constexpr std::string_view field_names = "lat_deg*1e-7 lon_deg*1e-7 msl_m*1e-3 time_s*1e-6";
    std::int32_t latitude = 0;    ///< 1e-7 deg
    std::int32_t longitude = 0;   ///< 1e-7 deg
    std::int32_t altitude = 0;    ///< mm above mean sea level
    std::uint64_t time_usec = 0;  ///< us, of 1970 or of the start; an extension
};

/// SIM_STATE: a simulator's truth. ArduPilot puts 1e7 times the degrees into `lat` and `lon`.
struct MavlinkSimState {
    static constexpr std::uint32_t message_id = 108;
    static constexpr std::uint8_t crc_extra = 32;
    static constexpr std::size_t base_size = 84;
    static constexpr std::string_view message_name = "SIM_STATE";
    static constexpr std::string_view field_names =
        "q roll_rad pitch_rad yaw_rad specific_force_x_mps2 specific_force_y_mps2 specific_force_z_mps2 "
        "roll_rate_rad_s pitch_rate_rad_s yaw_rate_rad_s lat lon height_m std_horizontal std_vertical vel_north_mps "
        "vel_east_mps vel_down_mps lat_deg*1e-7!0 lon_deg*1e-7!0";
    std::array<float, 4> q{};  ///< w x y z
    float roll = 0;            ///< rad
    float pitch = 0;
    float yaw = 0;
    float xacc = 0;  ///< m/s² along the body's axes, as accelerometers feel it
    float yacc = 0;
    float zacc = 0;
    float xgyro = 0;  ///< rad/s
    float ygyro = 0;
    float zgyro = 0;
    float lat = 0;  ///< deg
    float lon = 0;  ///< deg
    float alt = 0;  ///< m
    float std_dev_horz = 0;
    float std_dev_vert = 0;
    float vn = 0;  ///< m/s
    float ve = 0;
    float vd = 0;
    std::int32_t lat_int = 0;  ///< 1e-7 deg; 0 unknown; this and what follows are extensions
    std::int32_t lon_int = 0;  ///< 1e-7 deg; 0 unknown
};

/// HIL_GPS: a simulated receiver's solution for an autopilot.
struct MavlinkHilGps {
    static constexpr std::uint32_t message_id = 113;
    static constexpr std::uint8_t crc_extra = 124;
    static constexpr std::size_t base_size = 36;
    static constexpr std::string_view message_name = "HIL_GPS";
    static constexpr std::string_view field_names =
        "time_s*1e-6 lat_deg*1e-7 lon_deg*1e-7 msl_m*1e-3 hdop*1e-2!65535 vdop*1e-2!65535 speed_mps*1e-2!65535 "
        "vel_north_mps*1e-2 vel_east_mps*1e-2 vel_down_mps*1e-2 course_deg*1e-2!65535 fix_type satellites!255 id "
        "yaw_deg*1e-2!0";
    std::uint64_t time_usec = 0;  ///< us, of 1970 or of the start
    std::int32_t lat = 0;         ///< 1e-7 deg
    std::int32_t lon = 0;         ///< 1e-7 deg
    std::int32_t alt = 0;         ///< mm above mean sea level
    std::uint16_t eph = 0xFFFF;   ///< HDOP, 0.01
    std::uint16_t epv = 0xFFFF;   ///< VDOP, 0.01
    std::uint16_t vel = 0xFFFF;   ///< cm/s over ground
    std::int16_t vn = 0;          ///< cm/s
    std::int16_t ve = 0;
    std::int16_t vd = 0;
    std::uint16_t cog = 0xFFFF;  ///< 0.01 deg
    std::uint8_t fix_type = 0;   ///< 0 and 1 none, 2 2D, 3 3D
    std::uint8_t satellites_visible = 0xFF;
    std::uint8_t id = 0;    ///< of the receiver, from 0; this and what follows are extensions
    std::uint16_t yaw = 0;  ///< 0.01 deg, 36000 for north; 0 unknown
};

/// HIL_STATE_QUATERNION: a simulator's truth for an autopilot, and PX4's of its own simulation.
struct MavlinkHilStateQuaternion {
    static constexpr std::uint32_t message_id = 115;
    static constexpr std::uint8_t crc_extra = 4;
    static constexpr std::size_t base_size = 64;
    static constexpr std::string_view message_name = "HIL_STATE_QUATERNION";
    static constexpr std::string_view field_names =
        "time_s*1e-6 q roll_rate_rad_s pitch_rate_rad_s yaw_rate_rad_s lat_deg*1e-7 lon_deg*1e-7 msl_m*1e-3 "
        "vel_north_mps*1e-2 vel_east_mps*1e-2 vel_down_mps*1e-2 indicated_airspeed_mps*1e-2 true_airspeed_mps*1e-2 "
        "xacc_g*1e-3 yacc_g*1e-3 zacc_g*1e-3";
    std::uint64_t time_usec = 0;  ///< us, of 1970 or of the start; 0 unknown
    std::array<float, 4> q{};     ///< w x y z
    float rollspeed = 0;          ///< rad/s about the body's axes
    float pitchspeed = 0;
    float yawspeed = 0;
    std::int32_t lat = 0;             ///< 1e-7 deg
    std::int32_t lon = 0;             ///< 1e-7 deg
    std::int32_t alt = 0;             ///< mm above mean sea level
    std::int16_t vx = 0;              ///< cm/s north
    std::int16_t vy = 0;              ///< cm/s east
    std::int16_t vz = 0;              ///< cm/s down
    std::uint16_t ind_airspeed = 0;   ///< cm/s
    std::uint16_t true_airspeed = 0;  ///< cm/s
    std::int16_t xacc = 0;            ///< thousandths of g along the body's axes
    std::int16_t yacc = 0;
    std::int16_t zacc = 0;
};

/// ODOMETRY: place and motion in frames that the message names.
struct MavlinkOdometry {
    static constexpr std::uint32_t message_id = 331;
    static constexpr std::uint8_t crc_extra = 91;
    static constexpr std::size_t base_size = 230;
    static constexpr std::string_view message_name = "ODOMETRY";
    static constexpr std::string_view field_names =
        "time_s*1e-6 x_m y_m z_m q vx_mps vy_mps vz_mps roll_rate_rad_s pitch_rate_rad_s yaw_rate_rad_s "
        "pose_covariance velocity_covariance frame_id child_frame_id reset_counter estimator_type quality";
    std::uint64_t time_usec = 0;  ///< us, of 1970 or of the start
    float x = 0;                  ///< m, axes by frame_id
    float y = 0;
    float z = 0;
    std::array<float, 4> q{};  ///< w x y z, from child_frame_id to frame_id
    float vx = 0;              ///< m/s, axes by child_frame_id
    float vy = 0;
    float vz = 0;
    float rollspeed = 0;  ///< rad/s, axes by child_frame_id
    float pitchspeed = 0;
    float yawspeed = 0;
    std::array<float, 21> pose_covariance{};  ///< upper triangle by rows of x y z roll pitch yaw; first NaN: unknown
    std::array<float, 21> velocity_covariance{};
    std::uint8_t frame_id = 1;         ///< 1 NED, 4 ENU, 20 local forward right down, 21 local forward left up
    std::uint8_t child_frame_id = 12;  ///< 12 body forward right down; 8 and 9 are old names of it
    std::uint8_t reset_counter = 0;    ///< one more with every jump; this and what follows are extensions
    std::uint8_t estimator_type = 0;
    std::int8_t quality = 0;  ///< %; 0 unknown, −1 failed
};

using KnownMavlinkMessages =
    MessageTypes<MavlinkHeartbeat, MavlinkSystemTime, MavlinkGpsRawInt, MavlinkAttitude, MavlinkAttitudeQuaternion,
                 MavlinkLocalPositionNed, MavlinkGlobalPositionInt, MavlinkGpsGlobalOrigin, MavlinkCommandInt,
                 MavlinkCommandLong, MavlinkCommandAck, MavlinkSimState, MavlinkHilGps, MavlinkHilStateQuaternion,
                 MavlinkGpsInput, MavlinkGpsRtcmData, MavlinkOdometry>;

}  // namespace skyloop::inline receiver
