#include "receiver/protocol/msp.hpp"

#include <gtest/gtest.h>

namespace skyloop {
namespace {

TEST(Msp, ChecksumOfVersionTwoIsDvbS2) {
    // The catalogue's check value of CRC-8/DVB-S2 over "123456789".
    EXPECT_EQ(crc8_dvb_s2(to_bytes("123456789")), 0xBC);
}

TEST(Msp, FramesOfTheInavDocumentation) {
    // The page "MSP V2": MSP_IDENT (100) as a request without payload, in both versions.
    EXPECT_EQ(encode_msp_v1(100, {}), (Bytes{'$', 'M', '<', 0, 100, 100}));
    EXPECT_EQ(encode_msp_v2(100, {}), (Bytes{'$', 'X', '<', 0, 100, 0, 0, 0, 0x8F}));
}

TEST(Msp, SensorGpsHasFiftyTwoBytesInTheOrderOfTheAutopilots) {
    MspSensorGps m;
    m.instance = 1;
    m.gps_week = 0x0203;
    m.ms_tow = 0x04050607;
    m.fix_type = 8;
    m.satellites = 9;
    m.h_acc = 0x0A0B;
    m.longitude = 0x11121314;
    m.latitude = 0x15161718;
    m.course = 0x2122;
    m.true_yaw = 0x2324;
    m.year = 0x07E8;
    m.second = 59;
    const Bytes payload = encode_payload(m);
    ASSERT_EQ(payload.size(), 52u);
    EXPECT_EQ(Bytes(payload.begin(), payload.begin() + 11), (Bytes{1, 3, 2, 7, 6, 5, 4, 8, 9, 0x0B, 0x0A}));
    EXPECT_EQ(Bytes(payload.begin() + 17, payload.begin() + 25),
              (Bytes{0x14, 0x13, 0x12, 0x11, 0x18, 0x17, 0x16, 0x15}));
    EXPECT_EQ(Bytes(payload.begin() + 41, payload.begin() + 47), (Bytes{0x22, 0x21, 0x24, 0x23, 0xE8, 0x07}));
    EXPECT_EQ(payload[51], 59);
    const Bytes frame = encode_msp(m);
    const auto view = parse_msp(frame);
    ASSERT_TRUE(view);
    EXPECT_EQ(view->version, 2);
    EXPECT_EQ(view->function, 0x1F03);
    const auto back = decode_payload<MspSensorGps>(view->payload);
    ASSERT_TRUE(back);
    EXPECT_EQ(encode_payload(*back), payload);
}

TEST(Msp, RawGpsIsFourteenBytesInAVersionOneFrame) {
    MspSetRawGps m;
    m.fix = 1;
    m.satellites = 12;
    m.latitude = 464775000;
    m.longitude = -1;
    m.altitude = 77;
    m.speed = 1250;
    const Bytes frame = encode_msp(m);
    ASSERT_EQ(frame.size(), 20u);
    EXPECT_EQ(Bytes(frame.begin(), frame.begin() + 7), (Bytes{'$', 'M', '<', 14, 201, 1, 12}));
    const auto view = parse_msp(frame);
    ASSERT_TRUE(view);
    EXPECT_EQ(view->version, 1);
    EXPECT_EQ(decode_payload<MspSetRawGps>(view->payload)->longitude, -1);
}

TEST(Msp, EveryChangedByteIsNoticed) {
    const Bytes frame = encode_msp(MspSensorGps{});
    for (std::size_t i = 0; i < frame.size(); ++i) {
        Bytes broken = frame;
        broken[i] = static_cast<std::uint8_t>(broken[i] ^ 0x10);
        EXPECT_FALSE(parse_msp(broken)) << i;
    }
}

TEST(Msp, RefusesWhatDoesNotFit) {
    EXPECT_TRUE(encode_msp_v1(256, {}).empty());
    EXPECT_TRUE(encode_msp_v1(1, Bytes(255)).empty());
    EXPECT_TRUE(encode_msp_v2(1, Bytes(65536)).empty());
    EXPECT_FALSE(msp_frame_size(to_bytes("$M?")));
    EXPECT_FALSE(msp_frame_size(Bytes{'$', 'M', '<', 255, 1}));
}

}  // namespace
}  // namespace skyloop
