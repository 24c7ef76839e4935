#include "receiver/protocol/mavlink.hpp"

#include <gtest/gtest.h>

#include <string>

namespace skyloop {
namespace {

// A field of a definition: its type, name and, of an array, its length.
struct DefinedField {
    std::string type, name;
    std::uint8_t length = 0;
};

// The developer guide's rule for CRC_EXTRA: a checksum of the definition, fields in wire order, extensions left out. A
// wrong order of our fields, or a wrong type, gives another byte than the published one.
std::uint8_t extra_of(const std::string& message, const std::vector<DefinedField>& fields) {
    std::uint16_t crc = crc16_x25(to_bytes(message + " "));
    for (const DefinedField& field : fields) {
        crc = crc16_x25(to_bytes(field.type + " " + field.name + " "), crc);
        if (field.length > 0) crc = crc16_x25({&field.length, 1}, crc);
    }
    return static_cast<std::uint8_t>((crc & 0xFF) ^ crc >> 8);
}

std::string hex_of(const Bytes& bytes) {
    std::string text;
    for (const std::uint8_t byte : bytes) {
        text += "0123456789abcdef"[byte >> 4];
        text += "0123456789abcdef"[byte & 15];
    }
    return text;
}

TEST(Mavlink, ChecksumIsTheCatalogues) { EXPECT_EQ(crc16_x25(to_bytes("123456789")), 0x6F91); }

TEST(Mavlink, ExtraBytesFollowFromTheDefinitions) {
    const std::string u8 = "uint8_t", u16 = "uint16_t", u32 = "uint32_t", u64 = "uint64_t", i32 = "int32_t",
                      real = "float";
    EXPECT_EQ(extra_of("HEARTBEAT", {{u32, "custom_mode"},
                                     {u8, "type"},
                                     {u8, "autopilot"},
                                     {u8, "base_mode"},
                                     {u8, "system_status"},
                                     {u8, "mavlink_version"}}),
              MavlinkHeartbeat::crc_extra);
    EXPECT_EQ(extra_of("GPS_INPUT", {{u64, "time_usec"},
                                     {u32, "time_week_ms"},
                                     {i32, "lat"},
                                     {i32, "lon"},
                                     {real, "alt"},
                                     {real, "hdop"},
                                     {real, "vdop"},
                                     {real, "vn"},
                                     {real, "ve"},
                                     {real, "vd"},
                                     {real, "speed_accuracy"},
                                     {real, "horiz_accuracy"},
                                     {real, "vert_accuracy"},
                                     {u16, "ignore_flags"},
                                     {u16, "time_week"},
                                     {u8, "gps_id"},
                                     {u8, "fix_type"},
                                     {u8, "satellites_visible"}}),
              MavlinkGpsInput::crc_extra);
    EXPECT_EQ(extra_of("GPS_RAW_INT", {{u64, "time_usec"},
                                       {i32, "lat"},
                                       {i32, "lon"},
                                       {i32, "alt"},
                                       {u16, "eph"},
                                       {u16, "epv"},
                                       {u16, "vel"},
                                       {u16, "cog"},
                                       {u8, "fix_type"},
                                       {u8, "satellites_visible"}}),
              MavlinkGpsRawInt::crc_extra);
    EXPECT_EQ(extra_of("GPS_RTCM_DATA", {{u8, "flags"}, {u8, "len"}, {u8, "data", 180}}),
              MavlinkGpsRtcmData::crc_extra);
}

TEST(Mavlink, ExtraBytesOfCommandsFollowFromTheDefinitions) {
    const std::string u8 = "uint8_t", u16 = "uint16_t", i32 = "int32_t", real = "float";
    EXPECT_EQ(extra_of("COMMAND_LONG", {{real, "param1"},
                                        {real, "param2"},
                                        {real, "param3"},
                                        {real, "param4"},
                                        {real, "param5"},
                                        {real, "param6"},
                                        {real, "param7"},
                                        {u16, "command"},
                                        {u8, "target_system"},
                                        {u8, "target_component"},
                                        {u8, "confirmation"}}),
              MavlinkCommandLong::crc_extra);
    EXPECT_EQ(extra_of("COMMAND_INT", {{real, "param1"},
                                       {real, "param2"},
                                       {real, "param3"},
                                       {real, "param4"},
                                       {i32, "x"},
                                       {i32, "y"},
                                       {real, "z"},
                                       {u16, "command"},
                                       {u8, "target_system"},
                                       {u8, "target_component"},
                                       {u8, "frame"},
                                       {u8, "current"},
                                       {u8, "autocontinue"}}),
              MavlinkCommandInt::crc_extra);
    EXPECT_EQ(extra_of("COMMAND_ACK", {{u16, "command"}, {u8, "result"}}), MavlinkCommandAck::crc_extra);
}

// Frames as node-mavlink 2.3.0 with mavlink-mappings 1.0.0 writes them.
TEST(Mavlink, FramesAreThoseOfAnotherImplementation) {
    MavlinkHeartbeat beat;
    beat.custom_mode = 3;
    beat.type = 2;
    beat.autopilot = 3;
    beat.base_mode = 209;
    EXPECT_EQ(hex_of(encode_mavlink({1, 1, 7}, beat)), "fd090000070101000000030000000203d10403a3f5");
    EXPECT_EQ(hex_of(encode_mavlink_v1({1, 1, 7}, 0, encode_payload(beat))), "fe0907010100030000000203d10403fdf4");
    MavlinkCommandLong command;
    command.command = 420;
    command.param1 = 4;
    command.param2 = 1;
    command.param3 = 2;
    command.target_system = 245;
    command.target_component = 191;
    EXPECT_EQ(hex_of(encode_mavlink({255, 190, 9}, command)),
              "fd20000009ffbe4c0000000080400000803f0000004000000000000000000000000000000000a401f5bfa4d0");
    MavlinkCommandInt place;
    place.command = 420;
    place.param1 = 4;
    place.param2 = 7;
    place.param3 = 1;
    place.target_system = 245;
    place.target_component = 191;
    EXPECT_EQ(hex_of(encode_mavlink({255, 190, 10}, place)),
              "fd2000000affbe4b0000000080400000e0400000803f00000000000000000000000000000000a401f5bf5c9a");
    MavlinkCommandAck ack;
    ack.command = 420;
    ack.result = 3;
    ack.target_system = 255;
    ack.target_component = 190;
    EXPECT_EQ(hex_of(encode_mavlink({245, 191, 11}, ack)), "fd0a00000bf5bf4d0000a401030000000000ffbeb5b1");
}

TEST(Mavlink, ADatagramIsReadFrameByFrame) {
    const Bytes beat = encode_mavlink({1, 1, 0}, MavlinkHeartbeat{}), ack = encode_mavlink({}, MavlinkCommandAck{});
    Bytes broken = ack, unknown = ack, datagram = to_bytes("xy");
    broken[10] ^= 1;
    unknown[7] = 1;  // SYS_STATUS, which is not known here
    for (const Bytes& frame : {beat, broken, unknown, ack})
        datagram.insert(datagram.end(), frame.begin(), frame.end());
    const auto frames = mavlink_frames(datagram);
    ASSERT_EQ(frames.size(), 2u);
    EXPECT_EQ(frames[0].message, 0u);
    EXPECT_EQ(frames[1].message, 77u);
    datagram.pop_back();
    EXPECT_EQ(mavlink_frames(datagram).size(), 1u) << "the last is cut short";
    EXPECT_TRUE(mavlink_frames({}).empty());
}

TEST(Mavlink, PayloadsHaveTheSizesOfTheDefinitions) {
    EXPECT_EQ(wire_size(MavlinkHeartbeat{}), 9u);
    EXPECT_EQ(wire_size(MavlinkGpsInput{}), 65u);
    EXPECT_EQ(wire_size(MavlinkGpsRawInt{}), 52u);
    EXPECT_EQ(wire_size(MavlinkGpsRtcmData{}), 182u);
    EXPECT_EQ(wire_size(MavlinkCommandLong{}), 33u);
    EXPECT_EQ(wire_size(MavlinkCommandInt{}), 35u);
    EXPECT_EQ(wire_size(MavlinkCommandAck{}), 10u);
}

TEST(Mavlink, VersionTwoLeavesZerosAtTheEndOut) {
    MavlinkGpsInput m;
    m.lat = 464775000;
    m.satellites_visible = 7;
    const Bytes frame = encode_mavlink({3, 220, 250}, m);
    // The yaw's two bytes are zero.
    ASSERT_EQ(frame.size(), 10u + 63 + 2);
    EXPECT_EQ(Bytes(frame.begin(), frame.begin() + 10), (Bytes{0xFD, 63, 0, 0, 250, 3, 220, 232, 0, 0}));
    const auto view = parse_mavlink(frame);
    ASSERT_TRUE(view);
    EXPECT_EQ(view->source, (MavlinkSource{3, 220, 250}));
    const auto back = decode_mavlink<MavlinkGpsInput>(view->payload);
    EXPECT_EQ(back.lat, 464775000);
    EXPECT_EQ(back.satellites_visible, 7);
    EXPECT_EQ(encode_payload(back), encode_payload(m));
}

TEST(Mavlink, TheFirstByteOfAPayloadStays) {
    const Bytes frame = encode_mavlink_v2({}, 0, Bytes(9));
    EXPECT_EQ(frame.size(), 10u + 1 + 2);
    EXPECT_EQ(decode_mavlink<MavlinkHeartbeat>(parse_mavlink(frame)->payload).mavlink_version, 0);
}

TEST(Mavlink, VersionOneCarriesThePayloadWhole) {
    const Bytes payload = encode_payload(MavlinkHeartbeat{});
    const Bytes frame = encode_mavlink_v1({1, 220, 9}, 0, payload);
    ASSERT_EQ(frame.size(), 6u + 9 + 2);
    EXPECT_EQ(frame[0], 0xFE);
    const auto view = parse_mavlink(frame);
    ASSERT_TRUE(view);
    EXPECT_EQ(view->version, 1);
    EXPECT_EQ(view->source.sequence, 9);
    EXPECT_EQ(decode_mavlink<MavlinkHeartbeat>(view->payload).type, 41);
}

TEST(Mavlink, EveryChangedByteIsNoticed) {
    MavlinkGpsInput m;
    m.time_week = 2400;
    const Bytes frame = encode_mavlink({}, m);
    for (std::size_t i = 0; i < frame.size(); ++i) {
        Bytes broken = frame;
        broken[i] = static_cast<std::uint8_t>(broken[i] ^ 0x40);
        EXPECT_FALSE(parse_mavlink(broken)) << i;
    }
}

TEST(Mavlink, ASignatureBelongsToItsFrame) {
    Bytes frame = encode_mavlink({}, MavlinkHeartbeat{});
    frame[2] = 1;  // signed
    frame.resize(frame.size() - 2);
    const std::uint8_t extra = MavlinkHeartbeat::crc_extra;
    const std::uint16_t crc = crc16_x25({&extra, 1}, crc16_x25(ByteSpan(frame).subspan(1)));
    frame.push_back(static_cast<std::uint8_t>(crc & 0xFF));
    frame.push_back(static_cast<std::uint8_t>(crc >> 8));
    EXPECT_FALSE(parse_mavlink(frame));
    frame.resize(frame.size() + 13);
    const auto view = parse_mavlink(frame);
    ASSERT_TRUE(view);
    EXPECT_TRUE(view->is_signed);
}

TEST(Mavlink, UnknownMessagesCannotBeMadeOrRead) {
    EXPECT_FALSE(mavlink_crc_extra(29));
    EXPECT_TRUE(encode_mavlink_v2({}, 29, Bytes(28)).empty());
    EXPECT_TRUE(encode_mavlink_v1({}, 29, Bytes(28)).empty());
    EXPECT_TRUE(encode_mavlink_v2({}, 0, Bytes(256)).empty());
}

}  // namespace
}  // namespace skyloop
