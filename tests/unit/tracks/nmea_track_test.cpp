// Logs of NMEA as tracks: what the sentences of one epoch give together, and dates.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include "base/geo/local_frame.hpp"
#include "track_reading.hpp"

namespace skyloop {
namespace {

using test::height_of;
using test::place_of;
using test::refusal_of_track;
using test::track_of;
using test::utc_of;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;

std::string nmea(std::string_view body) {
    unsigned sum = 0;
    for (const char letter : body)
        sum ^= static_cast<unsigned char>(letter);
    return fmt::format("${}*{:02X}\r\n", body, sum);
}

std::string gga(std::string_view time, std::string_view height = "500.0,M,48.0,M", int quality = 1) {
    return nmea(fmt::format("GPGGA,{},4730.0000,N,00815.0000,E,{},10,0.8,{},,", time, quality, height));
}

std::string rmc(std::string_view time, std::string_view date = "050324", std::string_view motion = "19.43844,090.0",
                char status = 'A') {
    return nmea(fmt::format("GPRMC,{},{},4730.0000,N,00815.0000,E,{},{},,", time, status, motion, date));
}

TEST(NmeaTrack, JoinsTheSentencesOfAnEpoch) {
    const Track track = track_of("log begins\n" + rmc("120000.00") + gga("120000.00") + rmc("120001.00") +
                                 gga("120001.00", "502.0,M,48.0,M"));
    ASSERT_EQ(track.points.size(), 2u);
    EXPECT_EQ(track.format, "NMEA");
    EXPECT_EQ(utc_of(track, 1), "2024-03-05T12:00:01.000Z");
    EXPECT_NEAR(height_of(track, 0), 548, 1e-4);
    ASSERT_TRUE(track.points[0].velocity.has_value());
    const Eigen::Vector3d enu = LocalFrame(place_of(track, 0)).to_enu(*track.points[0].velocity).vector();
    EXPECT_LT((enu - Eigen::Vector3d(10, 0, 2)).norm(), 1e-4);  // climbs as the heights do
}

TEST(NmeaTrack, TakesClimbAndAttitudeWhereTheyAreTold) {
    const Track track =
        track_of(rmc("120000.00") + gga("120000.00") +
                 nmea("PUBX,00,120000.00,4730.0000,N,00815.0000,E,548.0,G3,1.0,1.0,36.0,90.0,-3.500,,0.8,1,1,10,0,0") +
                 nmea("PASHR,120000.00,120.5,T,-4.0,2.5,0.0,0.1,0.1,0.2,1,1") + rmc("120001.00") + gga("120001.00") +
                 nmea("GPHDT,200.0,T"));
    const Eigen::Vector3d enu = LocalFrame(place_of(track, 0)).to_enu(*track.points[0].velocity).vector();
    EXPECT_NEAR(enu.z(), 3.5, 1e-6);
    ASSERT_TRUE(track.points[0].attitude && track.points[1].attitude);
    EXPECT_NEAR(track.points[0].attitude->yaw().deg(), 120.5, 1e-9);
    EXPECT_NEAR(track.points[0].attitude->roll().deg(), -4, 1e-9);
    EXPECT_NEAR(track.points[0].attitude->pitch().deg(), 2.5, 1e-9);
    EXPECT_NEAR(track.points[1].attitude->yaw().deg(), -160, 1e-9);
    EXPECT_THAT(track.notes, ElementsAre(HasSubstr("come without roll and pitch")));
}

std::string pubx_00(std::string_view time, double down) {
    return nmea(fmt::format("PUBX,00,{},4730.0000,N,00815.0000,E,548.0,G3,1.0,1.0,36.0,90.0,{:.3f},,0.8,1,1,10,0,0",
                            time, down));
}

std::string pashr(std::string_view time, double heading) {
    return nmea(fmt::format("PASHR,{},{:.1f},T,-4.0,2.5,0.0,0.1,0.1,0.2,1,1", time, heading));
}

TEST(NmeaTrack, MakersSentencesAreOfTheirTimeWhereTheyComeFirst) {
    const Track track =
        track_of(pubx_00("120000.00", -3.5) + pashr("120000.000", 120.5) + rmc("120000.00") + gga("120000.00") +
                 pubx_00("120001.00", -1.5) + pashr("120001.000", 90) + rmc("120001.00") + gga("120001.00"));
    ASSERT_EQ(track.points.size(), 2u);
    const double climbs[] = {3.5, 1.5}, headings[] = {120.5, 90};
    for (std::size_t i = 0; i < 2; ++i) {
        ASSERT_TRUE(track.points[i].velocity && track.points[i].attitude) << i;
        const Eigen::Vector3d enu = LocalFrame(place_of(track, i)).to_enu(*track.points[i].velocity).vector();
        EXPECT_NEAR(enu.z(), climbs[i], 1e-6) << i;
        EXPECT_NEAR(track.points[i].attitude->yaw().deg(), headings[i], 1e-9) << i;
    }
}

TEST(NmeaTrack, AttitudesOfAFasterSensorMakeNoEpochs) {
    std::string log;
    for (const char* second : {"120000", "120001"}) {
        log += rmc(fmt::format("{}.00", second)) + gga(fmt::format("{}.00", second));
        for (int tenth = 1; tenth < 10; ++tenth)
            log += pashr(fmt::format("{}.{}00", second, tenth), 100 + tenth);
    }
    const Track track = track_of(log);
    ASSERT_EQ(track.points.size(), 2u);
    for (const TrackRow& row : track.points) {
        ASSERT_TRUE(row.attitude);
        EXPECT_NEAR(row.attitude->yaw().deg(), 101, 1e-9) << "the nearest";
    }
}

TEST(NmeaTrack, ReadsRmcAlone) {
    const Track track = track_of(rmc("120000.00") + rmc("120001.00"));
    ASSERT_EQ(track.points.size(), 2u);
    EXPECT_NEAR(place_of(track, 0).latitude.deg(), 47.5, 1e-9);
    EXPECT_THAT(track.notes, Contains("no height in the file; its 2 epochs are taken at sea level"));
}

TEST(NmeaTrack, CountsFromItsFirstMidnightWithoutADate) {
    const Track track = track_of(gga("235959.00") + gga("000000.00") + gga("130000.00"));
    EXPECT_FALSE(track.origin.has_value());
    ASSERT_EQ(track.points.size(), 3u);
    EXPECT_EQ(track.points[1].time - track.points[0].time, std::chrono::seconds(1));
    EXPECT_EQ(track.points[2].time - track.points[1].time, std::chrono::hours(13));
    EXPECT_THAT(track.notes, Contains(HasSubstr("no date in it (no RMC or ZDA)")));
}

TEST(NmeaTrack, DatesEpochsBeforeAndLongAfterADate) {
    const Track track = track_of(gga("100000.00") + gga("235959.00") + gga("000000.00") + rmc("000000.00", "060324") +
                                 gga("130000.00") + gga("230000.00") + gga("010000.00"));
    ASSERT_EQ(track.points.size(), 6u);
    EXPECT_EQ(utc_of(track, 0), "2024-03-05T10:00:00.000Z");
    EXPECT_EQ(utc_of(track, 2), "2024-03-06T00:00:00.000Z");
    EXPECT_EQ(utc_of(track, 4), "2024-03-06T23:00:00.000Z");
    EXPECT_EQ(utc_of(track, 5), "2024-03-07T01:00:00.000Z");
}

TEST(NmeaTrack, AMidnightOfARowWithoutAFixMovesNoDate) {
    const std::string none = nmea("GPGGA,000000.00,,,,,0,00,99.9,,M,,M,,");
    for (const std::string& date : {std::string(), rmc("140000.00")}) {
        const Track track = track_of(date + gga("140000.00") + none + gga("140001.00") + gga("140002.00"));
        ASSERT_EQ(track.points.size(), 3u);
        EXPECT_EQ(track.points[2].time - track.points[0].time, std::chrono::seconds(2)) << date;
    }
    // A clock that runs on through the midnight without a fix is believed.
    std::string night = gga("233000.00");
    for (const char* const time : {"235959.00", "000500.00", "005000.00"})
        night += nmea(fmt::format("GPGGA,{},,,,,0,00,99.9,,M,,M,,", time));
    const Track through = track_of(night + gga("013000.00"));
    ASSERT_EQ(through.points.size(), 2u);
    EXPECT_EQ(through.points[1].time - through.points[0].time, std::chrono::hours(2));
}

TEST(NmeaTrack, TakesTheGeoidWhereTheSeparationIsZeroEverywhere) {
    const Track zero = track_of(rmc("120000.00") + gga("120000.00", "500.0,M,0.0,M"));
    EXPECT_NEAR(height_of(zero, 0), 510, 1e-4);
    EXPECT_THAT(zero.notes, ElementsAre(HasSubstr("it is that of EGM96")));
    const Track mixed =
        track_of(rmc("120000.00") + gga("120000.00", "500.0,M,0.0,M") + gga("120001.00", "500.0,M,0.5,M"));
    EXPECT_NEAR(height_of(mixed, 0), 500, 1e-4);
}

TEST(NmeaTrack, TakesVoidPlacesOnlyWhereThereAreNoOthers) {
    const Track mixed = track_of(rmc("120000.00", "050324", ",", 'V') + rmc("120001.00"));
    EXPECT_EQ(mixed.points.size(), 1u);
    EXPECT_THAT(mixed.notes, Contains(HasSubstr("1 of 2 epochs are marked as without a fix")));
    const Track all = track_of(rmc("120000.00", "050324", ",", 'V'));
    EXPECT_EQ(all.points.size(), 1u);
    EXPECT_THAT(all.notes,
                Contains(HasSubstr("all 1 places are marked as without a fix; they are taken all the same")));
}

TEST(NmeaTrack, LeavesTheOrderOfTimeToTheCleaningOfTracks) {
    std::string ahead = rmc("120000.00") + rmc("140000.00"), boots;
    for (int i = 1; i < 9; ++i) {
        ahead += rmc(fmt::format("12000{}.00", i));
        boots += rmc(fmt::format("20000{}.00", i), "050324", ",", 'V');
    }
    Track track = track_of(ahead);
    EXPECT_EQ(track.points.size(), 10u);
    ASSERT_TRUE(clean_track(track, Seconds(10)).has_value());
    EXPECT_EQ(track.points.size(), 9u);
    EXPECT_THAT(track.notes, Contains(HasSubstr("1 rows have a time that ran ahead")));
    const Track later = track_of(boots + ahead);
    EXPECT_EQ(later.points.size(), 10u);
    EXPECT_EQ(utc_of(later, 0), "2024-03-05T12:00:00.000Z");
}

TEST(NmeaTrack, LeavesOutASinglePlaceThatCannotBe) {
    const Track track = track_of(rmc("120000.00") + gga("120000.00") + gga("120001.00", "-20000.0,M,48.0,M"));
    EXPECT_EQ(track.points.size(), 1u);
    EXPECT_THAT(track.notes, Contains(HasSubstr("1 of 2 epochs say a place or a speed that cannot be")));
}

TEST(NmeaTrack, RefusesALogWithoutPlaces) {
    EXPECT_THAT(refusal_of_track(nmea("GPGSA,A,1,,,,,,,,,,,,,,,")), HasSubstr("none of them with a solution"));
    EXPECT_THAT(refusal_of_track(nmea("GPRMC,120000.00,V,,,,,,,050324,,")), HasSubstr("1 of 1 epochs have no place"));
}

}  // namespace
}  // namespace skyloop
