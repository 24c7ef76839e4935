// Logs of UBX as tracks: what gives their epochs a time.
#include <gmock/gmock.h>

#include "receiver/protocol/ubx_nav.hpp"
#include "receiver/protocol/ubx_time.hpp"
#include "track_reading.hpp"

namespace skyloop {
namespace {

using test::track_of;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr std::uint32_t week_ms = 604'800'000;

std::string posllh(std::uint32_t i_tow) {
    return to_string(encode_frame(NavPosllh{.i_tow = i_tow, .lon = 82500000, .lat = 475000000, .height = 548000}));
}

TEST(UbxTrack, CountsFromItsFirstWeekWhereNoneIsTold) {
    const Track track = track_of(posllh(week_ms - 1000) + posllh(0) + posllh(1000));
    EXPECT_FALSE(track.origin.has_value());
    ASSERT_EQ(track.points.size(), 3u);
    EXPECT_EQ(track.points[0].time, std::chrono::milliseconds(week_ms - 1000));
    EXPECT_EQ(track.points[2].time - track.points[0].time, std::chrono::seconds(2));
    EXPECT_THAT(track.notes, ElementsAre(HasSubstr("no week in it")));
}

TEST(UbxTrack, EpochsBeforeTheWeekIsToldAreDatedByIt) {
    const NavTimegps time{.i_tow = 1000, .week = 2304, .valid = 3};
    const Track track =
        track_of(posllh(week_ms - 1000) + posllh(0) + posllh(1000) + to_string(encode_frame(time)) + posllh(2000));
    ASSERT_EQ(track.points.size(), 4u);
    ASSERT_TRUE(track.origin.has_value());
    EXPECT_EQ(*track.origin + track.points[0].time, to_gps_time(2303, week_ms * 1e-3 - 1));
    EXPECT_EQ(*track.origin + track.points[1].time, to_gps_time(2304, 0));
    EXPECT_EQ(*track.origin + track.points[3].time, to_gps_time(2304, 2.0));
    EXPECT_TRUE(track.notes.empty());
}

TEST(UbxTrack, SentencesWithADateAreTakenBeforeMessagesWithoutAWeek) {
    const std::string sentences =
        "$GPRMC,120000.00,A,4730.0000,N,00815.0000,E,0.0,,050324,,*12\r\n"
        "$GPGGA,120000.00,4730.0000,N,00815.0000,E,1,10,0.8,500.0,M,48.0,M,,*63\r\n";
    const Track track = track_of(posllh(216018000) + sentences + posllh(216019000));
    EXPECT_EQ(track.format, "NMEA");
    EXPECT_EQ(test::utc_of(track, 0), "2024-03-05T12:00:00.000Z");
}

}  // namespace
}  // namespace skyloop
