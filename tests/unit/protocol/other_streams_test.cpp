#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "receiver/protocol/mavlink.hpp"
#include "receiver/protocol/msp.hpp"
#include "receiver/protocol/sbf_blocks.hpp"
#include "receiver/protocol/stream_splitter.hpp"
#include "receiver/protocol/ubx_nav.hpp"
#include "support/oracle_table.hpp"
#include "support/split_stream.hpp"

namespace skyloop {
namespace {

constexpr StreamProtocols every_protocol{true, true, true, true, true, true};

struct SplitStream {
    std::vector<StreamPiece> pieces;
    StreamCounts counts;
    [[nodiscard]] std::uint64_t frames(StreamKind kind) const { return counts.frames[static_cast<std::size_t>(kind)]; }
    [[nodiscard]] std::uint64_t bad(StreamKind kind) const { return counts.bad[static_cast<std::size_t>(kind)]; }
};

SplitStream split_all(ByteSpan stream, std::size_t step, StreamProtocols protocols = every_protocol) {
    StreamSplitter splitter(protocols);
    SplitStream result;
    result.pieces = test::split_stream(splitter, stream, step);
    result.counts = splitter.counts();
    return result;
}

void append(Bytes& stream, const Bytes& more) { stream.insert(stream.end(), more.begin(), more.end()); }

Bytes broken(Bytes frame) {
    frame.back() = static_cast<std::uint8_t>(frame.back() ^ 1);
    return frame;
}

Bytes six_protocols() {
    Bytes stream = to_bytes("$MTK,$M<$X$@\xFE\x01\xFD");
    append(stream, encode_msp(MspSensorGps{}));
    append(stream, encode_msp(MspSetRawGps{}));
    append(stream, broken(encode_msp(MspSetRawGps{})));
    append(stream, encode_sbf(SbfDop{}));
    append(stream, broken(encode_sbf(SbfDop{})));
    append(stream, encode_mavlink({}, MavlinkHeartbeat{}));
    append(stream, encode_mavlink_v1({}, 0, encode_payload(MavlinkHeartbeat{})));
    append(stream, broken(encode_mavlink({}, MavlinkGpsInput{})));
    append(stream, to_bytes("$GPTXT,01,01,02,a*2C\r\n$GPTXT,01,01,02,a*00\r\n$PUBX,40\n"));
    append(stream, encode_frame(NavEoe{1000}));
    append(stream, broken(encode_frame(NavEoe{1000})));
    append(stream, encode_sbf(SbfPvtGeodetic{}));
    return stream;
}

TEST(OtherStreams, EveryProtocolIsFoundAndItsWrongChecksumsCounted) {
    const Bytes stream = six_protocols();
    const SplitStream found = split_all(stream, stream.size());
    EXPECT_EQ(found.frames(StreamKind::msp), 2u);
    EXPECT_EQ(found.bad(StreamKind::msp), 2u);  // "$M<$X…" is whole, too, by chance
    EXPECT_EQ(found.frames(StreamKind::sbf), 2u);
    EXPECT_EQ(found.bad(StreamKind::sbf), 1u);
    EXPECT_EQ(found.frames(StreamKind::mavlink), 2u);
    EXPECT_EQ(found.bad(StreamKind::mavlink), 1u);
    EXPECT_EQ(found.frames(StreamKind::nmea), 1u);
    EXPECT_EQ(found.bad(StreamKind::nmea), 2u);
    EXPECT_EQ(found.frames(StreamKind::ubx), 1u);
    EXPECT_EQ(found.bad(StreamKind::ubx), 1u);
    EXPECT_EQ(found.counts.bytes, stream.size());
    Bytes joined;
    std::uint64_t noise = 0;
    for (const StreamPiece& piece : found.pieces) {
        append(joined, piece.bytes);
        if (piece.kind == StreamKind::noise) noise += piece.bytes.size();
    }
    EXPECT_EQ(joined, stream);
    EXPECT_EQ(found.counts.skipped, noise);
}

TEST(OtherStreams, CutsChangeNeitherPiecesNorCounts) {
    const Bytes stream = six_protocols();
    const SplitStream whole = split_all(stream, stream.size());
    for (const std::size_t step : {1u, 2u, 3u, 7u, 64u}) {
        const SplitStream cut = split_all(stream, step);
        EXPECT_EQ(cut.pieces, whole.pieces) << step;
        EXPECT_EQ(cut.counts.frames, whole.counts.frames) << step;
        EXPECT_EQ(cut.counts.bad, whole.counts.bad) << step;
    }
}

TEST(OtherStreams, AreOnlyLookedForWhenAskedTo) {
    const SplitStream found = split_all(six_protocols(), 100, StreamProtocols{});
    for (const StreamKind kind : {StreamKind::msp, StreamKind::mavlink, StreamKind::sbf}) {
        EXPECT_EQ(found.frames(kind), 0u);
        EXPECT_EQ(found.bad(kind), 0u);
    }
    EXPECT_EQ(found.frames(StreamKind::ubx), 1u);
    const SplitStream alone = split_all(six_protocols(), 100, {false, false, false, false, true, false});
    EXPECT_EQ(alone.frames(StreamKind::mavlink), 2u);
    EXPECT_EQ(alone.frames(StreamKind::ubx) + alone.frames(StreamKind::nmea), 0u);
}

// A message that is not known may be 280 bytes long; nobody waits for them.
TEST(OtherStreams, UnknownMavlinkMessagesDoNotDelayWhatFollows) {
    StreamSplitter splitter(every_protocol);
    Bytes stream{0xFD, 255, 0, 0, 0, 1, 1, 29, 0, 0};
    append(stream, encode_frame(NavEoe{1000}));
    const auto pieces = splitter.feed(stream);
    ASSERT_EQ(pieces.size(), 2u);
    EXPECT_EQ(pieces[1].kind, StreamKind::ubx);
}

// Looking for three more protocols must not find any where none speaks, nor lose what is there.
TEST(OtherStreams, RealReceiversOfOtherKindsGiveNoFalseFrames) {
    SKYLOOP_REQUIRE_SHARED(folder, "serial");
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        if (!entry.is_regular_file()) continue;
        std::ifstream file(entry.path(), std::ios::binary);
        const std::string text{std::istreambuf_iterator<char>(file), {}};
        const SplitStream with = split_all(to_bytes(text), 4096);
        const SplitStream without = split_all(to_bytes(text), 4096, StreamProtocols{});
        for (const StreamKind kind : {StreamKind::msp, StreamKind::mavlink, StreamKind::sbf})
            EXPECT_EQ(with.frames(kind), 0u) << entry.path();
        for (const StreamKind kind : {StreamKind::ubx, StreamKind::nmea, StreamKind::rtcm3})
            EXPECT_EQ(with.frames(kind), without.frames(kind)) << entry.path();
    }
}

}  // namespace
}  // namespace skyloop
