// Files of every format cut at every offset, with flipped bits and exchanged pieces: one clear line or sound rows.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "stored_zip.hpp"
#include "track_reading.hpp"

namespace skyloop {
namespace {

const std::string damaged_kml =
    "<kml><Placemark><gx:Track><altitudeMode>absolute</altitudeMode><when>2024-03-05T12:00:00Z</when>"
    "<gx:coord>8 47 500</gx:coord><when>2024-03-05T12:00:01Z</when><gx:coord>8 47 501</gx:coord></gx:Track>"
    "</Placemark></kml>";

// One small file of each format.
const std::vector<std::pair<std::string, std::string>>& whole_files() {
    static const std::vector<std::pair<std::string, std::string>> files{
        {"t.gpx",
         "<?xml version='1.0'?><gpx version='1.0'><trk><name>a</name><trkseg><trkpt lat='47' lon='8'><ele>500</ele>"
         "<time>2024-03-05T12:00:00Z</time><speed>1</speed><course>90</course></trkpt><trkpt lat='47' lon='8'>"
         "<ele>501</ele><time>2024-03-05T13:00:01.5+01:00</time></trkpt></trkseg></trk></gpx>"},
        {"t.kml", damaged_kml},
        {"t.kmz", test::stored_zip("doc.kml", damaged_kml)},
        {"t.igc",
         "AXXX\nHFDTE050324\nHFALG:GEO\nI013638TDS\nB2359594730000N00815000EA0048000500123\n"
         "B0000004730000N00815000EA0048000500123\n"},
        {"t.nmea",
         "$GPGGA,120000.00,4730.0000,N,00815.0000,E,1,10,0.8,500.0,M,48.0,M,,*63\r\n"
         "$GPRMC,120000.00,A,4730.0000,N,00815.0000,E,19.4,090.0,050324,,*09\r\n"},
        {"t.csv", "t_s,lat_deg,lon_deg,h_ell_m,speed_kmh,course_deg\n0,47,8,500,36,90\n1,47,8.0001,500,36,90\n"},
        {"t.csv", "0.0,47.5,8.25,500\n0.1,47.6,8.25,501\n"},
        {"t.pos",
         "%  GPST  latitude(deg) longitude(deg)  height(m)\n2024/03/05 12:00:18.000 47.5 8.25 500 1 8 0 0\n"
         "2304 216019.0 47.5 8.25 500 1 8 0 0 0 0 0 0 0 0 1 2 3\n"},
        {"t.txt", "1709640000.1 1 2 3 0 0 0 1\n1709640001.1 1 2 4 0 0 0 1\n"},
        {"t.csv", "#timestamp [ns], x, y, z\n1709640000123456789,1,2,3,1\n1709640001123456789,1,2,3,1\n"},
        {"t.txt", "1709640000 2304 216018 47 30 00.0 8 15 00.0 500 0.5 10 0.25 0 0 0 0 0 90 1\n"},
        {"t.csv", "No,Latitude,Longitude,Altitude,Speed,Course,Date,Time\n1,47,8,500,1,90,2024/03/05,12:00:00\n"},
        {"t.txt",
         "# Fix,Provider,Latitude,Longitude,Altitude,Speed,Accuracy,(UTC)TimeInMs\n"
         "Fix,gps,47.5,8.25,548.0,10.0,3.0,1709640000000\n"},
        {"t.csv",
         "Lcl Date, Lcl Time, UTCOfst, Latitude, Longitude, AltGPS, GndSpd, TRK, MagVar\n"
         "2024-03-05, 13:00:00, +01:00, 47.5, 8.25, 1640, 100, 80, 10\n"},
        {"t.csv",
         "NAM, NUM, FIX, SYS, SAT, CLK, TIM, LAT, LON, HAC, MSL, GEO\n"
         "a, 1, 3, 0, 11, 1.1, 1709640000.25, 47.5, 8.25, 0., 500.0, 548.0\n"}};
    return files;
}

void expect_sound(std::string_view bytes, const std::string& name, const Geoid& geoid) {
    const auto track = read_track(test::bytes_of(bytes), name, {&geoid, Geodetic::degrees(47, 8, 500)});
    if (!track) {
        EXPECT_TRUE(track.error().message.starts_with(name)) << track.error().message;
        EXPECT_EQ(track.error().message.find_first_of("\r\n"), std::string::npos) << track.error().message;
        return;
    }
    for (const TrackRow& row : track->points) {
        EXPECT_TRUE(row.position.vector().allFinite());
        EXPECT_TRUE(!row.velocity || row.velocity->vector().allFinite());
        EXPECT_TRUE(!row.attitude || row.attitude->body_to_ned().coeffs().allFinite());
    }
    for (const std::string& note : track->notes)
        EXPECT_EQ(note.find_first_of("\r\n"), std::string::npos) << note;
}

TEST(DamagedTracks, FilesThatAreNoTracksAreRefusedByWhatTheyAre) {
    const auto refused = [](std::string_view text) { return test::refusal_of_track(text); };
    EXPECT_THAT(refused("$GPGGA,120000,4700.0,N,00800.0,E,1,08,1.0,500,M,48,M,,\n"),
                testing::HasSubstr("NMEA sentences without a checksum"));
    EXPECT_THAT(refused("     3.04           OBSERVATION DATA    M                   RINEX VERSION / TYPE\n"),
                testing::HasSubstr("is a RINEX file"));
    EXPECT_THAT(refused({"\xFF\xFEt\0_\0s\0", 8}), testing::HasSubstr("UTF-16"));
    EXPECT_THAT(refused({"t_s,\0\1", 6}), testing::HasSubstr("is not text (byte 0x00 at offset 4)"));
    EXPECT_THAT(refused("t_s,lat_deg,lon_deg,h_ell_m\r0,47,8,500\r"), testing::HasSubstr("end in CR alone"));
    EXPECT_THAT(refused({"\x0E\x10\x11\x08\xDD\x05\0\0.FIT\xCD\xD0", 14}),
                testing::HasSubstr("is a FIT file; expected GPX or KML, which gpsbabel makes of it: gpsbabel -t -i "
                                   "garmin_fit -f FILE -o gpx,gpxver=1.0 -F track.gpx"));
    for (const char* const geojson :
         {R"({"type": "Feature", "properties": {"coordTimes": ["2024-03-05T12:00:00Z"]}, "geometry": {}})",
          "{\n\"features\": [{\"geometry\": {\"coordinates\": [[8.5, 47.5, 500]]"})
        EXPECT_THAT(refused(geojson), testing::HasSubstr("is GeoJSON")) << geojson;
}

TEST(DamagedTracks, AMarkOfTheByteOrderIsPassedOver) {
    const Track table = test::track_of("\xEF\xBB\xBFsep=;\nt_s;lat_deg;lon_deg;h_ell_m\n0;47;8;500\n");
    EXPECT_EQ(table.points.size(), 1u);
    EXPECT_THAT(test::refusal_of_track("\xEF\xBB\xBF{\"fileType\": \"Plan\"}"),
                testing::Not(testing::HasSubstr("column")));
}

TEST(DamagedTracks, AreWholeToBeginWith) {
    for (const auto& [name, text] : whole_files()) {
        const Track track = test::track_of(text, name, Geodetic::degrees(47, 8, 500));
        EXPECT_FALSE(track.points.empty()) << text;
    }
}

TEST(DamagedTracks, AreReadOrRefusedWhereverTheyAreCut) {
    const auto geoid = test::flat_geoid(10);
    for (const auto& [name, text] : whole_files())
        for (std::size_t size = 0; size < text.size(); ++size)
            expect_sound(std::string_view(text).substr(0, size), name, *geoid);
}

TEST(DamagedTracks, AreReadOrRefusedWithFlippedBitsAndExchangedPieces) {
    const auto geoid = test::flat_geoid(10);
    std::mt19937 random(20240305);
    const auto below = [&](std::size_t end) { return static_cast<std::size_t>(random()) % end; };
    static constexpr std::string_view pieces[] = {"nan", "-", "1e999", "99999999999999999999", ",", "\n", "<",
                                                  "\"",  "0", "é"};
    for (const auto& [name, text] : whole_files()) {
        for (int i = 0; i < 400; ++i) {
            std::string damaged = text;
            for (std::size_t changes = 1 + below(3); changes > 0; --changes) {
                const std::size_t at = below(damaged.size());
                if (below(2) == 0)
                    damaged[at] = static_cast<char>(damaged[at] ^ (1 << below(8)));
                else
                    damaged.replace(at, below(5), pieces[below(std::size(pieces))]);
            }
            expect_sound(damaged, name, *geoid);
        }
    }
}

TEST(DamagedTracks, OfNoFormatAreRefused) {
    const auto geoid = test::flat_geoid(10);
    std::mt19937 random(7);
    std::string binary(100'000, '\0');
    for (char& byte : binary)
        byte = static_cast<char>(random());
    for (const std::string& text :
         {std::string(), std::string(1000, '\0'), binary, std::string("hello"), std::string(300'000, 'x')})
        EXPECT_FALSE(read_track(test::bytes_of(text), "t.bin", {&*geoid, {}}).has_value());
}

}  // namespace
}  // namespace skyloop
