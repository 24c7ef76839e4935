// The pose that every dialect must read the same, in messages of MAVLink made by hand.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>

#include "dialect_bytes.hpp"
#include "dialect_pose.hpp"

namespace skyloop {

inline std::int64_t e7(double degrees) { return std::llround(degrees * 1e7); }
inline void put_q(HandBytes& payload) {
    for (const double part : NorthEastClimb::quaternion())
        payload.f32(part);
}

// Offsets by FEEDS.md 3.6.
inline Bytes hil_state(std::uint64_t time_us, std::uint8_t system = 1, int version = 2, std::int64_t speed_east = 400) {
    HandBytes payload;
    payload.u64(time_us);
    put_q(payload);
    payload.f32s({0.1, 0.2, 0.3}).i32(e7(NorthEastClimb::latitude)).i32(e7(NorthEastClimb::longitude)).i32(510000);
    payload.i16(300).i16(speed_east).i16(-200).i16(5).i16(5).i16(100).i16(200).i16(-1000);
    EXPECT_EQ(payload.bytes().size(), 64u);
    return hand_mavlink(115, 4, payload.bytes(), system, version);
}

inline Bytes sim_state(double latitude_float, double longitude_float, bool integers,
                       const std::array<double, 3>& ned = {3, 4, -2}) {
    HandBytes payload;
    put_q(payload);
    payload.f32s(
        {9, 9, 9, 1, 2, -9.8, 0.1, 0.2, 0.3, latitude_float, longitude_float, 510, 0, 0, ned[0], ned[1], ned[2]});
    if (integers) payload.i32(e7(NorthEastClimb::latitude)).i32(e7(NorthEastClimb::longitude));
    return hand_mavlink(108, 32, payload.bytes());
}

inline Bytes global_position(std::uint32_t boot_ms, std::uint8_t system = 1,
                             std::int64_t latitude = e7(NorthEastClimb::latitude)) {
    HandBytes payload;
    payload.i32(boot_ms).i32(latitude).i32(e7(NorthEastClimb::longitude)).i32(510000).i32(10000);
    payload.i16(300).i16(400).i16(-200).i16(5313);
    return hand_mavlink(33, 104, payload.bytes(), system);
}

inline Bytes attitude_quaternion() {
    HandBytes payload;
    payload.i32(1000);
    put_q(payload);
    payload.f32s({0.1, 0.2, 0.3});
    return hand_mavlink(31, 246, payload.bytes());
}

inline Bytes attitude_angles() {
    HandBytes payload;
    const auto rad = [](double degrees) { return Angle::degrees(degrees).rad(); };
    payload.i32(1000).f32s(
        {rad(NorthEastClimb::roll), rad(NorthEastClimb::pitch), rad(NorthEastClimb::yaw), 0.1, 0.2, 0.3});
    return hand_mavlink(30, 39, payload.bytes(), 1, 1);
}

inline Bytes hand_heartbeat(std::uint8_t by, std::uint8_t system = 1) {
    HandBytes payload;
    payload.i32(0).u8(2).u8(by).u8(0).u8(4).u8(3);
    return hand_mavlink(0, 50, payload.bytes(), system);
}

inline Bytes origin_message(double latitude, double longitude, std::int64_t msl_mm) {
    HandBytes payload;
    payload.i32(e7(latitude)).i32(e7(longitude)).i32(msl_mm);
    return hand_mavlink(49, 39, payload.bytes());
}

inline Bytes local_position(double north, double down) {
    HandBytes payload;
    payload.i32(2000).f32s({north, 0, down, 3, 4, -2});
    return hand_mavlink(32, 185, payload.bytes());
}

inline const PoseTolerance mavlink_tolerance{1e-7, 1e-3, 1e-3, 1e-3, 1e-6, true, true};

}  // namespace skyloop
