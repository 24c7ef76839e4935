// IGC: dates, extensions, height datums, midnight and damage.
#include <gmock/gmock.h>

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

const std::string igc_head = "AXXX001\r\nHFDTE050324\r\nHFALGALTGPS:GEO\r\n";

TEST(IgcTrack, ReadsFixes) {
    const Track track =
        track_of(igc_head + "B1200004730000N00815000EA0048000500\r\nB1200013330500S07030250WA0048000501\r\n");
    ASSERT_EQ(track.points.size(), 2u);
    EXPECT_EQ(utc_of(track, 0), "2024-03-05T12:00:00.000Z");
    EXPECT_NEAR(place_of(track, 0).latitude.deg(), 47.5, 1e-9);
    EXPECT_NEAR(place_of(track, 0).longitude.deg(), 8.25, 1e-9);
    EXPECT_NEAR(place_of(track, 1).latitude.deg(), -(33 + 30.5 / 60), 1e-9);
    EXPECT_NEAR(place_of(track, 1).longitude.deg(), -(70 + 30.25 / 60), 1e-9);
    EXPECT_NEAR(height_of(track, 0), 510, 1e-4);
    EXPECT_TRUE(track.notes.empty());
}

TEST(IgcTrack, ReadsTheExtensionsOfTimeAndPlace) {
    const Track track =
        track_of(igc_head + "I043638FXA3940TDS4142LAD4344LOD\r\nB1200004730000N00815000EA0048000500012251234\r\n");
    ASSERT_EQ(track.points.size(), 1u);
    EXPECT_EQ(utc_of(track, 0), "2024-03-05T12:00:00.250Z");
    EXPECT_NEAR(place_of(track, 0).latitude.deg(), 47 + 30.00012 / 60, 1e-9);
    EXPECT_NEAR(place_of(track, 0).longitude.deg(), 8 + 15.00034 / 60, 1e-9);
}

TEST(IgcTrack, CountsOnOverMidnightAndTakesBothFormsOfTheDate) {
    const Track track = track_of(
        "AXXX001\nHFDTEDATE:311223,01\nHFALG:GEO\nB2359594730000N00815000EA0048000500\n"
        "B0000004730000N00815000EA0048000500\n");
    EXPECT_EQ(utc_of(track, 0), "2023-12-31T23:59:59.000Z");
    EXPECT_EQ(utc_of(track, 1), "2024-01-01T00:00:00.000Z");
}

TEST(IgcTrack, ADayWithALeapSecondIsLonger) {
    const std::string place = "4730000N00815000EA0048000500\n";
    const Track track =
        track_of("HFDTE311216\nHFALG:GEO\nB235959" + place + "B235960" + place + "B000000" + place + "B000001" + place);
    ASSERT_EQ(track.points.size(), 4u);
    EXPECT_EQ(utc_of(track, 1), "2016-12-31T23:59:60.000Z");
    EXPECT_EQ(utc_of(track, 2), "2017-01-01T00:00:00.000Z");
    EXPECT_EQ(track.points[3].time - track.points[0].time, std::chrono::seconds(3));
}

TEST(IgcTrack, WhatIsLeftOutMovesNoDate) {
    const std::string place = "4730000N00815000EA0048000500\n";
    const Track track = track_of(igc_head + "B140000" + place + "B0000000000000N00000000EV0000000000\n" +
                                 "B0000000000000N00000000EA0000000000\n" + "B140001" + place);
    ASSERT_EQ(track.points.size(), 2u);
    EXPECT_EQ(utc_of(track, 1), "2024-03-05T14:00:01.000Z");
}

TEST(IgcTrack, ADateThatIsSaidAgainBehindMidnightIsThatOfTheFirstDay) {
    const std::string place = "4730000N00815000EA0048000500\n";
    const Track track = track_of(igc_head + "B235959" + place + "HFDTE050324\nB000000" + place);
    EXPECT_EQ(utc_of(track, 1), "2024-03-06T00:00:00.000Z");
    const Track next = track_of(igc_head + "B235959" + place + "HFDTE060324\nB000000" + place);
    EXPECT_EQ(utc_of(next, 1), "2024-03-06T00:00:00.000Z");
}

TEST(IgcTrack, ATimeThatFallsALittleIsOfTheSameDay) {
    const std::string place = "4730000N00815000EA0048000500\n";
    const Track track = track_of(igc_head + "B140005" + place + "B140003" + place + "B020003" + place);
    EXPECT_EQ(utc_of(track, 1), "2024-03-05T14:00:03.000Z");
    EXPECT_EQ(utc_of(track, 2), "2024-03-05T02:00:03.000Z") << "twelve hours are no midnight yet";
}

TEST(IgcTrack, YearsFrom80OnAreOfTheCenturyBefore) {
    const std::string fix = "B1400004730000N00815000EA0048000500\n";
    EXPECT_EQ(utc_of(track_of("HFDTE050379\nHFALG:GEO\n" + fix), 0), "2079-03-05T14:00:00.000Z");
    EXPECT_EQ(utc_of(track_of("HFDTE050380\nHFALG:GEO\n" + fix), 0), "1980-03-05T14:00:00.000Z");
}

TEST(IgcTrack, TakesHeightsByTheHeader) {
    const std::string fixes = "B1200004730000N00815000EA0048000500\n";
    EXPECT_NEAR(height_of(track_of("HFDTE050324\nHFALGALTGPS:ELL\n" + fixes), 0), 500, 1e-4);
    const Track untold = track_of("HFDTE050324\n" + fixes);
    EXPECT_NEAR(height_of(untold, 0), 510, 1e-4);
    EXPECT_THAT(untold.notes, ElementsAre(HasSubstr("no HFALG record says what the altitudes are above")));
    const Track pressure = track_of(igc_head + "B1200004730000N00815000EA-012000000\n");
    EXPECT_NEAR(height_of(pressure, 0), -110, 1e-4);
    EXPECT_THAT(pressure.notes, ElementsAre(HasSubstr("no GNSS altitudes; the pressure altitudes")));
}

TEST(IgcTrack, LeavesOutWhatHasNoFixOrIsDamaged) {
    const Track track =
        track_of(igc_head +
                 "B1200004730000N00815000EV0048000500\nB1200014730000N00815000EA0048000500\n"
                 "B1200024760000N00815000EA0048000500\nB2500024730000N00815000EA0048000500\nB120003473\n");
    EXPECT_EQ(track.points.size(), 1u);
    EXPECT_THAT(track.notes, Contains(HasSubstr("1 of 5 fixes are marked V")));
    EXPECT_THAT(track.notes, Contains(HasSubstr("3 of 5 fixes are damaged (first in line 6)")));
    const Track all = track_of(igc_head + "B1200004730000N00815000EV0048000500\n");
    EXPECT_EQ(all.points.size(), 1u);
    EXPECT_THAT(all.notes, Contains(HasSubstr("all fixes are marked V")));
}

TEST(IgcTrack, CountsFromMidnightWithoutADateAndRefusesAFileWithoutFixes) {
    const Track track = track_of("AXXX001\nHFALG:GEO\nB1200004730000N00815000EA0048000500\n");
    EXPECT_FALSE(track.origin.has_value());
    EXPECT_EQ(track.points.at(0).time, std::chrono::hours(12));
    EXPECT_THAT(refusal_of_track("HFDTE050324\n"), HasSubstr("no fixes in it; expected B records"));
    EXPECT_THAT(refusal_of_track("HFDTE050324\nB12\n"), HasSubstr("1 of 1 fixes are damaged (first in line 2)"));
}

}  // namespace
}  // namespace skyloop
