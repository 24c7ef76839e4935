// Payloads and false beginnings, told apart by the time.
#include "receiver/protocol/stream_splitter.hpp"

#include <gtest/gtest.h>

#include "receiver/protocol/ubx_frame.hpp"

namespace skyloop {
namespace {

using namespace std::chrono_literals;

const GpsTime start_of_talk{100'000s};

// A frame whose payload is a whole sentence, and its bytes until that is whole.
struct Nested {
    Bytes sentence = to_bytes("$PUBX,04*37\r\n");
    Bytes outer = encode_frame(UbxMessageId{0x06, 0x34}, sentence);
    [[nodiscard]] ByteSpan begun() const { return ByteSpan(outer).first(6 + sentence.size()); }
    [[nodiscard]] ByteSpan rest() const { return ByteSpan(outer).subspan(6 + sentence.size()); }
};

TEST(PatientSplitter, TakesWhatStandsInsideForThePayloadAsLongAsBytesCome) {
    const Nested nested;
    PatientSplitter splitter;
    EXPECT_TRUE(splitter.feed(nested.begun(), start_of_talk).empty());
    EXPECT_EQ(splitter.gives_way_at(), start_of_talk + 100ms);
    EXPECT_EQ(splitter.feed(nested.rest(), start_of_talk + 99ms),
              (std::vector<StreamPiece>{{StreamKind::ubx, nested.outer}}));
    EXPECT_EQ(splitter.gives_way_at(), std::nullopt);
}

TEST(PatientSplitter, AFalseBeginningGivesWay) {
    const Nested nested;
    PatientSplitter splitter;
    splitter.feed(nested.begun(), start_of_talk);
    const std::vector<StreamPiece> pieces = splitter.give_way();
    ASSERT_EQ(pieces.size(), 2U);
    EXPECT_EQ(pieces[1], (StreamPiece{StreamKind::nmea, nested.sentence}));
    EXPECT_EQ(splitter.gives_way_at(), std::nullopt);
}

TEST(PatientSplitter, ABeginningThatGoesOnIsFalseAfterASecond) {
    PatientSplitter splitter;
    Bytes stream{0xB5, 0x62, 0x06, 0x3E, 0x00, 0x20};  // of 8192 bytes
    const Bytes poll = encode_frame(UbxMessageId{0x0A, 0x04}, {});
    stream.insert(stream.end(), poll.begin(), poll.end());
    splitter.feed(stream, start_of_talk);
    GpsTime now = start_of_talk;
    for (; now < start_of_talk + 2s && now < splitter.gives_way_at(); now += 50ms)
        splitter.feed(poll, now);
    EXPECT_EQ(splitter.gives_way_at(), start_of_talk + 1s);
    EXPECT_EQ(now, start_of_talk + 1s);
    EXPECT_GT(splitter.give_way().size(), 20U);
}

}  // namespace
}  // namespace skyloop
