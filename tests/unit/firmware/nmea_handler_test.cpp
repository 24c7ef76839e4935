#include "firmware/nmea_handler.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sample_epochs.hpp"
#include "skyloop/protocol/nmea_decode.hpp"

namespace skyloop::firmware {
namespace {

using enum Constellation;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::SizeIs;
using testing::StartsWith;

std::vector<std::string> addresses(const std::vector<std::string>& sentences) {
    std::vector<std::string> out;
    for (const auto& s : sentences)
        out.push_back(s.substr(1, 5));
    return out;
}

template <class Message>
std::vector<Message> all_of(const std::vector<std::string>& sentences) {
    std::vector<Message> out;
    for (const auto& s : sentences) {
        const auto message = decode_nmea(s);
        EXPECT_TRUE(message) << s;
        if (message && std::holds_alternative<Message>(*message)) out.push_back(std::get<Message>(*message));
    }
    return out;
}

Fix six_gps_satellites() {
    Fix fix = sample_fix("2024-03-05T12:00:00Z", 47, 8, 500);
    add_satellites(fix, gps, 1, 6);
    return fix;
}

TEST(NmeaHandler, SendsInTheFixedOrder) {
    BoardProfile board = sample_board(NmeaVersion::v4_0, {gps});
    std::reverse(board.sentences.begin(), board.sentences.end());
    EXPECT_THAT(addresses(NmeaHandler(board).sentences({six_gps_satellites()}, 0)),
                ElementsAre("GPRMC", "GPVTG", "GPGGA", "GPGSA", "GPGSV", "GPGSV", "GPGLL", "GPGST", "GPZDA"));
}

TEST(NmeaHandler, SendsASentenceEverySoManyEpochs) {
    BoardProfile board = sample_board(NmeaVersion::v4_0, {gps});
    board.sentences = {{NmeaSentence::gga, 1}, {NmeaSentence::zda, 3}, {NmeaSentence::gll, 0}};
    NmeaHandler handler(board);
    for (std::uint64_t i = 0; i < 9; ++i)
        EXPECT_THAT(handler.sentences({six_gps_satellites()}, i), SizeIs(i % 3 == 0 ? 2 : 1)) << i;
}

TEST(NmeaHandler, ChoosesTheTalkerByTheMajorSystems) {
    const auto talker = [](std::vector<Constellation> enabled) {
        return NmeaHandler(sample_board(NmeaVersion::v4_10, std::move(enabled))).text_message(2, "x").substr(1, 2);
    };
    EXPECT_EQ(talker({gps}), "GP");
    EXPECT_EQ(talker({gps, sbas, qzss}), "GP");
    EXPECT_EQ(talker({gps, glonass}), "GN");
    EXPECT_EQ(talker({galileo}), "GA");
    EXPECT_EQ(talker({beidou, sbas}), "GB");
    EXPECT_EQ(talker({sbas}), "GP");
    BoardProfile board = sample_board(NmeaVersion::v4_10, {gps});
    board.main_talker = "GN";
    EXPECT_THAT(NmeaHandler(board).text_message(0, "txbuf alloc"), StartsWith("$GNTXT,01,01,00,txbuf alloc*61"));
}

TEST(NmeaHandler, ListsOnlyEnabledConstellations) {
    Fix fix = six_gps_satellites();
    add_satellites(fix, galileo, 1, 3);
    add_satellites(fix, glonass, 1, 3);
    const auto sentences = NmeaHandler(sample_board(NmeaVersion::v4_10, {gps, glonass})).sentences({fix}, 0);
    for (const Gsv& page : all_of<Gsv>(sentences))
        EXPECT_NE(page.talker, "GA");
    const auto gsa = all_of<Gsa>(sentences);
    ASSERT_THAT(gsa, SizeIs(2));
    EXPECT_THAT(gsa[0].satellites, ElementsAre(1, 2, 3, 5, 6));
    EXPECT_THAT(gsa[1].satellites, ElementsAre(65, 66, 67));
    EXPECT_EQ(gsa[1].system_id, 2);
    EXPECT_EQ(all_of<Gga>(sentences).at(0).satellites_used, 8);
}

TEST(NmeaHandler, StopsTheNumberOfSatellitesWhereTheBoardDoes) {
    Fix fix = sample_fix("2024-03-05T12:00:00Z", 47, 8, 500);
    add_satellites(fix, gps, 1, 24);
    BoardProfile board = sample_board(NmeaVersion::v4_0, {gps});
    EXPECT_EQ(all_of<Gga>(NmeaHandler(board).sentences({fix}, 0)).at(0).satellites_used, 12);
    board.max_listed_satellites = 99;
    EXPECT_EQ(all_of<Gga>(NmeaHandler(board).sentences({fix}, 0)).at(0).satellites_used, 18);
}

TEST(NmeaHandler, LeavesTheCourseEmptyWhenSlow) {
    Fix fix = six_gps_satellites();
    fix.speed = MetresPerSecond(0.09);
    NmeaHandler handler(sample_board(NmeaVersion::v4_0, {gps}));
    EXPECT_EQ(all_of<Rmc>(handler.sentences({fix}, 0)).at(0).course, std::nullopt);
    EXPECT_EQ(all_of<Vtg>(handler.sentences({fix}, 0)).at(0).course, std::nullopt);
    fix.speed = MetresPerSecond(0.1);
    EXPECT_NEAR(all_of<Rmc>(handler.sentences({fix}, 0)).at(0).course->deg(), 77.78, 1e-9);
}

TEST(NmeaHandler, WritesTheSameTimeIntoEverySentence) {
    Fix fix = six_gps_satellites();
    fix.time += std::chrono::nanoseconds(995'000'000);
    const auto sentences = NmeaHandler(sample_board(NmeaVersion::v4_0, {gps})).sentences({fix}, 0);
    for (const auto& s : sentences) {
        if (s.substr(3, 3) == "GSA" || s.substr(3, 3) == "GSV" || s.substr(3, 3) == "VTG") continue;
        EXPECT_THAT(s, HasSubstr(",120001.00,")) << s;
    }
    EXPECT_THAT(all_of<Zda>(sentences), SizeIs(1));
}

TEST(NmeaHandler, CountsThroughALeapSecondOnlyWhenItKnowsOfIt) {
    Fix fix = sample_fix("2016-12-31T23:59:60Z", 47, 8, 500);
    NmeaHandler handler(sample_board(NmeaVersion::v4_0, {gps}));
    EXPECT_EQ(fix.leap_seconds, 17);
    EXPECT_THAT(handler.sentences({fix}, 0).at(0), StartsWith("$GPRMC,235960.00,A,"));
    fix.leap_seconds = 16;
    EXPECT_THAT(handler.sentences({fix}, 0).at(0), StartsWith("$GPRMC,000001.00,A,"));
}

TEST(NmeaHandler, SplitsTheAccuracyInGst) {
    const Fix fix = six_gps_satellites();
    const Gst gst = all_of<Gst>(NmeaHandler(sample_board(NmeaVersion::v4_0, {gps})).sentences({fix}, 0)).at(0);
    EXPECT_EQ(gst.range_rms, Metres(3.0));  // 3.3 m / 1.1
    EXPECT_EQ(gst.latitude, Metres(2.6));   // 3 m · NDOP 0.88
    EXPECT_EQ(gst.longitude, Metres(2.0));  // 3 m · EDOP 0.66
    EXPECT_EQ(gst.altitude, Metres(5.0));
    EXPECT_GE(gst.semi_major->value(), 2.6);
    EXPECT_LE(gst.semi_minor->value(), 2.0);
}

}  // namespace
}  // namespace skyloop::firmware
