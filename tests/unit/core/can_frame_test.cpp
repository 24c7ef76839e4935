#include "base/core/can_frame.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace skyloop {
namespace {

using testing::ElementsAre;

TEST(CanFrame, IsALineOfSlcan) {
    const auto extended = can_frame(0x18042A0A, true, Bytes{0x01, 0x7D});
    ASSERT_TRUE(extended);
    EXPECT_EQ(slcan_line(*extended), "T18042A0A2017D\r");
    EXPECT_EQ(slcan_line(*can_frame(0x7FF, false, {})), "t7FF0\r");
    EXPECT_EQ(parse_slcan_line("T18042A0A2017D"), extended);
    EXPECT_EQ(parse_slcan_line("T18042a0a2017d"), extended);
    EXPECT_EQ(parse_slcan_line("T18042A0A2017DEA5F"), extended) << "with a time stamp";
    EXPECT_EQ(parse_slcan_line("t7FF0"), can_frame(0x7FF, false, {}));
}

TEST(CanFrame, IsNoneOfOtherTexts) {
    for (const char* line : {"", "T", "V1013", "T18042A0A2017", "T18042A0A2017DE", "T18042A0A9017D", "TG8042A0A2017D",
                             "t8000", "T200000000", "R18042A0A2", "r1230", "T18042A0A2017DEA5F0", "T18042A0A1XY"})
        EXPECT_FALSE(parse_slcan_line(line)) << line;
    EXPECT_FALSE(can_frame(0x800, false, {}));
    EXPECT_FALSE(can_frame(0x20000000, true, {}));
    EXPECT_FALSE(can_frame(1, true, Bytes(9)));
}

TEST(CanFrame, IsALineOfCandump) {
    EXPECT_EQ(parse_candump_line("(1700000000.123456) can0 18042A0A#017D"),
              can_frame(0x18042A0A, true, Bytes{1, 0x7D}));
    EXPECT_EQ(parse_candump_line("(1700000000.123456) vcan0 123#"), can_frame(0x123, false, {}));
    EXPECT_EQ(parse_candump_line("(0.1) can0 123#01 R\r"), can_frame(0x123, false, Bytes{1}));
    for (const char* line : {"", "can0 123#01", "(0.1)", "(0.1) can0", "(0.1) can0 123", "(0.1) can0 123##101",
                             "(0.1) can0 123#R", "(0.1) can0 12#01", "(0.1)  123#01"})
        EXPECT_FALSE(parse_candump_line(line)) << line;
}

TEST(SlcanLines, AreCutAtCarriageReturns) {
    SlcanLines lines;
    EXPECT_THAT(lines.feed(to_bytes("S8\r\nO")), ElementsAre("S8"));
    EXPECT_THAT(lines.feed(to_bytes("\rt1230\r\r")), ElementsAre("O", "t1230", ""));
    EXPECT_THAT(lines.feed(to_bytes(std::string(1000, 'T') + "\r")), ElementsAre(std::string(65, 'T')));
}

}  // namespace
}  // namespace skyloop
