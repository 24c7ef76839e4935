#include "receiver/protocol/mavlink_vehicle.hpp"

#include <gtest/gtest.h>

#include <sstream>
#include <string>

namespace skyloop {
namespace {

// The developer guide's rule for CRC_EXTRA, as in mavlink_test.cpp. @param fields "type name, type name, type name 4"
std::uint8_t extra_of_definition(const std::string& message, const std::string& fields) {
    std::uint16_t crc = crc16_x25(to_bytes(message + " "));
    std::istringstream rest(fields);
    for (std::string field; std::getline(rest, field, ',');) {
        std::istringstream parts(field);
        std::string type, name;
        int length = 0;
        parts >> type >> name >> length;
        crc = crc16_x25(to_bytes(type + " " + name + " "), crc);
        const auto byte = static_cast<std::uint8_t>(length);
        if (length > 0) crc = crc16_x25({&byte, 1}, crc);
    }
    return static_cast<std::uint8_t>((crc & 0xFF) ^ crc >> 8);
}

template <class Message>
void expect_definition(const std::string& fields, std::size_t whole_size) {
    const std::string name(Message::message_name);
    EXPECT_EQ(extra_of_definition(name, fields), Message::crc_extra) << name;
    EXPECT_EQ(mavlink_crc_extra(Message::message_id), Message::crc_extra) << name;
    EXPECT_EQ(wire_size(Message{}), whole_size) << name;
}

TEST(MavlinkVehicle, MessagesAreThoseOfTheDefinitions) {
    const std::string boot = "uint32_t time_boot_ms,", usec = "uint64_t time_usec,",
                      rates = "float rollspeed,float pitchspeed,float yawspeed,", place = "int32_t lat,int32_t lon,",
                      velocity = "int16_t vx,int16_t vy,int16_t vz,";
    expect_definition<MavlinkSystemTime>("uint64_t time_unix_usec,uint32_t time_boot_ms", 12);
    expect_definition<MavlinkAttitude>(boot + "float roll,float pitch,float yaw," + rates, 28);
    expect_definition<MavlinkAttitudeQuaternion>(boot + "float q1,float q2,float q3,float q4," + rates, 48);
    expect_definition<MavlinkLocalPositionNed>(boot + "float x,float y,float z,float vx,float vy,float vz", 28);
    expect_definition<MavlinkGlobalPositionInt>(
        boot + place + "int32_t alt,int32_t relative_alt," + velocity + "uint16_t hdg", 28);
    expect_definition<MavlinkGpsGlobalOrigin>("int32_t latitude,int32_t longitude,int32_t altitude", 20);
    expect_definition<MavlinkSimState>(
        "float q1,float q2,float q3,float q4,float roll,float pitch,float yaw,float xacc,float yacc,float zacc,"
        "float xgyro,float ygyro,float zgyro,float lat,float lon,float alt,float std_dev_horz,float std_dev_vert,"
        "float vn,float ve,float vd",
        92);
    expect_definition<MavlinkHilGps>(usec + place +
                                         "int32_t alt,uint16_t eph,uint16_t epv,uint16_t vel,int16_t vn,int16_t ve,"
                                         "int16_t vd,uint16_t cog,uint8_t fix_type,uint8_t satellites_visible",
                                     39);
    expect_definition<MavlinkHilStateQuaternion>(
        usec + "float attitude_quaternion 4," + rates + place + "int32_t alt," + velocity +
            "uint16_t ind_airspeed,uint16_t true_airspeed,int16_t xacc,int16_t yacc,int16_t zacc",
        64);
    expect_definition<MavlinkOdometry>(usec + "float x,float y,float z,float q 4,float vx,float vy,float vz," + rates +
                                           "float pose_covariance 21,float velocity_covariance 21,uint8_t frame_id,"
                                           "uint8_t child_frame_id",
                                       233);
}

TEST(MavlinkVehicle, NegativeNumbersAndFloatsComeBack) {
    MavlinkGlobalPositionInt m;
    m.time_boot_ms = 4'000'000'000;
    m.lat = -338612345, m.lon = 1512099999, m.alt = -5432, m.vx = -1, m.vz = 32767, m.hdg = 35999;
    const Bytes frame = encode_mavlink({7, 1, 0}, m);
    const auto view = parse_mavlink(frame);
    ASSERT_TRUE(view);
    EXPECT_EQ(view->message, 33u);
    const auto back = decode_mavlink<MavlinkGlobalPositionInt>(view->payload);
    EXPECT_EQ(back.time_boot_ms, 4'000'000'000);
    EXPECT_EQ(back.lat, -338612345);
    EXPECT_EQ(back.vx, -1);
    EXPECT_EQ(encode_payload(back), encode_payload(m));
}

// From an older sender, whose SIM_STATE ends before the whole-numbered place.
TEST(MavlinkVehicle, ExtensionsThatAreLeftOutAreUnknown) {
    MavlinkSimState m;
    m.lat = 1.5F;
    Bytes payload = encode_payload(m);
    payload.resize(MavlinkSimState::base_size);
    const Bytes frame = encode_mavlink_v1({1, 1, 0}, MavlinkSimState::message_id, payload);
    const auto view = parse_mavlink(frame);
    ASSERT_TRUE(view);
    const auto back = decode_mavlink<MavlinkSimState>(view->payload);
    EXPECT_EQ(back.lat, 1.5F);
    EXPECT_EQ(back.lat_int, 0);
}

}  // namespace
}  // namespace skyloop
