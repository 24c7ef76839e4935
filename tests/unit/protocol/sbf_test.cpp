#include <gtest/gtest.h>

#include <set>

#include "receiver/protocol/sbf_blocks.hpp"
#include "receiver/protocol/sbf_status_blocks.hpp"

namespace skyloop {
namespace {

TEST(Sbf, ChecksumIsTheCatalogues) {
    // CRC-16/XMODEM: polynomial 0x1021, start 0.
    EXPECT_EQ(sbf_crc(to_bytes("123456789")), 0x31C3);
}

TEST(Sbf, BlocksHaveTheLengthsOfTheReferenceGuide) {
    SbfPvtGeodetic pvt;
    EXPECT_EQ(encode_sbf(pvt).size(), 88u);  // revision 0
    pvt.accuracy.emplace();
    EXPECT_EQ(encode_sbf(pvt).size(), 96u);
    EXPECT_EQ(encode_sbf(SbfPosCovGeodetic{}).size(), 56u);
    EXPECT_EQ(encode_sbf(SbfVelCovGeodetic{}).size(), 56u);
    EXPECT_EQ(encode_sbf(SbfDop{}).size(), 32u);
    EXPECT_EQ(encode_sbf(SbfAttEuler{}).size(), 44u);
    EXPECT_EQ(encode_sbf(SbfEndOfPvt{}).size(), 16u);  // filled up to a multiple of four
    SbfAuxAntPositions antennas;
    antennas.antennas.resize(2);
    EXPECT_EQ(encode_sbf(antennas).size(), 8u + 8 + 2 * 52);
    SbfChannelStatus channels;
    channels.channels.resize(3);
    EXPECT_EQ(encode_sbf(channels).size(), 8u + 12 + 3 * 20);
    EXPECT_EQ(encode_sbf(SbfReceiverStatus{}).size(), 8u + 24);
    EXPECT_EQ(encode_sbf(SbfAttCovEuler{}).size(), 40u);
    EXPECT_EQ(encode_sbf(SbfEndOfAtt{}).size(), 16u);
    SbfBaseVectorGeod bases;
    EXPECT_EQ(encode_sbf(bases).size(), 16u);
    bases.bases.resize(1);
    EXPECT_EQ(encode_sbf(bases).size(), 16u + 52);
    SbfQualityInd quality;
    quality.indicators.resize(4);
    EXPECT_EQ(encode_sbf(quality).size(), 16u + 4 * 2);
    SbfRfStatus radio;
    radio.bands.resize(2);
    EXPECT_EQ(encode_sbf(radio).size(), 20u + 2 * 8);
    EXPECT_EQ(encode_sbf(SbfGalAuthStatus{}).size(), 52u);
    EXPECT_EQ(encode_sbf(SbfReceiverTime{}).size(), 24u);  // 22 and two of padding
}

TEST(Sbf, PartsOfAnotherLengthAreNotRead) {
    SbfRfStatus radio;
    radio.bands.resize(1);
    radio.bands[0].frequency = 1575420000;
    const auto block = encode_sbf(radio);
    ASSERT_TRUE(decode_sbf<SbfRfStatus>(parse_sbf(block)->body));
    EXPECT_EQ(decode_sbf<SbfRfStatus>(parse_sbf(block)->body)->bands[0].frequency, 1575420000U);
    radio.sb_length = 12;
    EXPECT_FALSE(decode_sbf<SbfRfStatus>(parse_sbf(encode_sbf(radio))->body));
}

TEST(Sbf, ABlockSaysItsNumberRevisionAndLength) {
    SbfPvtGeodetic pvt;
    pvt.accuracy.emplace();
    pvt.latitude = 0.811;
    pvt.num_sv = 11;
    pvt.accuracy->h_accuracy = 660;
    const Bytes block = encode_sbf(pvt);
    EXPECT_EQ(Bytes(block.begin(), block.begin() + 2), to_bytes("$@"));
    EXPECT_EQ(block[4] + 256 * block[5], 4007 + 2 * 8192);
    EXPECT_EQ(block[6] + 256 * block[7], 96);
    const auto view = parse_sbf(block);
    ASSERT_TRUE(view);
    EXPECT_EQ(view->number, 4007);
    EXPECT_EQ(view->revision, 2);
    const auto back = decode_sbf<SbfPvtGeodetic>(view->body);
    ASSERT_TRUE(back);
    EXPECT_EQ(back->latitude, 0.811);
    EXPECT_EQ(back->num_sv, 11);
    EXPECT_EQ(back->accuracy->h_accuracy, 660);
}

TEST(Sbf, FieldsWithoutContentHaveTheValuesThatMeanNothing) {
    const Bytes body = encode_payload(SbfPvtGeodetic{});
    // Time of week and week: all bits; latitude: -2e10 as a double.
    EXPECT_EQ(Bytes(body.begin(), body.begin() + 6), Bytes(6, 0xFF));
    EXPECT_EQ(Bytes(body.begin() + 8, body.begin() + 16), (Bytes{0, 0, 0, 0x20, 0x5F, 0xA0, 0x12, 0xC2}));
}

TEST(Sbf, EveryChangedByteIsNoticed) {
    const Bytes block = encode_sbf(SbfDop{});
    for (std::size_t i = 0; i < block.size(); ++i) {
        Bytes broken = block;
        broken[i] = static_cast<std::uint8_t>(broken[i] ^ 0x04);
        EXPECT_FALSE(parse_sbf(broken)) << i;
    }
}

TEST(Sbf, OlderAndNewerRevisionsAreReadAsFarAsKnown) {
    const Bytes old = encode_payload(SbfPvtGeodetic{});
    EXPECT_FALSE(decode_sbf<SbfPvtGeodetic>(old)->accuracy);
    Bytes longer = encode_payload(SbfDop{});
    longer.resize(longer.size() + 8);
    EXPECT_TRUE(decode_sbf<SbfDop>(longer));
    EXPECT_FALSE(decode_sbf<SbfDop>(ByteSpan(old).first(20)));
}

TEST(Sbf, ChannelsOfAnotherShapeAreNotMisread) {
    SbfChannelStatus status;
    status.channels.resize(2);
    EXPECT_TRUE(decode_sbf<SbfChannelStatus>(encode_payload(status)));
    status.channels[1].antennas = 2;
    EXPECT_FALSE(decode_sbf<SbfChannelStatus>(encode_payload(status)));
    status.channels[1].antennas = 1;
    status.sb1_length = 16;
    EXPECT_FALSE(decode_sbf<SbfChannelStatus>(encode_payload(status)));
}

TEST(Sbf, SatelliteNumbersOfTheReferenceGuide) {
    EXPECT_EQ(sbf_svid({Constellation::gps, 7}), 7);
    EXPECT_EQ(sbf_svid({Constellation::glonass, 1}), 38);
    EXPECT_EQ(sbf_svid({Constellation::glonass, 24}), 61);
    EXPECT_EQ(sbf_svid({Constellation::galileo, 36}), 106);
    EXPECT_EQ(sbf_svid({Constellation::sbas, 23}), 123);
    EXPECT_EQ(sbf_svid({Constellation::sbas, 41}), 198);
    EXPECT_EQ(sbf_svid({Constellation::beidou, 40}), 180);
    EXPECT_EQ(sbf_svid({Constellation::beidou, 41}), 223);
    EXPECT_EQ(sbf_svid({Constellation::qzss, 3}), 183);
    EXPECT_EQ(sbf_svid({Constellation::navic, 7}), 197);
    EXPECT_EQ(sbf_svid({Constellation::navic, 8}), 216);
    EXPECT_EQ(sbf_svid({Constellation::navic, 14}), 222);
    EXPECT_FALSE(sbf_svid({Constellation::gps, 38}));
    std::set<SatelliteId> seen;
    for (int svid = 0; svid < 256; ++svid) {
        const auto satellite = satellite_from_sbf(static_cast<std::uint8_t>(svid));
        if (!satellite) continue;
        EXPECT_EQ(sbf_svid(*satellite), svid);
        EXPECT_TRUE(seen.insert(*satellite).second) << svid;
    }
    EXPECT_FALSE(satellite_from_sbf(62));  // GLONASS without a known slot
}

TEST(Sbf, RefusesWhatDoesNotFit) {
    EXPECT_TRUE(encode_sbf_block(8192, 0, {}).empty());
    EXPECT_TRUE(encode_sbf_block(1, 8, {}).empty());
    EXPECT_TRUE(encode_sbf_block(1, 0, Bytes(65530)).empty());
    Bytes odd = encode_sbf_block(1, 0, Bytes(4));
    odd[6] = 11;
    EXPECT_FALSE(sbf_block_size(odd));
}

}  // namespace
}  // namespace skyloop
