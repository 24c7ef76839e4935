#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "firmware/sentences/nmea_report.hpp"
#include "sample_reports.hpp"

namespace skyloop::firmware {
namespace {

using enum Constellation;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::SizeIs;
using testing::StartsWith;

Fix six_gps_satellites() {
    Fix fix = sample_fix("2024-03-05T12:00:00Z", 47, 8, 500);
    add_satellites(fix, gps, 1, 6);
    return fix;
}

TEST(NmeaMessages, ChooseTheTalkerByTheMajorSystems) {
    const auto talker = [](std::vector<Constellation> enabled) {
        const BoardProfile board = sample_board(NmeaVersion::v4_10, std::move(enabled));
        return nmea_talker(board, receiver_config(ConfigStore(factory_config(board)), board));
    };
    EXPECT_EQ(talker({gps}), "GP");
    EXPECT_EQ(talker({gps, sbas, qzss}), "GP");
    EXPECT_EQ(talker({gps, glonass}), "GN");
    EXPECT_EQ(talker({galileo}), "GA");
    EXPECT_EQ(talker({beidou, sbas}), "GB");
    EXPECT_EQ(talker({sbas}), "GP");
    BoardProfile board = sample_board(NmeaVersion::v4_10, {gps});
    board.main_talker = "GN";
    SampleReceiver receiver(board);
    EXPECT_THAT(to_string(make_text_message(0, "txbuf alloc", receiver.context()).at(0)),
                StartsWith("$GNTXT,01,01,00,txbuf alloc*61"));
    receiver.config.set(in_ram, key::nmea_main_talker, 4);
    EXPECT_THAT(receiver.line(0x04), StartsWith("$GARMC,"));
}

TEST(NmeaMessages, ListsOnlyEnabledConstellations) {
    Fix fix = six_gps_satellites();
    add_satellites(fix, galileo, 1, 3);
    add_satellites(fix, glonass, 1, 3);
    const auto sentences = SampleReceiver(sample_board(NmeaVersion::v4_10, {gps, glonass})).sentences(fix);
    for (const Gsv& page : messages_of_kind<Gsv>(sentences))
        EXPECT_NE(page.talker, "GA");
    const auto gsa = messages_of_kind<Gsa>(sentences);
    ASSERT_THAT(gsa, SizeIs(2));
    EXPECT_THAT(gsa[0].satellites, ElementsAre(1, 2, 3, 5, 6));
    EXPECT_THAT(gsa[1].satellites, ElementsAre(65, 66, 67));
    EXPECT_EQ(gsa[1].system_id, 2);
    EXPECT_EQ(messages_of_kind<Gga>(sentences).at(0).satellites_used, 8);
}

TEST(NmeaMessages, StopsTheNumberOfSatellitesWhereTheBoardDoes) {
    Fix fix = sample_fix("2024-03-05T12:00:00Z", 47, 8, 500);
    add_satellites(fix, gps, 1, 24);
    BoardProfile board = sample_board(NmeaVersion::v4_0, {gps});
    EXPECT_EQ(messages_of_kind<Gga>(SampleReceiver(board).sentences(fix)).at(0).satellites_used, 12);
    board.max_listed_satellites = 99;
    EXPECT_EQ(messages_of_kind<Gga>(SampleReceiver(board).sentences(fix)).at(0).satellites_used, 18);
}

TEST(NmeaMessages, LeavesTheCourseEmptyWhenSlow) {
    Fix fix = six_gps_satellites();
    fix.speed = MetresPerSecond(0.09);
    SampleReceiver receiver(sample_board(NmeaVersion::v4_0, {gps}));
    EXPECT_EQ(messages_of_kind<Rmc>(receiver.sentences(fix)).at(0).course, std::nullopt);
    EXPECT_EQ(messages_of_kind<Vtg>(receiver.sentences(fix)).at(0).course, std::nullopt);
    fix.speed = MetresPerSecond(0.1);
    EXPECT_NEAR(messages_of_kind<Rmc>(receiver.sentences(fix)).at(0).course->deg(), 77.78, 1e-9);
}

TEST(NmeaMessages, WritesTheSameTimeIntoEverySentence) {
    Fix fix = six_gps_satellites();
    fix.time += std::chrono::nanoseconds(995'000'000);
    const auto sentences = SampleReceiver(sample_board(NmeaVersion::v4_0, {gps})).sentences(fix);
    for (const auto& s : sentences) {
        if (s.substr(3, 3) == "GSA" || s.substr(3, 3) == "GSV" || s.substr(3, 3) == "VTG") continue;
        EXPECT_THAT(s, HasSubstr(",120001.00,")) << s;
    }
    EXPECT_THAT(messages_of_kind<Zda>(sentences), SizeIs(1));
}

TEST(NmeaMessages, CountsThroughALeapSecondOnlyWhenItKnowsOfIt) {
    Fix fix = sample_fix("2016-12-31T23:59:60Z", 47, 8, 500);
    SampleReceiver receiver(sample_board(NmeaVersion::v4_0, {gps}));
    EXPECT_EQ(fix.leap_seconds, 17);
    EXPECT_THAT(receiver.sentences(fix).at(0), StartsWith("$GPRMC,235960.00,A,"));
    fix.leap_seconds = 16;
    EXPECT_THAT(receiver.sentences(fix).at(0), StartsWith("$GPRMC,000001.00,A,"));
}

TEST(NmeaMessages, SplitsTheAccuracyInGst) {
    const Fix fix = six_gps_satellites();
    const Gst gst = messages_of_kind<Gst>(SampleReceiver(sample_board(NmeaVersion::v4_0, {gps})).sentences(fix)).at(0);
    EXPECT_EQ(gst.range_rms, Metres(3.0));  // 3.3 m / 1.1
    EXPECT_EQ(gst.latitude, Metres(2.6));   // 3 m · NDOP 0.88
    EXPECT_EQ(gst.longitude, Metres(2.0));  // 3 m · EDOP 0.66
    EXPECT_EQ(gst.altitude, Metres(5.0));
    EXPECT_GE(gst.semi_major->value(), 2.6);
    EXPECT_LE(gst.semi_minor->value(), 2.0);
}

}  // namespace
}  // namespace skyloop::firmware
