// CASIC's frames against captures: of an AT6558D and an ATGM332D-5N31 (jclark/satpulse, gps/casic/casbin), and of
// drivers' own constants (Bwooce and others, mes_disable_timeutc).
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "base/core/bytes.hpp"
#include "receiver/protocol/casic_frame.hpp"
#include "receiver/protocol/casic_messages.hpp"
#include "receiver/protocol/decoded_message.hpp"
#include "receiver/protocol/stream_splitter.hpp"

namespace skyloop::inline receiver {
namespace {

const std::string captured_sol =
    "bace48000102418cc804070700031909100072006209e60800008036cb40bae82a46797731c1bf42b680973b5741053d8e86a7f3364107c0c9"
    "3f00000000000000000000000088ea6b39a4c2893fe958f59d";
const std::string captured_time = "bace180001102890c804ee3d8940004959b70000ea0701120333380700036730994a";
const std::string captured_time_200_ms = "bace18000110f28f6f05ec82c240e6e5a139c800ea0707160f191a070003c516ceb3";
const std::string captured_gps =
    "bacea40001202890c8040d0900001001c0201508bb00000000001c02c1611c15a0009d6e4f400503c1632514d5007b9220c01204c1632e4d1f"
    "018e1d103f1f07c1611d0a3c0155ad61410c08c1632e5293005220d33e1409c163272b3a01f74591bf0f10c020141a1d00000000000e1bc161"
    "1f38310078d6ea400a1fc1211c155c00e62ff7c50bc2c02016293000000000001dc3c1611d187600e5278ec006c700632600000000000000d5"
    "613570";
const std::string captured_pv =
    "bace5000010398a451000707031a09110000f5ec953f98b1ff3d43295940521c09dbae762b40418ef7c100000000621ae13eb191973f000000"
    "0000000000000000000000000000000000000000000856d6380024744924cc33b9";
const std::string captured_dop = "bace1c00010198a45100f5ec953fa6061c3faa07803f20fbbe3ee1c8f63e11b6363f0b1a717c";
const std::string no_glonass = "bace080001222890c804000002003090cb26";
const std::string enable_pv = "bace040006010103010005030701";

Bytes bytes_of_digits(const std::string& digits) {
    Bytes bytes;
    for (std::size_t i = 0; i + 1 < digits.size(); i += 2)
        bytes.push_back(static_cast<std::uint8_t>(std::stoi(digits.substr(i, 2), nullptr, 16)));
    return bytes;
}

template <class Message>
Message read_captured(const std::string& digits) {
    const Bytes bytes = bytes_of_digits(digits);
    const auto frame = parse_casic_frame(bytes);
    EXPECT_TRUE(frame.has_value()) << digits;
    if (!frame) return {};
    EXPECT_EQ(frame->id, Message::message_id);
    const auto message = decode_payload<Message>(frame->payload);
    EXPECT_TRUE(message.has_value()) << digits;
    if (!message) return {};
    EXPECT_EQ(encode_casic(*message).size(), bytes.size());
    return *message;
}

// What was captured, written again, is the same to the byte.
template <class Message>
void expect_written_again(const std::string& digits) {
    EXPECT_EQ(encode_casic(read_captured<Message>(digits)), bytes_of_digits(digits));
}

TEST(CasicFrames, AreWrittenAsCaptured) {
    expect_written_again<CasicNavSol>(captured_sol);
    expect_written_again<CasicNavTimeutc>(captured_time);
    expect_written_again<CasicNavTimeutc>(captured_time_200_ms);
    expect_written_again<CasicGpsSatellites>(captured_gps);
    expect_written_again<CasicGlonassSatellites>(no_glonass);
    expect_written_again<CasicNavPv>(captured_pv);
    expect_written_again<CasicNavDop>(captured_dop);
    expect_written_again<CasicCfgMsg>(enable_pv);
}

TEST(CasicFrames, HaveTheirFieldsWhereCapturesHaveThem) {
    const auto sol = read_captured<CasicNavSol>(captured_sol);
    EXPECT_EQ(sol.run_time, 0x04C88C41U);
    EXPECT_EQ(sol.pos_valid, casic_3d);
    EXPECT_EQ(sol.num_sv, 25);
    EXPECT_EQ(sol.num_bds, 16);
    EXPECT_EQ(sol.week, 2402);
    EXPECT_NEAR(sol.tow, 13933, 60);
    EXPECT_NEAR(std::hypot(sol.ecef[0], sol.ecef[1], sol.ecef[2]), 6.377e6, 2e4);
    const auto time = read_captured<CasicNavTimeutc>(captured_time_200_ms);
    EXPECT_EQ(time.millisecond, 200);
    EXPECT_EQ(time.year, 2026);
    EXPECT_EQ(time.month, 7);
    EXPECT_EQ(time.valid, 7);
    EXPECT_EQ(time.date_valid, 3);
    const auto pv = read_captured<CasicNavPv>(captured_pv);
    EXPECT_NEAR(pv.lon, 100.6447, 1e-3);
    EXPECT_NEAR(pv.lat, 13.7318, 1e-3);
    EXPECT_NEAR(pv.height, -30.94, 0.1);
    const auto gps = read_captured<CasicGpsSatellites>(captured_gps);
    ASSERT_EQ(gps.satellites.size(), 13u);
    EXPECT_EQ(gps.used, 9);
    EXPECT_EQ(gps.satellites[0].channel, 16);
    EXPECT_EQ(gps.satellites[0].sv, 1);
    EXPECT_EQ(gps.satellites[12].channel.value(), 6);
}

TEST(CasicFrames, AreRefusedWhereOneBitIsWrong) {
    const Bytes right = bytes_of_digits(captured_dop);
    for (std::size_t i = 0; i < right.size() * 8; ++i) {
        Bytes wrong = right;
        wrong[i / 8] = static_cast<std::uint8_t>(wrong[i / 8] ^ 1U << i % 8);
        EXPECT_FALSE(parse_casic_frame(wrong).has_value()) << "bit " << i;
    }
    EXPECT_FALSE(parse_casic_frame(ByteSpan(right).first(right.size() - 1)).has_value());
    EXPECT_TRUE(encode_casic_frame({1, 2}, Bytes(5)).empty()) << "no whole words";
    EXPECT_TRUE(encode_casic_frame({1, 2}, Bytes(2048)).empty()) << "2 kB and more";
    EXPECT_EQ(encode_casic_frame({0x06, 0x00}, {}), bytes_of_digits("bace0000060000000600"));
}

TEST(CasicFrames, AreFoundAmongSentencesAndNoise) {
    const Bytes frame = bytes_of_digits(captured_time);
    Bytes stream = to_bytes("$GNRMC,,V,,,,,,,,,,N*4D\r\n");
    for (const Bytes& more : {Bytes{0xBA, 0x00}, frame, Bytes{0xBA, 0xCE, 0x03, 0x00}, frame, to_bytes("x")})
        stream.insert(stream.end(), more.begin(), more.end());
    for (const std::size_t portion : {std::size_t{1}, std::size_t{7}, stream.size()}) {
        StreamSplitter splitter({.casic = true});
        std::vector<StreamPiece> found;
        for (std::size_t at = 0; at < stream.size(); at += portion)
            for (StreamPiece& piece :
                 splitter.feed(ByteSpan(stream).subspan(at, std::min(portion, stream.size() - at))))
                if (piece.kind == StreamKind::casic) found.push_back(std::move(piece));
        ASSERT_EQ(found.size(), 2u) << portion;
        EXPECT_EQ(found[0].bytes, frame);
        EXPECT_EQ(found[1].bytes, frame);
        EXPECT_EQ(splitter.counts().frames[static_cast<std::size_t>(StreamKind::nmea)], 1u);
    }
    StreamSplitter deaf;
    for (const StreamPiece& piece : deaf.feed(stream))
        EXPECT_NE(piece.kind, StreamKind::casic) << "not looked for";
}

TEST(CasicFrames, AreListed) {
    EXPECT_EQ(text_line(decode_piece({StreamKind::casic, bytes_of_digits(captured_time)})),
              "CASIC NAV-TIMEUTC run_time_s=80252.968 t_variance_m2=4.28881 rest_ms=-1.2951205e-05 millisecond=0 "
              "year=2026 month=1 day=18 hour=3 minute=51 second=56 valid=7 time_source=0 date_valid=3");
    EXPECT_EQ(text_line(decode_piece({StreamKind::casic, bytes_of_digits(enable_pv)})),
              "CASIC CFG-MSG class=1 id=3 rate=1");
    const Bytes unknown = encode_casic_frame({0x77, 0x01}, Bytes{1, 2, 3, 4});
    EXPECT_EQ(text_line(decode_piece({StreamKind::casic, unknown})), "CASIC 77-01 4 bytes 01020304");
    EXPECT_EQ(casic_message_name({0x0A, 0x04}), "MON-VER");
    EXPECT_EQ(casic_message_name({0x0B, 0x01}), "");
}

}  // namespace
}  // namespace skyloop::inline receiver
