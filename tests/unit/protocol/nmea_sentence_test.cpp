#include "receiver/protocol/nmea_sentence.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "base/core/random.hpp"

namespace skyloop {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

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

TEST(SentenceSplitter, FindsSentencesAmongGarbage) {
    SentenceSplitter splitter;
    const std::string stream =
        std::string("\xb5\x62\x01\x07") + "noise$GNGLL,,,,,,V,N*7A\r\n\r\n\n%dm@51$A\x80$B,1*00\n!AIVDM*00\r\nrest";
    EXPECT_THAT(splitter.feed(to_bytes(stream)), ElementsAre("$GNGLL,,,,,,V,N*7A", "$B,1*00", "!AIVDM*00"));
    EXPECT_EQ(splitter.dropped(), 1U);
}

TEST(SentenceSplitter, DropsLongLinesAndResumes) {
    SentenceSplitter splitter;
    const std::string longest = "$" + std::string(255, 'a');
    EXPECT_THAT(splitter.feed(to_bytes(longest + "\r\n")), ElementsAre(longest));
    EXPECT_THAT(splitter.feed(to_bytes(longest + "b\r\n")), IsEmpty());
    EXPECT_EQ(splitter.dropped(), 1U);
    EXPECT_THAT(splitter.feed(to_bytes("$ok*00\n")), ElementsAre("$ok*00"));
}

TEST(SentenceSplitter, StartsAnewAtADollarAndAfterALoneCarriageReturn) {
    SentenceSplitter splitter;
    EXPECT_THAT(splitter.feed(to_bytes("$GNGGA,12$GNRMC,1*00\r\n$cut\rx\n$cut\r\rx\n$a\r$b\r\n")),
                ElementsAre("$GNRMC,1*00", "$b"));
    EXPECT_EQ(splitter.dropped(), 4U);
    // A line that some program ended once more.
    EXPECT_THAT(splitter.feed(to_bytes("$ok*00\r\r\n")), ElementsAre("$ok*00"));
    EXPECT_EQ(splitter.dropped(), 4U);
}

TEST(SentenceSplitter, GivesTheSameLinesHoweverTheStreamIsSplit) {
    RandomStream random(7, "splitter");
    const std::string alphabet = "$!\r\n*A,\x80";
    std::string stream;
    for (int i = 0; i < 20000; ++i)
        stream += alphabet[random.bits() % alphabet.size()];
    SentenceSplitter whole, pieces;
    const auto expected = whole.feed(to_bytes(stream));
    std::vector<std::string> found;
    for (std::size_t at = 0; at < stream.size();) {
        const std::size_t size = 1 + random.bits() % 50;
        for (auto& line : pieces.feed(to_bytes(std::string_view(stream).substr(at, size))))
            found.push_back(line);
        at += size;
    }
    EXPECT_GT(expected.size(), 100U);
    EXPECT_EQ(found, expected);
    EXPECT_EQ(pieces.dropped(), whole.dropped());
}

}  // namespace
}  // namespace skyloop
