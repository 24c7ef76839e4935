#include "receiver/protocol/nmea_sentence.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace skyloop {
namespace {

using testing::HasSubstr;

TEST(NmeaChecksum, IsThatOfCapturedSentences) {
    EXPECT_EQ(nmea_checksum("GNRMC,223745.00,A,3806.62964,N,12237.61382,W,0.040,,110720,,,D,V"), 0x0E);
    EXPECT_EQ(nmea_checksum("PUBX,40,GLL,0,0,0,0,0,0"), 0x5C);
    EXPECT_EQ(nmea_checksum(""), 0);
}

TEST(FixedDecimals, RoundsAndNeverPrintsMinusZero) {
    EXPECT_EQ(fixed_decimals(-0.04, 1), "0.0");
    EXPECT_EQ(fixed_decimals(-0.0, 3), "0.000");
    EXPECT_EQ(fixed_decimals(-0.06, 1), "-0.1");
    EXPECT_EQ(fixed_decimals(12.996, 2), "13.00");
    EXPECT_EQ(fixed_decimals(7.4, 0), "7");
    EXPECT_EQ(fixed_decimals(1e9, 1), "1000000000.0");
    EXPECT_EQ(fixed_decimals(std::nan(""), 2), "");
    EXPECT_EQ(fixed_decimals(-std::numeric_limits<double>::infinity(), 2), "");
}

TEST(SentenceBuilder, PadsAndEnds) {
    EXPECT_EQ(Sentence("GNGLL").empty(5).letter('V').letter('N').finish(), "$GNGLL,,,,,,V,N*7A\r\n");
    EXPECT_EQ(Sentence("GPGSV").number(1).number(1).number(0, 2).finish(), "$GPGSV,1,1,00*79\r\n");
}

TEST(ParseSentence, GivesAddressAndFields) {
    const std::string line = "$GNGSA,A,1,,,,,,,,,,,,,99.99,99.99,99.99,1*33\r\n";
    const auto sentence = parse_sentence(line);
    ASSERT_TRUE(sentence) << sentence.error().message;
    EXPECT_EQ(sentence->address, "GNGSA");
    EXPECT_EQ(sentence->talker(), "GN");
    EXPECT_EQ(sentence->formatter(), "GSA");
    EXPECT_EQ(sentence->fields.size(), 18U);
    EXPECT_EQ(sentence->field(14), "99.99");
    EXPECT_EQ(sentence->field(17), "1");
    EXPECT_EQ(sentence->field(18), "");
}

TEST(ParseSentence, TakesLowerCaseChecksumsAndProprietarySentences) {
    const auto sentence = parse_sentence("$PUBX,40,GLL,0,0,0,0,0,0*5c\n");
    ASSERT_TRUE(sentence) << sentence.error().message;
    EXPECT_EQ(sentence->talker(), "P");
    EXPECT_EQ(sentence->formatter(), "UBX");
    ASSERT_TRUE(parse_sentence("$X*58"));
    EXPECT_TRUE(parse_sentence("$X*58   \r\n")) << "as loggers fill up their lines";
    EXPECT_EQ(parse_sentence("$X*58")->formatter(), "");
}

TEST(ParseSentence, RefusesWithTheReason) {
    EXPECT_THAT(parse_sentence("$GNGLL,,,,,,V,N*7B").error().message, HasSubstr("states the checksum 7B"));
    EXPECT_THAT(parse_sentence("$GNGLL,,,,,,V,N").error().message, HasSubstr("does not end in a checksum"));
    EXPECT_THAT(parse_sentence("$GNGLL,,,,,,V,N*7").error().message, HasSubstr("does not end in a checksum"));
    EXPECT_THAT(parse_sentence("$GNGLL,,,,,,V,N*7G").error().message, HasSubstr("does not end in a checksum"));
    EXPECT_THAT(parse_sentence("GNGLL").error().message, HasSubstr("does not start with '$'"));
    EXPECT_THAT(parse_sentence("$GN\x01GLL*00").error().message, HasSubstr("not printable"));
    EXPECT_FALSE(parse_sentence(""));
    EXPECT_FALSE(parse_sentence("$"));
    EXPECT_FALSE(parse_sentence("*00"));
}

}  // namespace
}  // namespace skyloop
