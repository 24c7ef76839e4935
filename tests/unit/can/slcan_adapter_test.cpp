#include "wire/can/slcan_adapter.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace skyloop {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

class Slcan : public testing::Test {
protected:
    std::string answer_to(std::string_view text) {
        SlcanAdapter::Taken taken = adapter.take(to_bytes(text));
        frames.insert(frames.end(), taken.frames.begin(), taken.frames.end());
        return taken.answers;
    }
    SlcanAdapter adapter;
    std::vector<CanFrame> frames;
    const CanFrame frame = *can_frame(0x18042A0A, true, Bytes{0x01, 0x7D});
};

// As pydronecan begins (driver/slcan.py): nothing, C, S8, O, F.
TEST_F(Slcan, OpensAsPydronecanAsksForIt) {
    EXPECT_EQ(answer_to("\r"), "\r");
    EXPECT_EQ(answer_to("C\r"), "\a") << "it is closed";
    EXPECT_EQ(answer_to("S8\r"), "\r");
    EXPECT_FALSE(adapter.is_open());
    EXPECT_EQ(answer_to("O\r"), "\r");
    EXPECT_TRUE(adapter.is_open());
    EXPECT_EQ(answer_to("F\r"), "F00\r");
    EXPECT_EQ(answer_to("O\r"), "\a") << "it is open";
    EXPECT_EQ(answer_to("S8\r"), "\a");
    EXPECT_EQ(answer_to("C\r"), "\r");
    EXPECT_FALSE(adapter.is_open());
}

TEST_F(Slcan, LetsFramesThroughWhileTheChannelIsOpen) {
    EXPECT_EQ(answer_to("T18042A0A2017D\r"), "\a");
    EXPECT_THAT(adapter.line_of(frame, 0), IsEmpty());
    answer_to("O\r");
    EXPECT_EQ(answer_to("T18042A0A2017D\rt12301\r"), "Z\r\a");
    EXPECT_EQ(answer_to("t1230\r"), "z\r");
    EXPECT_THAT(frames, ElementsAre(frame, *can_frame(0x123, false, {})));
    EXPECT_EQ(adapter.line_of(frame, 0), "T18042A0A2017D\r");
}

TEST_F(Slcan, ListensAloneWhenAsked) {
    EXPECT_EQ(answer_to("L\r"), "\r");
    EXPECT_EQ(answer_to("T18042A0A2017D\r"), "\a");
    EXPECT_THAT(frames, IsEmpty());
    EXPECT_EQ(adapter.line_of(frame, 0), "T18042A0A2017D\r");
}

TEST_F(Slcan, StampsFramesWhenAsked) {
    EXPECT_EQ(answer_to("Z1\rO\r"), "\r\r");
    EXPECT_EQ(adapter.line_of(frame, 60'000 + 0x1234), "T18042A0A2017D1234\r");
    EXPECT_EQ(answer_to("Z0\r"), "\r");
    EXPECT_EQ(adapter.line_of(frame, 1), "T18042A0A2017D\r");
    EXPECT_EQ(answer_to("Z2\r"), "\a");
}

TEST_F(Slcan, SaysWhoItIsAndRefusesTheRest) {
    EXPECT_EQ(answer_to("V\rN\r"), "V1013\rNSKYL\r");
    EXPECT_EQ(answer_to("s031C\rM00000000\rm00000000\rU3\rX1\r"), "\r\r\r\r\r");
    EXPECT_EQ(answer_to("S9\rS\rSx\rF\rhello\rr1230\r"), "\a\a\a\a\a\a");
    EXPECT_EQ(answer_to(std::string(500, 'T') + "\r"), "\a");
    EXPECT_EQ(answer_to("V"), "") << "not yet a line";
    EXPECT_EQ(answer_to("\r"), "V1013\r");
}

}  // namespace
}  // namespace skyloop
