// GPX 1.0 and 1.1, as recorders write it and as they should not.
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
using testing::ElementsAre;
using testing::HasSubstr;

std::string gpx(std::string_view points, std::string_view version = "1.1") {
    return "<?xml version='1.0'?><gpx version='" + std::string(version) + "'><trk><trkseg>\n" + std::string(points) +
           "</trkseg></trk></gpx>";
}

std::string point(std::string_view inside, double longitude = 8) {
    return "<trkpt lat='47' lon='" + std::to_string(longitude) + "'>" + std::string(inside) + "</trkpt>\n";
}

TEST(GpxTrack, ReadsPlacesTimesAndHeightsAboveTheSea) {
    const Track track = track_of(gpx(point("<ele>500</ele><time>2024-03-05T12:00:00Z</time>") +
                                     point("<ele>501</ele><time>2024-03-05T12:00:01.25Z</time>", 8.0001)));
    ASSERT_EQ(track.points.size(), 2u);
    EXPECT_EQ(track.format, "GPX 1.1");
    EXPECT_EQ(utc_of(track, 1), "2024-03-05T12:00:01.250Z");
    EXPECT_NEAR(place_of(track, 1).longitude.deg(), 8.0001, 1e-9);
    EXPECT_NEAR(height_of(track, 0), 510, 1e-4);  // the geoid stands 10 m above the ellipsoid
    EXPECT_EQ(track.points[1].line, 3u);
    EXPECT_TRUE(track.notes.empty());
}

TEST(GpxTrack, TakesTheUndulationOfTheFile) {
    const Track track =
        track_of(gpx(point("<ele>500</ele><geoidheight>48.5</geoidheight><time>2024-03-05T12:00:00Z</time>")));
    EXPECT_NEAR(height_of(track, 0), 548.5, 1e-4);
}

TEST(GpxTrack, ReadsTimesOfEveryZoneAndFraction) {
    const Track track = track_of(gpx(point("<ele>1</ele><time>2024-03-05T00:30:00+01:00</time>") +
                                     point("<ele>1</ele><time>2024-03-04T18:30:01-0500</time>") +
                                     point("<ele>1</ele><time>2024-03-04T23:30:02.123456789Z</time>") +
                                     point("<ele>1</ele><time>2024-03-04 23:30:03</time>")));
    EXPECT_EQ(utc_of(track, 0), "2024-03-04T23:30:00.000Z");
    EXPECT_EQ(utc_of(track, 1), "2024-03-04T23:30:01.000Z");
    EXPECT_EQ((track.points[2].time - track.points[0].time).count(), 2'123'456'789);
    EXPECT_EQ(utc_of(track, 3), "2024-03-04T23:30:03.000Z");
    EXPECT_THAT(track.notes, ElementsAre("1 times say no zone and are taken as UTC"));
}

TEST(GpxTrack, CountsALeapSecond) {
    const Track track = track_of(gpx(point("<ele>1</ele><time>2016-12-31T23:59:59Z</time>") +
                                     point("<ele>1</ele><time>2017-01-01T00:59:60+01:00</time>") +
                                     point("<ele>1</ele><time>2017-01-01T00:00:00Z</time>")));
    EXPECT_EQ(track.points[1].time - track.points[0].time, std::chrono::seconds(1));
    EXPECT_EQ(track.points[2].time - track.points[0].time, std::chrono::seconds(2));
}

TEST(GpxTrack, ReadsSpeedAndCourseDirectlyAndInExtensionsOfAnyPrefix) {
    const std::string direct = "<ele>%</ele><time>2024-03-05T12:00:0@Z</time><speed>10</speed><course>90</course>";
    const std::string extension =
        "<ele>%</ele><time>2024-03-05T12:00:0@Z</time><extensions><q:TrackPointExtension><q:speed>10</q:speed>"
        "<q:course>90</q:course></q:TrackPointExtension></extensions>";
    for (const std::string& form : {direct, extension}) {
        std::string points;
        for (const char second : {'0', '1', '2'}) {
            std::string one = form;
            one.replace(one.find('%'), 1, std::string("10") + second);  // climbs by 1 m/s
            one.replace(one.find('@'), 1, std::string(1, second));
            points += point(one, 8 + 0.00013151 * (second - '0'));
        }
        const Track track = track_of(gpx(points, "1.0"));
        ASSERT_TRUE(track.points.at(1).velocity.has_value());
        const Eigen::Vector3d enu = LocalFrame(place_of(track, 1)).to_enu(*track.points[1].velocity).vector();
        EXPECT_LT((enu - Eigen::Vector3d(10, 0, 1)).norm(), 1e-6);
    }
}

TEST(GpxTrack, DoesNotUseSpeedsInAnotherUnit) {
    std::string points;
    for (int i = 0; i < 10; ++i)  // 10 m/s, told as 36
        points += point(
            "<ele>1</ele><time>2024-03-05T12:00:0" + std::to_string(i) + "Z</time><speed>36</speed><course>90</course>",
            8 + 0.00013151 * i);
    const Track track = track_of(gpx(points, "1.0"));
    EXPECT_FALSE(track.points.at(5).velocity.has_value());
    EXPECT_THAT(track.notes, ElementsAre(HasSubstr("the speeds are 3.6 times those of the places and are not used")));
}

TEST(GpxTrack, BeginsAnewWithEachSegmentAndOrdersTracksByTime) {
    const auto at = [](int minute) {
        return point("<ele>1</ele><time>2024-03-05T12:0" + std::to_string(minute) + ":00Z</time>");
    };
    const Track track = track_of("<gpx><trk><trkseg>" + at(4) + at(5) + "</trkseg><trkseg/><trkseg>" + at(6) +
                                 "</trkseg></trk><trk><trkseg>" + at(1) + at(2) + "</trkseg></trk></gpx>");
    ASSERT_EQ(track.points.size(), 5u);
    std::vector<bool> jumps;
    for (const TrackRow& row : track.points)
        jumps.push_back(row.jump);
    EXPECT_THAT(jumps, ElementsAre(false, false, true, false, true));
    EXPECT_EQ(utc_of(track, 0), "2024-03-05T12:01:00.000Z");
}

TEST(GpxTrack, KeepsTheLongerOfTracksThatOverlap) {
    const auto at = [](int second) {
        return point("<ele>1</ele><time>2024-03-05T12:00:0" + std::to_string(second) + "Z</time>");
    };
    const Track track = track_of("<gpx><trk><name>PRES\nALT</name><trkseg>" + at(1) + at(2) +
                                 "</trkseg></trk><trk><trkseg>" + at(1) + at(2) + at(3) + "</trkseg></trk></gpx>");
    EXPECT_EQ(track.points.size(), 3u);
    EXPECT_THAT(track.notes, ElementsAre("the track 'PRES ALT' of 2 track points overlaps a longer one of the file in "
                                         "time and was left out"));
}

TEST(GpxTrack, JoinsTracksThatTouchInTime) {
    const auto at = [](int second) {
        return point("<ele>1</ele><time>2024-03-05T12:00:0" + std::to_string(second) + "Z</time>");
    };
    const Track track = track_of("<gpx><trk><trkseg>" + at(1) + at(2) + "</trkseg></trk><trk><trkseg>" + at(2) + at(3) +
                                 "</trkseg></trk><trk><trkseg>" + at(3) + "</trkseg></trk></gpx>");
    EXPECT_EQ(track.points.size(), 5u);
    EXPECT_TRUE(track.notes.empty());
}

TEST(GpxTrack, TakesMinusOneForAnUnknownSpeedAndCourse) {
    const Track track =
        track_of(gpx(point("<ele>1</ele><time>2024-03-05T12:00:00Z</time><speed>-1</speed><course>-1</course>") +
                     point("<ele>1</ele><time>2024-03-05T12:00:01Z</time><speed>0</speed><course>20</course>")));
    EXPECT_FALSE(track.points.at(0).velocity.has_value());
    EXPECT_TRUE(track.points.at(1).velocity.has_value());
}

TEST(GpxTrack, FillsMissingHeightsAndLeavesOutPointsWithoutTime) {
    const Track track = track_of(
        gpx(point("<ele>100</ele><time>2024-03-05T12:00:00Z</time>") + point("<ele>7</ele>") +
            point("<time>2024-03-05T12:00:01Z</time>") + point("<ele/><time>2024-03-05T12:00:03Z</time>") +
            point("<ele>104</ele><time>2024-03-05T12:00:04Z</time>") + point("<time>2024-03-05T12:00:05Z</time>")));
    ASSERT_EQ(track.points.size(), 5u);
    EXPECT_NEAR(height_of(track, 1), 111, 1e-4);
    EXPECT_NEAR(height_of(track, 2), 113, 1e-4);
    EXPECT_NEAR(height_of(track, 4), 114, 1e-4);
    EXPECT_THAT(track.notes,
                ElementsAre("1 of 6 track points have no time (first in line 3) and were left out",
                            "3 of 5 track points have no height; it is taken from those before and after"));
    const Track flat = track_of(gpx(point("<time>2024-03-05T12:00:00Z</time>")));
    EXPECT_NEAR(height_of(flat, 0), 10, 1e-4);
    EXPECT_THAT(flat.notes, ElementsAre("no height in the file; its 1 track points are taken at sea level"));
}

TEST(GpxTrack, LeavesOutPlacesAtZero) {
    const Track track = track_of(gpx(point("<ele>1</ele><time>2024-03-05T12:00:00Z</time>") +
                                     "<trkpt lat='0' lon='0.0'><ele>1</ele><time>2024-03-05T12:00:01Z</time></trkpt>"));
    EXPECT_EQ(track.points.size(), 1u);
    EXPECT_THAT(track.notes, ElementsAre(HasSubstr("1 of 2 track points are at latitude 0, longitude 0")));
}

TEST(GpxTrack, PlacesWithoutTimesAreARoute) {
    const Track route = track_of(
        "<gpx><wpt lat='1' lon='2'/><rte><rtept lat='9' lon='9'/></rte><rte><name>long</name><rtept lat='1' lon='2'>"
        "<ele>10</ele></rtept><rtept lat='1' lon='2.1'/><rtept lat='1' lon='2.2'><ele>30</ele></rtept></rte></gpx>");
    ASSERT_EQ(route.points.size(), 3u);
    EXPECT_NEAR(place_of(route, 2).longitude.deg(), 2.2, 1e-9);
    EXPECT_NEAR(height_of(route, 1), 30, 1e-4);
    ASSERT_TRUE(route.route.has_value());
    EXPECT_EQ(route.route->why, "no times in it");
    EXPECT_FALSE(route.origin.has_value());
    EXPECT_THAT(route.notes, ElementsAre("of its 2 routes the one with most points is taken, 'long'",
                                         "its 1 waypoints are not part of the path", HasSubstr("1 of 3 track points")));
    const Track places = track_of("<gpx><wpt lat='1' lon='2'/><wpt lat='1' lon='3'/></gpx>");
    EXPECT_EQ(places.points.size(), 2u);
    EXPECT_EQ(places.notes.at(0), "its 2 waypoints are taken as a route, in the order of the file");
    EXPECT_EQ(track_of(gpx(point("") + point(""))).route->why, "no times in it");
    const std::string old = "<time>1901-12-13T20:45:52Z</time>", odd = "<time>1901-12-13T20:45:53Z</time>";
    EXPECT_EQ(track_of(gpx(point(old) + point(old) + point(odd))).route->why,
              "2 of 3 times are equal: the file's times are not used");
    const std::string now = "<time>2024-03-05T12:00:00Z</time>";
    EXPECT_EQ(track_of(gpx(point(now) + point("") + point(""))).route->why, "only 1 of 3 track points have a time");
}

// Times in range that are all one, and one of which that is another.
TEST(GpxTrack, EqualTimesAreNotUsed) {
    std::string points;
    for (int i = 0; i < 40; ++i)
        points += "<trkpt lat='" + std::to_string(10 + i) + "' lon='8'><ele>1</ele><time>2024-03-05T12:00:0" +
                  (i == 7 ? "1" : "0") + "Z</time></trkpt>";
    const Track track = track_of(gpx(points));
    ASSERT_TRUE(track.route.has_value());
    EXPECT_EQ(track.route->why, "39 of 40 times are equal: the file's times are not used");
    EXPECT_EQ(track.points.size(), 40u);
}

TEST(GpxTrack, RefusesWhatIsNoTrackInOneLine) {
    EXPECT_THAT(refusal_of_track("<gpx></gpx>"),
                HasSubstr("no track points in it; expected <trkpt>, <rtept> or <wpt>"));
    EXPECT_THAT(refusal_of_track(gpx("<trkpt lat='47,5' lon='8'><time>2024-03-05T12:00:00Z</time></trkpt>")),
                HasSubstr("t.txt:2: lat is '47,5'; expected degrees with a decimal point"));
    EXPECT_THAT(refusal_of_track(gpx("<trkpt lat='nan' lon='8'><time>2024-03-05T12:00:00Z</time></trkpt>")),
                HasSubstr("lat is 'nan'"));
    EXPECT_THAT(refusal_of_track(gpx("<trkpt lat='95' lon='8'><time>2024-03-05T12:00:00Z</time></trkpt>")),
                HasSubstr("t.txt:2: latitude is 95"));
    EXPECT_THAT(refusal_of_track(gpx(point("<time>noon\n</time>"))), HasSubstr("t.txt:2: the time is 'noon'"));
    EXPECT_THAT(refusal_of_track(gpx(point("<ele>high</ele><time>2024-03-05T12:00:00Z</time>"))),
                HasSubstr("t.txt:2: ele is 'high'"));
    EXPECT_THAT(refusal_of_track("<gpx><trk>"), HasSubstr("no whole XML"));
    EXPECT_THAT(refusal_of_track("<html></html>"), HasSubstr("XML whose root is <html>; expected <gpx> or <kml>"));
    const auto without_geoid =
        read_track(test::bytes_of(gpx(point("<ele>1</ele><time>2024-03-05T12:00:00Z</time>"))), "t.gpx", {});
    ASSERT_FALSE(without_geoid.has_value());
    EXPECT_THAT(without_geoid.error().message, HasSubstr("heights above sea level need the geoid"));
}

TEST(GpxTrack, IsReadInUtf16ByItsEnding) {
    std::string wide = "\xFF\xFE";
    for (const char letter : gpx(point("<ele>1</ele><time>2024-03-05T12:00:00Z</time>")))
        wide += std::string{letter, '\0'};
    const Track track = track_of(wide, "Walk.GPX");
    ASSERT_EQ(track.points.size(), 1u);
    EXPECT_EQ(track.points[0].line, 0u);  // lines are those of UTF-8 alone
}

TEST(GpxTrack, SurvivesElementsOfAnyDepth) {
    std::string deep;
    for (int i = 0; i < 200'000; ++i)
        deep += "<a>";
    for (int i = 0; i < 200'000; ++i)
        deep += "</a>";
    const Track track =
        track_of(gpx(point("<ele>1</ele><time>2024-03-05T12:00:00Z</time><extensions>" + deep + "</extensions>")));
    EXPECT_EQ(track.points.size(), 1u);
}

}  // namespace
}  // namespace skyloop
