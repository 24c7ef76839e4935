// The keys of [nmea] that vary what receivers of sentences send.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "run/scenario/board_files.hpp"

namespace skyloop {
namespace {

using firmware::BoardProfile;
using firmware::GsaStyle;
using firmware::HeadingSource;
using firmware::NmeaSentence;
using firmware::ToldGeoid;
using firmware::ToldQuality;
using testing::HasSubstr;
using testing::Optional;
using testing::Pair;
using testing::SizeIs;
using testing::UnorderedElementsAre;

std::string nmea_refusal(const std::string& keys, const std::string& before = "") {
    const auto board = read_board(before + "[nmea]\n" + keys, "mine.toml");
    return board ? "accepted" : board.error().message;
}

TEST(BoardNmea, TakesEveryVariety) {
    const auto board = read_board(
        "[nmea]\nversion = \"3.0\"\nmain_talker = \"II\"\nheading = \"attitude\"\nheading_talker = \"HE\"\n"
        "heading_decimals = 1\nmagnetic_variation_deg = -3.5\nquality = \"simulator\"\nsimulated_is_valid = true\n"
        "gsa = \"one\"\ngeoid_separation = \"empty\"\ncoordinate_decimals = 2\n[nmea.sentences]\nHDT = 1\nROT = 2\n"
        "[nmea.late]\nRMC = 1\nVTG = 20\n[[nmea.lines]]\ntext = \"$PXXX,{GGA.2}\"\nevery = 5\nafter = \"GSV\"\n"
        "[[nmea.lines]]\ntext = \"$PYYY\"\n",
        "mine.toml");
    ASSERT_TRUE(board) << board.error().message;
    EXPECT_EQ(board->nmea_version, NmeaVersion::v3_0);
    EXPECT_EQ(board->main_talker, "II");
    EXPECT_EQ(board->coordinate_decimals, 2);
    const firmware::NmeaStyle& style = board->style;
    EXPECT_EQ(style.heading, HeadingSource::attitude);
    EXPECT_EQ(style.heading_talker, "HE");
    EXPECT_EQ(style.heading_decimals, 1);
    EXPECT_EQ(style.magnetic_variation_deg, -3.5);
    EXPECT_EQ(style.quality, ToldQuality::simulator);
    EXPECT_TRUE(style.simulated_is_valid);
    EXPECT_EQ(style.gsa, GsaStyle::one);
    EXPECT_EQ(style.geoid, ToldGeoid::nothing);
    EXPECT_THAT(board->sentences, SizeIs(2));
    EXPECT_THAT(style.late,
                UnorderedElementsAre(Pair(UbxMessageId{0xF0, 0x04}, 1), Pair(UbxMessageId{0xF0, 0x05}, 20)));
    ASSERT_THAT(style.lines, SizeIs(2));
    EXPECT_EQ(style.lines[0].text, "$PXXX,{GGA.2}");
    EXPECT_EQ(style.lines[0].every_epochs, 5);
    EXPECT_THAT(style.lines[0].after, Optional(NmeaSentence::gsv));
    EXPECT_EQ(style.lines[1].every_epochs, 1);
    EXPECT_EQ(style.lines[1].after, std::nullopt);
}

TEST(BoardNmea, RefusesWhatItCannotDo) {
    EXPECT_THAT(nmea_refusal("heading = \"gyro\"\n"),
                HasSubstr("mine.toml:2:11: nmea.heading: is 'gyro'; expected one of antennas course attitude"));
    EXPECT_THAT(nmea_refusal("heading_talker = \"XX\"\n"), HasSubstr("expected one of HE HC HN GP GN TI II IN"));
    EXPECT_THAT(nmea_refusal("[nmea.late]\nRMC = 21\n"), HasSubstr("nmea.late.RMC"));
    EXPECT_THAT(nmea_refusal("[nmea.late]\nRMX = 1\n"), HasSubstr("did you mean 'RMC'?"));
    EXPECT_THAT(nmea_refusal("[[nmea.lines]]\nevery = 2\n"), HasSubstr("has no text"));
    EXPECT_THAT(
        nmea_refusal("[[nmea.lines]]\ntext = \"$PX,{h_ac_m}\"\n"),
        HasSubstr("mine.toml:3:8: nmea.lines.text: has '{h_ac_m}'; expected a field of a sentence such as {GGA.9}"));
    EXPECT_THAT(nmea_refusal("[[nmea.lines]]\ntext = \"$PX\"\n", "personality = \"msp\"\n"),
                HasSubstr("lines: has no effect: receivers of the personality \"msp\" send no sentences"));
}

TEST(BoardNmea, GivesAUbloxWhatItsConfigurationHasANumberFor) {
    const std::string ublox = "personality = \"ublox\"\n";
    EXPECT_THAT(nmea_refusal("version = \"3.0\"\n", ublox), HasSubstr("version: is 3.0, which no u-blox receiver has"));
    EXPECT_THAT(nmea_refusal("main_talker = \"II\"\n", ublox), HasSubstr("'II', which no u-blox receiver has"));
    EXPECT_EQ(nmea_refusal("main_talker = \"GN\"\nheading_talker = \"HE\"\n[[nmea.lines]]\ntext = \"$PX\"\n", ublox),
              "accepted");
}

TEST(BoardNmea, ShipsKindsOfReceivers) {
    const std::vector<std::filesystem::path> shipped{std::filesystem::path(SKYLOOP_SOURCE_DIR) / "boards"};
    const auto cheap = find_board("nmea-cheap", shipped), marine = find_board("nmea-marine", shipped);
    ASSERT_TRUE(cheap && marine);
    EXPECT_EQ(cheap->style.geoid, ToldGeoid::zero);
    EXPECT_THAT(cheap->style.late, SizeIs(2));
    EXPECT_EQ(marine->style.heading, HeadingSource::attitude);
    EXPECT_EQ(find_board("nmea-survey", shipped)->coordinate_decimals, 8);
    EXPECT_THAT(find_board("nmea-aviation", shipped)->style.lines, SizeIs(2));
    EXPECT_TRUE(find_board("nmea-generic", shipped)->style.late.empty());
}

}  // namespace
}  // namespace skyloop
