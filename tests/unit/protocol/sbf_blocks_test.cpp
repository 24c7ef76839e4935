// The blocks of measurements, navigation messages and setup.
#include <gtest/gtest.h>

#include "receiver/protocol/decoded_message.hpp"
#include "receiver/protocol/known_sbf.hpp"

namespace skyloop {
namespace {

TEST(SbfBlocks, EveryKnownBlockHasAName) {
    KnownSbfBlocks::any([]<class Message>() {
        EXPECT_FALSE(Message::message_name.empty()) << Message::block_number;
        return false;
    });
}

TEST(SbfBlocks, HaveTheLengthsOfTheReferenceGuide) {
    SbfMeasEpoch epoch;
    epoch.satellites.resize(2);
    epoch.satellites[1].others.resize(3);
    EXPECT_EQ(encode_sbf(epoch).size(), 8u + 12 + 2 * 20 + 3 * 12);
    SbfMeasExtra extra;
    extra.signals.resize(5);
    EXPECT_EQ(encode_sbf(extra).size(), 8u + 12 + 5 * 16);
    EXPECT_EQ(encode_sbf(SbfEndOfMeas{}).size(), 16u);
    EXPECT_EQ(encode_sbf(SbfGpsRawCa{}).size(), 60u);
    EXPECT_EQ(encode_sbf(SbfGloRawCa{}).size(), 32u);
    EXPECT_EQ(encode_sbf(SbfGalRawInav{}).size(), 52u);
    EXPECT_EQ(encode_sbf(SbfGeoRawL1{}).size(), 52u);
    EXPECT_EQ(encode_sbf(SbfBdsRaw{}).size(), 60u);
    EXPECT_EQ(encode_sbf(SbfGpsNav{}).size(), 140u);
    EXPECT_EQ(encode_sbf(SbfBdsNav{}).size(), 140u);
    EXPECT_EQ(encode_sbf(SbfGalNav{}).size(), 152u);
    EXPECT_EQ(encode_sbf(SbfGloNav{}).size(), 100u);
    EXPECT_EQ(encode_sbf(SbfPvtCartesian{}).size(), 96u);
    EXPECT_EQ(encode_sbf(SbfPosCovCartesian{}).size(), 56u);
    EXPECT_EQ(encode_sbf(SbfReceiverSetup{}).size(), 424u);
}

TEST(SbfBlocks, MeasurementsKeepTheirSignalsWithTheirSatellites) {
    SbfMeasEpoch epoch;
    epoch.satellites.resize(2);
    epoch.satellites[0].svid = 7;
    epoch.satellites[0].others.resize(2);
    epoch.satellites[0].others[1].type = 4;
    epoch.satellites[1].svid = 71;
    const auto back = decode_sbf<SbfMeasEpoch>(parse_sbf(encode_sbf(epoch))->body);
    ASSERT_TRUE(back);
    ASSERT_EQ(back->satellites.size(), 2u);
    EXPECT_EQ(back->satellites[0].others.at(1).type, 4);
    EXPECT_TRUE(back->satellites[1].others.empty());
    EXPECT_EQ(back->satellites[1].svid, 71);
    epoch.sb2_length = 16;
    EXPECT_FALSE(decode_sbf<SbfMeasEpoch>(parse_sbf(encode_sbf(epoch))->body)) << "parts of another length";
}

TEST(SbfBlocks, ASignalWithoutContentSaysSo) {
    // The lowest upper parts: −4 of the range's three bits, −16 of the Doppler's five, −128 of the phase's byte.
    EXPECT_EQ(encode_payload(SbfOtherSignal{}), (Bytes{0, 255, 255, 0b10000100, 0x80, 0, 0, 0, 0, 0, 0, 0}));
}

TEST(SbfBlocks, AreListed) {
    SbfMeasEpoch epoch;
    epoch.time = {345600000, 2300};
    epoch.satellites.resize(1);
    epoch.satellites[0].code_lsb = 22000000;
    epoch.satellites[0].cn0 = 141;
    const std::string text = text_line(decode_piece({StreamKind::sbf, encode_sbf(epoch)}));
    EXPECT_TRUE(text.starts_with("SBF MeasEpoch tow_s=345600 week=2300 ")) << text;
    EXPECT_NE(text.find("code_lsb_m=22000 doppler_hz=- "), text.npos) << text;
    EXPECT_NE(text.find(" cn0_above_10_dbhz=35.25 "), text.npos) << text;
    SbfReceiverSetup setup;
    setup.marker_name = {'S', 'E', 'P', 'T'};
    const std::string told = text_line(decode_piece({StreamKind::sbf, encode_sbf(setup)}));
    EXPECT_NE(told.find("marker_name=SEPT "), told.npos) << told;
}

}  // namespace
}  // namespace skyloop
