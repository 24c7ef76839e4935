#include "skyloop/protocol/mavlink.hpp"

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

TEST(Mavlink, PayloadsHaveTheSizesOfTheDefinitions) {
    EXPECT_EQ(wire_size(MavlinkHeartbeat{}), 9u);
    EXPECT_EQ(wire_size(MavlinkGpsInput{}), 65u);
    EXPECT_EQ(wire_size(MavlinkGpsRawInt{}), 52u);
    EXPECT_EQ(wire_size(MavlinkGpsRtcmData{}), 182u);
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
    EXPECT_EQ(decode_mavlink<MavlinkHeartbeat>(view->payload).type, 29);
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
    EXPECT_FALSE(mavlink_crc_extra(30));
    EXPECT_TRUE(encode_mavlink_v2({}, 30, Bytes(28)).empty());
    EXPECT_TRUE(encode_mavlink_v1({}, 30, Bytes(28)).empty());
    EXPECT_TRUE(encode_mavlink_v2({}, 0, Bytes(256)).empty());
}

}  // namespace
}  // namespace skyloop
