#include "receiver/protocol/stream_splitter.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <map>
#include <random>
#include <string>

#include "receiver/protocol/ubx_cfg.hpp"
#include "receiver/protocol/ubx_mon.hpp"
#include "receiver/protocol/ubx_nav.hpp"
#include "receiver/protocol/ubx_satellites.hpp"
#include "receiver/protocol/ubx_time.hpp"
#include "support/oracle_table.hpp"
#include "support/split_stream.hpp"

namespace skyloop {
namespace {

void add(Bytes& stream, const Bytes& more) { stream.insert(stream.end(), more.begin(), more.end()); }

Bytes rtcm_frame() {
    Bytes frame{0xD3, 0, 4, 0x3E, 0xD0, 0, 1};
    const std::uint32_t crc = crc24q(frame);
    for (const int shift : {16, 8, 0})
        frame.push_back(static_cast<std::uint8_t>(crc >> shift & 0xFF));
    return frame;
}

Bytes mixed_stream() {
    Bytes stream{0x55, 0xB5};  // a second sync byte follows
    add(stream, encode_frame(AckAck{6, 1}));
    add(stream, to_bytes("$GPTXT,01,01,02,a*65\r\n"));
    add(stream, {0xB5, 0x62, 1, 7, 0xFF, 0x1F});  // a length over what follows
    add(stream, encode_frame(NavEoe{1000}));
    add(stream, rtcm_frame());
    add(stream, {0xD3, 0, 40});
    add(stream, to_bytes("$GPTXT,cut\x01"));
    add(stream, encode_frame(NavDop{}));
    add(stream, to_bytes("$PUBX,40*7A\n"));  // wrong checksum
    add(stream, Bytes(600, 0x55));
    add(stream, encode_frame(NavPosllh{}));
    return stream;
}

// CRC-24Q of a known RTCM frame: Radio Technical Commission, 10403.3, example of section 4.2.
TEST(StreamSplitter, KnowsCrc24q) {
    const Bytes frame{0xD3, 0x00, 0x13, 0x3E, 0xD7, 0xD3, 0x02, 0x02, 0x98, 0x0E, 0xDE,
                      0xEF, 0x34, 0xB4, 0xBD, 0x62, 0xAC, 0x09, 0x41, 0x98, 0x6F, 0x33};
    EXPECT_EQ(crc24q(frame), 0x360B98u);
}

TEST(StreamSplitter, FindsEveryFrameBetweenDamage) {
    const auto pieces = test::split_stream(StreamProtocols(), mixed_stream(), 1000000);
    std::map<StreamKind, int> found;
    Bytes joined;
    for (const StreamPiece& piece : pieces) {
        ++found[piece.kind];
        add(joined, piece.bytes);
    }
    EXPECT_EQ(found[StreamKind::ubx], 4);
    EXPECT_EQ(found[StreamKind::rtcm3], 1);
    EXPECT_EQ(joined, mixed_stream());
}

TEST(StreamSplitter, DoesNotCareHowTheStreamIsCut) {
    std::mt19937 random(1);
    Bytes stream;
    for (int i = 0; i < 20; ++i) {
        Bytes part = mixed_stream();
        for (int n = 0; n < 10; ++n)
            part[random() % part.size()] = static_cast<std::uint8_t>(random());
        add(stream, part);
    }
    const auto whole = test::split_stream(StreamProtocols(), stream, stream.size());
    for (const std::size_t step : {1u, 2u, 3u, 7u, 64u, 1000u})
        EXPECT_EQ(test::split_stream(StreamProtocols(), stream, step), whole) << step;
}

// RECEIVER.md 1.3: what is whole is not searched once more.
TEST(StreamSplitter, AFrameThatHoldsAnotherIsOneFrame) {
    const Bytes sentence = to_bytes("$PUBX,04*37\r\n");
    const Bytes outer = encode_frame(UbxMessageId{0x06, 0x34}, sentence);
    for (const std::size_t step : {1u, 5u, 100u})
        EXPECT_EQ(test::split_stream(StreamProtocols(), outer, step),
                  (std::vector<StreamPiece>{{StreamKind::ubx, outer}}))
            << step;
    StreamSplitter splitter;
    EXPECT_TRUE(splitter.feed(ByteSpan(outer).first(6 + sentence.size() - 1)).empty());
    EXPECT_FALSE(splitter.holds_whole());
    EXPECT_TRUE(splitter.feed(ByteSpan(outer).subspan(6 + sentence.size() - 1, 1)).empty());
    EXPECT_TRUE(splitter.holds_whole());
    EXPECT_EQ(splitter.give_way(),
              (std::vector<StreamPiece>{{StreamKind::noise, Bytes(outer.begin(), outer.begin() + 6)},
                                        {StreamKind::nmea, sentence}}))
        << "for who knows better: a false beginning";
    EXPECT_FALSE(splitter.holds_whole());
    StreamSplitter impatient(StreamProtocols{.impatient = true});
    EXPECT_EQ(impatient.feed(ByteSpan(outer).first(6 + sentence.size())).size(), 2U);
}

template <class Message>
bool returns(const UbxFrameView& frame, bool& known) {
    if (frame.id != Message::message_id) return false;
    known = true;
    const auto message = decode_payload<Message>(frame.payload);
    if (!message) return false;
    EXPECT_EQ(encode_payload(*message), Bytes(frame.payload.begin(), frame.payload.end()));
    return true;
}

template <class... Message>
bool any_returns(const UbxFrameView& frame, bool& known) {
    return (returns<Message>(frame, known) || ...);
}

bool returns_as_it_was(const UbxFrameView& frame, bool& known) {
    return any_returns<NavPvt, NavPosecef, NavPosllh, NavStatus, NavDop, NavSol, NavVelned, NavHpposllh, NavCov, NavEoe,
                       NavTimeutc, NavTimegps, NavClock, TimTp, NavSat, NavSvinfo, NavSig, RxmRawx, RxmSfrbx, AckAck,
                       AckNak, MonVer, SecUniqid, InfError, InfWarning, InfNotice, CfgPrt, CfgMsg, CfgRate, CfgNav5,
                       CfgGnss>(frame, known);
}

TEST(StreamSplitter, TakesLinesThatSomeProgramEndedOnceMore) {
    const std::string line = "$GPTXT,01,01,02,a*2C\r\r\n";
    const auto pieces = test::split_stream(StreamProtocols(), to_bytes(line + "$GPTXT,01,01,02,a*2C\rx\n"), 1);
    ASSERT_EQ(pieces.size(), 2U);
    EXPECT_EQ(pieces[0].kind, StreamKind::nmea);
    EXPECT_EQ(pieces[0].bytes, to_bytes(line));
    EXPECT_EQ(pieces[1].kind, StreamKind::noise);
}

TEST(StreamSplitter, FramesOfRealReceiversReturnByteForByte) {
    SKYLOOP_REQUIRE_SHARED(folder, "serial");
    std::map<UbxMessageId, int> good, odd;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        if (!entry.is_regular_file()) continue;
        std::ifstream file(entry.path(), std::ios::binary);
        const std::string text{std::istreambuf_iterator<char>(file), {}};
        for (const StreamPiece& piece : test::split_stream(StreamProtocols(), to_bytes(text), 4096)) {
            if (piece.kind != StreamKind::ubx) continue;
            const auto frame = parse_frame(piece.bytes);
            ASSERT_TRUE(frame);
            bool known = false;
            const bool same = returns_as_it_was(*frame, known);
            if (known && !frame->payload.empty()) ++(same ? good : odd)[frame->id];
        }
    }
    for (const auto& [id, count] : good) {
        RecordProperty("frames_" + std::to_string(id.message_class) + "_" + std::to_string(id.id), count);
        std::cout << "class " << int{id.message_class} << " id " << int{id.id} << ": " << count << "\n";
    }
    for (const auto& [id, count] : odd)
        ADD_FAILURE() << int{id.message_class} << " " << int{id.id} << ": " << count;
    EXPECT_GT(good[NavPvt::message_id], 10);
    EXPECT_GT(good[RxmRawx::message_id], 10);
    EXPECT_GT(good[NavSvinfo::message_id], 10);
}

}  // namespace
}  // namespace skyloop
