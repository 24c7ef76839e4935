#include <gtest/gtest.h>

#include <cctype>
#include <map>

#include "base/core/files.hpp"
#include "receiver/protocol/stream_splitter.hpp"
#include "receiver/protocol/ubx_messages.hpp"
#include "support/oracle_table.hpp"
#include "support/ubx_message_types.hpp"

namespace skyloop {
namespace {

// Sizes: RECEIVER.md 3.1, 3.2.
TEST(UbxMessages, HaveTheSizesOfTheSpecification) {
    EXPECT_EQ(wire_size(NavVelecef{}), 20u);
    EXPECT_EQ(wire_size(NavHpposecef{}), 28u);
    EXPECT_EQ(wire_size(NavOdo{}), 20u);
    EXPECT_EQ(wire_size(NavTimegal{}), 20u);
    EXPECT_EQ(wire_size(NavTimebds{}), 20u);
    EXPECT_EQ(wire_size(NavTimeglo{}), 20u);
    EXPECT_EQ(wire_size(NavTimeqzss{}), 20u);
    EXPECT_EQ(wire_size(NavTimels{}), 24u);
    EXPECT_EQ(wire_size(NavRelposned0{}), 40u);
    EXPECT_EQ(wire_size(NavRelposned{}), 64u);
    EXPECT_EQ(wire_size(NavSvin{}), 40u);
    EXPECT_EQ(wire_size(NavAopstatus{}), 16u);
    EXPECT_EQ(wire_size(NavGeofence{}), 8u);
    EXPECT_EQ(wire_size(NavSlas{}), 20u);
    EXPECT_EQ(wire_size(NavPl{}), 52u);
    EXPECT_EQ(wire_size(MonHw{}), 60u);
    EXPECT_EQ(wire_size(MonHwLong{}), 68u);
    EXPECT_EQ(wire_size(MonHwShort{}), 56u);
    EXPECT_EQ(wire_size(MonHw2{}), 28u);
    EXPECT_EQ(wire_size(MonTxbuf{}), 28u);
    EXPECT_EQ(wire_size(MonRxbuf{}), 24u);
    EXPECT_EQ(wire_size(MonMsgpp{}), 120u);
    EXPECT_EQ(wire_size(MonGnss{}), 8u);
    EXPECT_EQ(wire_size(MonSys{}), 24u);
    EXPECT_EQ(wire_size(RxmRtcm{}), 8u);
    EXPECT_EQ(wire_size(RxmCor{}), 12u);
    EXPECT_EQ(wire_size(RxmRlm{}), 16u);
    EXPECT_EQ(wire_size(TimTm2{}), 28u);
    EXPECT_EQ(wire_size(TimVrfy{}), 20u);
    EXPECT_EQ(wire_size(SecSig1{}), 12u);
    EXPECT_EQ(wire_size(MgaAck{}), 8u);
}

TEST(UbxMessages, HaveTheSizesOfTheirBlocks) {
    EXPECT_EQ(wire_size(NavOrb{.satellites = {2, NavOrbItem{}}}), 8u + 6 * 2);
    EXPECT_EQ(wire_size(NavSbas{.satellites = {2, NavSbasItem{}}}), 12u + 12 * 2);
    EXPECT_EQ(wire_size(NavDgps{.satellites = {2, NavDgpsItem{}}}), 16u + 12 * 2);
    EXPECT_EQ(wire_size(RxmMeasx{.satellites = {2, RxmMeasxItem{}}}), 44u + 24 * 2);
    EXPECT_EQ(wire_size(RxmSvsi{.satellites = {2, RxmSvsiItem{}}}), 8u + 6 * 2);
    EXPECT_EQ(wire_size(MonHw3{.pins = {2, MonHw3Item{}}}), 22u + 6 * 2);
    EXPECT_EQ(wire_size(MonRf{.blocks = {2, MonRfItem{}}}), 4u + 24 * 2);
    EXPECT_EQ(wire_size(MonSpan{.blocks = {2, MonSpanItem{}}}), 4u + 272 * 2);
    EXPECT_EQ(wire_size(MonComms{.ports = {2, MonCommsItem{}}}), 8u + 40 * 2);
    EXPECT_EQ(wire_size(MonIo{.ports = {2, MonIoItem{}}}), 20u * 2);
    EXPECT_EQ(wire_size(MonPatch{.patches = {2, MonPatchItem{}}}), 4u + 16 * 2);
    EXPECT_EQ(wire_size(SecSig2{.bands = {2, SecSigBand{}}}), 4u + 4 * 2);
    EXPECT_EQ(wire_size(SecSiglog{.events = {2, SecSiglogItem{}}}), 8u + 8 * 2);
}

class CapturedUbx : public testing::TestWithParam<const char*> {};

// What real receivers sent, read and written again, is the same bytes.
TEST_P(CapturedUbx, IsWrittenAgainByteForByte) {
    SKYLOOP_REQUIRE_SHARED(path, GetParam());
    const auto text = read_text_file(path);
    ASSERT_TRUE(text) << text.error().message;
    StreamSplitter splitter;
    std::map<UbxMessageId, int> again;
    for (const StreamPiece& piece : splitter.feed(to_bytes(*text))) {
        if (piece.kind != StreamKind::ubx) continue;
        const auto frame = parse_frame(piece.bytes);
        ASSERT_TRUE(frame);
        if (!UbxOutputTypes::names(frame->id)) continue;
        // The first firmware of the ZED-F9R had blocks of 20 bytes, which stand in no document.
        if (frame->id == MonRf::message_id && frame->payload.size() == 4 + 2 * 20) continue;
        const auto written = UbxOutputTypes::written_again(*frame);
        ASSERT_TRUE(written) << to_string(frame->id) << " of " << frame->payload.size() << " bytes";
        ASSERT_EQ(*written, piece.bytes) << to_string(frame->id);
        ++again[frame->id];
    }
    EXPECT_GT(again.size(), 2u);
}

INSTANTIATE_TEST_SUITE_P(
    Serial, CapturedUbx,
    testing::Values("serial/ublox-8-time.log", "serial/ublox-aek-4t.log", "serial/ublox-lea-4t.log",
                    "serial/ublox-neo-m8l.log", "serial/ublox-neo-m8n.log", "serial/ublox-neo-m8p.log",
                    "serial/ublox-neo-m8t-s.log", "serial/ublox-neo-m8u-hnr.log", "serial/ublox-neo-m8u.log",
                    "serial/ublox-x20p.log", "serial/ublox-zed-f9p-hp.log", "serial/ublox-zed-f9p-rtk.log",
                    "serial/ublox-zed-f9p_hpg1.11.log", "serial/ublox-zed-f9r.log", "serial/ublox8-uniqid-monhw.log",
                    "serial/pyubx2-pygpsdata-MIXED.log", "receivers/bend_f9t/F9T-L2-5min.ubx.gz",
                    "receivers/galway_20181015_m8p_static/base-20181015-1654.ubx.gz",
                    "receivers/besancon_20250425_ublox/16dBatt_no_interference_coldstart.ubx.gz"),
    [](const auto& capture) {
        std::string name = capture.param;
        for (char& c : name)
            if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
        return name;
    });

}  // namespace
}  // namespace skyloop
