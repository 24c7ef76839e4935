#include "receiver/protocol/ubx_frame.hpp"

#include <gtest/gtest.h>

#include "receiver/protocol/ubx_cfg.hpp"
#include "receiver/protocol/ubx_mon.hpp"
#include "receiver/protocol/ubx_nav.hpp"
#include "receiver/protocol/ubx_satellites.hpp"
#include "receiver/protocol/ubx_time.hpp"

namespace skyloop {
namespace {

// Sizes: RECEIVER.md section 3.
TEST(UbxFields, KnowTheSizesOfTheMessages) {
    NavPvt pvt;
    EXPECT_EQ(wire_size(pvt), 84u);
    pvt.vehicle.emplace();
    EXPECT_EQ(wire_size(pvt), 92u);
    EXPECT_EQ(wire_size(NavPosecef{}), 20u);
    EXPECT_EQ(wire_size(NavPosllh{}), 28u);
    EXPECT_EQ(wire_size(NavStatus{}), 16u);
    EXPECT_EQ(wire_size(NavDop{}), 18u);
    EXPECT_EQ(wire_size(NavSol{}), 52u);
    EXPECT_EQ(wire_size(NavVelned{}), 36u);
    EXPECT_EQ(wire_size(NavHpposllh{}), 36u);
    EXPECT_EQ(wire_size(NavCov{}), 64u);
    EXPECT_EQ(wire_size(NavEoe{}), 4u);
    EXPECT_EQ(wire_size(NavTimeutc{}), 20u);
    EXPECT_EQ(wire_size(NavTimegps{}), 16u);
    EXPECT_EQ(wire_size(NavClock{}), 20u);
    EXPECT_EQ(wire_size(TimTp{}), 16u);
    EXPECT_EQ(wire_size(CfgNav5{}), 36u);
    EXPECT_EQ(wire_size(CfgRate{}), 6u);
    EXPECT_EQ(wire_size(CfgRst{}), 4u);
    NavSat sat;
    sat.satellites.resize(3);
    EXPECT_EQ(wire_size(sat), 8u + 12u * 3u);
    NavSig sig;
    sig.signals.resize(2);
    EXPECT_EQ(wire_size(sig), 8u + 16u * 2u);
    RxmRawx rawx;
    rawx.measurements.resize(2);
    EXPECT_EQ(wire_size(rawx), 16u + 32u * 2u);
    MonVer version;
    version.extensions.resize(2);
    EXPECT_EQ(wire_size(version), 40u + 30u * 2u);
}

TEST(UbxFrame, AgreesWithKnownFrames) {
    EXPECT_EQ(encode_frame(MonVer::message_id, {}), (Bytes{0xB5, 0x62, 0x0A, 0x04, 0, 0, 0x0E, 0x34}));
    EXPECT_EQ(encode_frame(AckAck{0x06, 0x8A}), (Bytes{0xB5, 0x62, 5, 1, 2, 0, 6, 0x8A, 0x98, 0xC1}));
    EXPECT_EQ(encode_frame(AckNak{0x06, 0x01}), (Bytes{0xB5, 0x62, 5, 0, 2, 0, 6, 1, 0x0E, 0x33}));
    EXPECT_EQ(encode_frame(CfgRate{200, 1, 0}), (Bytes{0xB5, 0x62, 6, 8, 6, 0, 0xC8, 0, 1, 0, 0, 0, 0xDD, 0x68}));
    CfgPrt ports;
    ports.ports.push_back({.port_id = 1, .mode = 0x8D0, .baud_rate = 115200, .in_proto_mask = 1, .out_proto_mask = 1});
    EXPECT_EQ(encode_frame(ports), (Bytes{0xB5, 0x62, 6, 0, 0x14, 0, 1, 0, 0, 0, 0xD0, 8, 0,    0,
                                          0,    0xC2, 1, 0, 1,    0, 1, 0, 0, 0, 0,    0, 0xB8, 0x42}));
    CfgValset set;
    set.layers = 1;
    set.pairs = {{0x40520001, 115200}};
    EXPECT_EQ(encode_frame(set),
              (Bytes{0xB5, 0x62, 6, 0x8A, 0x0C, 0, 0, 1, 0, 0, 1, 0, 0x52, 0x40, 0, 0xC2, 1, 0, 0xF3, 0xA5}));
}

TEST(UbxFrame, RefusesWhatIsNotOneWholeFrame) {
    Bytes frame = encode_frame(AckAck{6, 1});
    const auto whole = parse_frame(frame);
    ASSERT_TRUE(whole);
    EXPECT_EQ(whole->id, AckAck::message_id);
    EXPECT_EQ(whole->payload.size(), 2u);
    EXPECT_FALSE(parse_frame(ByteSpan(frame).first(frame.size() - 1)));
    for (std::size_t i = 0; i < frame.size(); ++i) {
        Bytes damaged = frame;
        damaged[i] ^= 0x10;
        EXPECT_FALSE(parse_frame(damaged)) << i;
    }
    EXPECT_TRUE(encode_frame(MonVer::message_id, Bytes(65536)).empty());
}

TEST(UbxFields, RefuseEveryOtherLength) {
    for (std::size_t size = 0; size < 120; ++size) {
        EXPECT_EQ(decode_payload<NavPvt>(Bytes(size)).has_value(), size == 84 || size == 92) << size;
        EXPECT_EQ(decode_payload<CfgCfg>(Bytes(size)).has_value(), size == 12 || size == 13) << size;
        EXPECT_EQ(decode_payload<CfgPrt>(Bytes(size)).has_value(), size > 0 && size % 20 == 0) << size;
        EXPECT_EQ(decode_payload<SecUniqid>(Bytes(size)).has_value(), size == 9 || size == 10) << size;
    }
    Bytes counted(8 + 12 * 2);
    counted[5] = 2;
    EXPECT_TRUE(decode_payload<NavSat>(counted));
    counted[5] = 3;
    EXPECT_FALSE(decode_payload<NavSat>(counted));
    counted[5] = 1;
    EXPECT_FALSE(decode_payload<NavSat>(counted));
    // A key whose size bits name none cannot be passed over.
    EXPECT_FALSE(decode_payload<CfgValset>(Bytes{0, 1, 0, 0, 1, 0, 0x52, 0x70, 1}));
    EXPECT_FALSE(decode_payload<CfgValset>(Bytes{0, 1, 0, 0, 1, 0, 0x52, 0x40, 1}));
}

}  // namespace
}  // namespace skyloop
