// KML and KMZ: the forms that have times, and those that have none.
#include <gmock/gmock.h>

#include "stored_zip.hpp"
#include "support/packed.hpp"
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

std::string kml(std::string_view inside) {
    return "<kml xmlns:gx='http://www.google.com/kml/ext/2.2'><Document><Placemark>" + std::string(inside) +
           "</Placemark></Document></kml>";
}

constexpr std::string_view absolute = "<altitudeMode>absolute</altitudeMode>";
const std::string two_whens = "<when>2024-03-05T12:00:00Z</when><when>2024-03-05T12:00:01Z</when>";

TEST(KmlTrack, PairsTimesAndPlacesByTheirOrder) {
    const std::string grouped = kml("<gx:Track>" + std::string(absolute) + two_whens +
                                    "<gx:coord>8 47 500</gx:coord><gx:coord>8.1 47.1 501</gx:coord></gx:Track>");
    const std::string interleaved =
        kml("<gx:Track>" + std::string(absolute) +
            "<when>2024-03-05T12:00:00Z</when><gx:coord>8 47 500</gx:coord>"
            "<when>2024-03-05T12:00:01Z</when><gx:coord>8.1 47.1 501</gx:coord></gx:Track>");
    for (const std::string& text : {grouped, interleaved}) {
        const Track track = track_of(text);
        ASSERT_EQ(track.points.size(), 2u);
        EXPECT_EQ(utc_of(track, 1), "2024-03-05T12:00:01.000Z");
        EXPECT_NEAR(place_of(track, 1).latitude.deg(), 47.1, 1e-9);
        EXPECT_NEAR(place_of(track, 1).longitude.deg(), 8.1, 1e-9);
        EXPECT_NEAR(height_of(track, 1), 511, 1e-4);
        EXPECT_TRUE(track.notes.empty());
    }
}

TEST(KmlTrack, LeavesOutEmptyPlaces) {
    const Track track = track_of(kml("<gx:Track>" + std::string(absolute) + two_whens +
                                     "<gx:coord/><gx:coord>8.1 47.1 501</gx:coord></gx:Track>"));
    ASSERT_EQ(track.points.size(), 1u);
    EXPECT_EQ(utc_of(track, 0), "2024-03-05T12:00:01.000Z");
    EXPECT_THAT(track.notes, ElementsAre(HasSubstr("1 of 2 points have no place")));
}

TEST(KmlTrack, BeginsAnewWithEachTrackOfAMultiTrackThatIsNotJoined) {
    const auto part = [](int minute) {
        return "<gx:Track><when>2024-03-05T12:0" + std::to_string(minute) +
               ":00Z</when><gx:coord>8 47 500</gx:coord></gx:Track>";
    };
    for (const bool joined : {false, true}) {
        const Track track =
            track_of(kml("<gx:MultiTrack><altitudeMode>absolute</altitudeMode><gx:interpolate>" +
                         std::to_string(joined) + "</gx:interpolate>" + part(1) + part(2) + "</gx:MultiTrack>"));
        ASSERT_EQ(track.points.size(), 2u);
        EXPECT_EQ(track.points[1].jump, !joined);
    }
}

TEST(KmlTrack, ReadsPlacemarksOfOnePointEach) {
    const Track track = track_of(
        "<kml><Placemark><TimeStamp><when>2024-03-05T12:00:00Z</when></TimeStamp><Point><altitudeMode>absolute"
        "</altitudeMode><coordinates> 8,47,500 </coordinates></Point></Placemark><Placemark><TimeStamp><when>"
        "2024-03-05T12:00:01Z</when></TimeStamp><Point><altitudeMode>absolute</altitudeMode><coordinates>8,47.1,500"
        "</coordinates></Point></Placemark></kml>");
    ASSERT_EQ(track.points.size(), 2u);
    EXPECT_NEAR(place_of(track, 1).latitude.deg(), 47.1, 1e-9);
}

TEST(KmlTrack, ADateIsItsMidnightAndSecondsMayBeAbsent) {
    const Track track = track_of(kml("<gx:Track>" + std::string(absolute) +
                                     "<when>2024-03-05</when><when>2024-03-06T12:00Z</when><gx:coord>8 47 "
                                     "1</gx:coord><gx:coord>8 47.1 1</gx:coord></gx:Track>"));
    ASSERT_EQ(track.points.size(), 2u);
    EXPECT_EQ(utc_of(track, 0), "2024-03-05T00:00:00.000Z");
    EXPECT_EQ(utc_of(track, 1), "2024-03-06T12:00:00.000Z");
    EXPECT_THAT(track.notes, testing::Contains("1 times are dates alone and are taken as their midnight, UTC"));
}

TEST(KmlTrack, TellsWhatAltitudesMean) {
    const std::string rows = two_whens + "<gx:coord>8 47 20</gx:coord><gx:coord>8 47 20</gx:coord></gx:Track>";
    EXPECT_THAT(track_of(kml("<gx:Track>" + rows)).notes, ElementsAre(HasSubstr("altitudeMode is clampToGround")));
    const std::string above_ground = kml("<gx:Track><altitudeMode>relativeToGround</altitudeMode>" + rows);
    EXPECT_THAT(refusal_of_track(above_ground), HasSubstr("above the ground (altitudeMode relativeToGround)"));
    const Track placed = track_of(above_ground, "t.kml", Geodetic::degrees(47, 8, 500));
    EXPECT_NEAR(height_of(placed, 0), 520, 1e-4);
    const Track angles = track_of(kml("<gx:Track>" + std::string(absolute) +
                                      "<when>2024-03-05T12:00:00Z</when><gx:coord>8 47 1</gx:coord>"
                                      "<gx:angles>90 0 0</gx:angles></gx:Track>"));
    EXPECT_FALSE(angles.points.at(0).attitude.has_value());
    EXPECT_THAT(angles.notes, ElementsAre(HasSubstr("gx:angles are not read")));
}

TEST(KmlTrack, PlacesWithoutTimesAreARoute) {
    const Track line =
        track_of(kml("<LineString><coordinates>1,1</coordinates></LineString><LineString>" + std::string(absolute) +
                     "<coordinates>\n+8.1,47,5\n<!-- -->8.2,48,6</coordinates></LineString>"));
    ASSERT_EQ(line.points.size(), 2u);
    EXPECT_NEAR(place_of(line, 1).longitude.deg(), 8.2, 1e-9);
    EXPECT_NEAR(height_of(line, 1), 16, 1e-4);
    EXPECT_EQ(line.route->why, "no times in it");
    EXPECT_THAT(line.notes, ElementsAre("of its 2 LineStrings the longest is taken"));
    const Track points = track_of(kml("<Point><coordinates>8,47</coordinates></Point>"));
    EXPECT_EQ(points.points.size(), 1u);
    EXPECT_THAT(points.notes, testing::Contains("its points are taken as a route, in the order of the file"));
    EXPECT_THAT(refusal_of_track(kml("<LineString><coordinates>8,47 8</coordinates></LineString>")),
                HasSubstr("the place is '8'; expected longitude and latitude"));
}

TEST(KmlTrack, RefusesWhatHasNoPlaces) {
    EXPECT_THAT(refusal_of_track(kml("")), HasSubstr("1 placemarks and no place in them"));
    EXPECT_THAT(refusal_of_track(kml("<gx:Track>\n" + two_whens + "<gx:coord>8 47 1</gx:coord></gx:Track>")),
                HasSubstr("t.txt:1: a gx:Track with 2 <when> and 1 <gx:coord>"));
    EXPECT_THAT(refusal_of_track(kml("<gx:Track><when>2024</when><gx:coord>8 47 1</gx:coord></gx:Track>")),
                HasSubstr("<when> is '2024'"));
    EXPECT_THAT(
        refusal_of_track(kml("<gx:Track><when>2024-03-05T12:00:00Z</when><gx:coord>8,47,1</gx:coord></gx:Track>")),
        HasSubstr("the place is '8,47,1'; expected longitude, latitude and altitude"));
}

TEST(KmzTrack, IsUnpacked) {
    const std::string inside = kml("<gx:Track>" + std::string(absolute) + two_whens +
                                   "<gx:coord>8 47 500</gx:coord><gx:coord>8.1 47.1 501</gx:coord></gx:Track>");
    const Track track = track_of(test::stored_zip("files/track.kml", inside), "t.kmz");
    EXPECT_EQ(track.points.size(), 2u);
    EXPECT_EQ(track.format, "KMZ");
    EXPECT_THAT(refusal_of_track(test::stored_zip("a\nb.kml", kml("")), "t.kmz"),
                HasSubstr("t.kmz/a b.kml: 1 placemarks and no place in them"));
    const auto chosen = [](const char* other) {
        return refusal_of_track(test::archive_of("zip", {{"z.kml", kml("")}, {other, kml("")}}), "t.kmz");
    };
    EXPECT_THAT(chosen("a.kml"), HasSubstr("t.kmz/z.kml: ")) << "the first";
    EXPECT_THAT(chosen("Doc.kml"), HasSubstr("t.kmz/Doc.kml: "));
}

TEST(KmzTrack, RefusesArchivesWithoutKmlAndBrokenOnes) {
    const std::string whole = test::stored_zip("picture.png", "x");
    EXPECT_THAT(refusal_of_track(whole, "t.kmz"), HasSubstr("a zip archive without a .kml in it"));
    EXPECT_THAT(refusal_of_track(whole.substr(0, 40), "t.kmz"), HasSubstr("no whole zip archive"));
    std::string damaged = test::stored_zip("doc.kml", kml(""));
    damaged[60] = static_cast<char>(damaged[60] ^ 1);
    EXPECT_THAT(refusal_of_track(damaged, "t.kmz"),
                HasSubstr("t.kmz:doc.kml: cannot be unpacked; expected a whole file ("));
}

TEST(KmzTrack, IsUnpackedToABound) {
    const std::string bomb = test::stored_zip("doc.kml", std::string(std::size_t{65} << 20, ' '), false);
    EXPECT_THAT(refusal_of_track(bomb, "t.kmz").substr(0, 200), HasSubstr("unpacks to more than 67108864 bytes"));
}

TEST(KmlTrack, TimeSpansCountByTheirBegin) {
    std::string text = "<kml>";
    for (const char* const time : {"12:00:00", "12:00:01"})
        text += std::string("<Placemark><TimeSpan><begin>2024-03-05T") + time +
                "Z</begin><end>2024-03-05T12:00:09Z</end></TimeSpan><Point><altitudeMode>absolute</altitudeMode>"
                "<coordinates>8,47,500</coordinates></Point></Placemark>";
    const Track track = track_of(text + "</kml>");
    ASSERT_EQ(track.points.size(), 2u);
    EXPECT_FALSE(track.route.has_value());
    EXPECT_EQ(utc_of(track, 1), "2024-03-05T12:00:01.000Z");
}

}  // namespace
}  // namespace skyloop
