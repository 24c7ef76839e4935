// One known path, written in every format by code that shares nothing with the readers, comes back within the digits of
// the format: a figure of eight at 180 degrees of longitude, below the sea, over midnight UTC.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>
#include <cstdlib>
#include <fstream>

#include "base/core/files.hpp"
#include "base/geo/local_frame.hpp"
#include "stored_zip.hpp"
#include "track_reading.hpp"

namespace skyloop {
namespace {

constexpr double geoid_m = 10;  // of track_of()
const Geodetic eight_origin = Geodetic::degrees(-16.5, 180, -40);
constexpr int eight_rows = 120;
constexpr double eight_step_s = 0.5;

// 23:59:30 on the last day of February of a leap year.
const GpsTime eight_start = to_gps_time(UtcTime{2024, 2, 29, 23, 59, 30, 0}, LeapSeconds::announced());

struct EightSample {
    GpsTime time;
    UtcTime utc;
    double elapsed_s = 0;
    Eigen::Vector3d enu, velocity_enu;  // m and m/s, about the origin and at the place
    Eigen::Vector3d ecef;
    double latitude_deg = 0, longitude_deg = 0, height_m = 0;
    [[nodiscard]] double sea_level_m() const { return height_m - geoid_m; }
    [[nodiscard]] double speed_mps() const { return std::hypot(velocity_enu.x(), velocity_enu.y()); }
    [[nodiscard]] double course_deg() const {
        const double course = std::atan2(velocity_enu.x(), velocity_enu.y()) * 180 / std::numbers::pi;
        return course < 0 ? course + 360 : course;
    }
    [[nodiscard]] double posix_s() const {
        return static_cast<double>(week_and_tow(time).week) * 604800 + week_and_tow(time).tow_seconds() - 18 +
               315964800;
    }
};

// Lissajous' figure of eight, 300 m by 150 m, once in 60 s, that sinks and rises by 3 m.
EightSample eight_at(int row) {
    EightSample sample;
    sample.elapsed_s = row * eight_step_s;
    sample.time = advanced(eight_start, Seconds(sample.elapsed_s));
    sample.utc = to_utc(sample.time, LeapSeconds::announced());
    const double w = 2 * std::numbers::pi / 60, t = w * sample.elapsed_s;
    sample.enu = {300 * std::sin(t), 150 * std::sin(2 * t), 3 * std::cos(t)};
    const Eigen::Vector3d velocity(300 * w * std::cos(t), 300 * w * std::cos(2 * t), -3 * w * std::sin(t));
    const LocalFrame frame(eight_origin);
    const Position<Ecef> place = frame.to_ecef(Position<Enu>(sample.enu));
    const Geodetic geodetic = to_geodetic(place);
    sample.velocity_enu = LocalFrame(geodetic).to_enu(frame.to_ecef(Velocity<Enu>(velocity))).vector();
    sample.ecef = place.vector();
    sample.latitude_deg = geodetic.latitude.deg();
    sample.longitude_deg = geodetic.longitude.deg();
    sample.height_m = geodetic.height.above_ellipsoid.value();
    return sample;
}

std::string iso(const EightSample& s) {
    return fmt::format("{:04}-{:02}-{:02}T{:02}:{:02}:{:02}.{:03}Z", s.utc.year, s.utc.month, s.utc.day, s.utc.hour,
                       s.utc.minute, s.utc.second, s.utc.nanosecond / 1'000'000);
}

std::string clock_of(const EightSample& s, std::string_view separator) {
    return fmt::format("{:02}{}{:02}{}{:02}.{:03}", s.utc.hour, separator, s.utc.minute, separator, s.utc.second,
                       s.utc.nanosecond / 1'000'000);
}

// Degrees and minutes: "1630.12345" with as many digits of degrees as asked for.
std::string minutes_of(double degrees, int degree_digits, int decimals) {
    const double size = std::abs(degrees);
    auto whole = static_cast<int>(size);
    const double scale = std::pow(10, decimals);
    double minutes = std::round((size - whole) * 60 * scale) / scale;
    if (minutes >= 60) minutes -= 60, ++whole;
    return fmt::format("{:0{}}{:0{}.{}f}", whole, degree_digits, minutes, decimals + 3, decimals);
}

struct EightFormat {
    std::string name;
    std::string head;
    std::string (*row)(const EightSample&);
    std::string tail;
    double horizontal_m, vertical_m;  // largest errors of the format's digits
    double velocity_mps = 0;          // 0: it has no velocity
    bool dated = true;
};

void PrintTo(const EightFormat& format, std::ostream* out) { *out << format.name; }

std::string gpx_point(const EightSample& s, const std::string& motion) {
    return fmt::format("<trkpt lat='{:.7f}' lon='{:.7f}'><ele>{:.2f}</ele><time>{}</time>{}</trkpt>\n", s.latitude_deg,
                       s.longitude_deg, s.sea_level_m(), iso(s), motion);
}

std::string gpx10_row(const EightSample& s) {
    return gpx_point(s, fmt::format("<course>{:.3f}</course><speed>{:.3f}</speed>", s.course_deg(), s.speed_mps()));
}

std::string gpx11_row(const EightSample& s) {
    return gpx_point(s, fmt::format("<extensions><x:T><x:speed>{:.3f}</x:speed><x:course>{:.3f}</x:course></x:T>"
                                    "</extensions>",
                                    s.speed_mps(), s.course_deg()));
}

std::string kml_row(const EightSample& s) {
    return fmt::format("<when>{}</when><gx:coord>{:.7f} {:.7f} {:.2f}</gx:coord>\n", iso(s), s.longitude_deg,
                       s.latitude_deg, s.sea_level_m());
}

std::string placemark_row(const EightSample& s) {
    return fmt::format(
        "<Placemark><TimeStamp><when>{}</when></TimeStamp><Point><altitudeMode>absolute</altitudeMode>"
        "<coordinates>{:.7f},{:.7f},{:.2f}</coordinates></Point></Placemark>\n",
        iso(s), s.longitude_deg, s.latitude_deg, s.sea_level_m());
}

std::string igc_minutes(double degrees, int degree_digits) {
    std::string text = minutes_of(degrees, degree_digits, 5);
    return text.erase(text.find('.'), 1);
}

// Thousandths of minutes in their place, two more digits behind.
std::string igc_row(const EightSample& s) {
    const std::string latitude = igc_minutes(s.latitude_deg, 2), longitude = igc_minutes(s.longitude_deg, 3);
    return fmt::format("B{}{}{}{}{}A{:05.0f}{:05.0f}{}{}{:03}\r\n", clock_of(s, "").substr(0, 6), latitude.substr(0, 7),
                       s.latitude_deg < 0 ? 'S' : 'N', longitude.substr(0, 8), s.longitude_deg < 0 ? 'W' : 'E',
                       s.height_m, s.height_m, latitude.substr(7), longitude.substr(8), s.utc.nanosecond / 1'000'000);
}

std::string nmea_sentence(const std::string& body) {
    int sum = 0;
    for (const char letter : body)
        sum ^= letter;
    return fmt::format("${}*{:02X}\r\n", body, sum);
}

std::string nmea_place(const EightSample& s) {
    return fmt::format("{},{},{},{}", minutes_of(s.latitude_deg, 2, 5), s.latitude_deg < 0 ? 'S' : 'N',
                       minutes_of(s.longitude_deg, 3, 5), s.longitude_deg < 0 ? 'W' : 'E');
}

std::string nmea_row(const EightSample& s) {
    const std::string time = clock_of(s, "").substr(0, 9);
    return nmea_sentence(
               fmt::format("GNGGA,{},{},1,12,0.7,{:.2f},M,{:.1f},M,,", time, nmea_place(s), s.sea_level_m(), geoid_m)) +
           nmea_sentence(fmt::format("GNRMC,{},A,{},{:.3f},{:.2f},{:02}{:02}{:02},,,A", time, nmea_place(s),
                                     s.speed_mps() * 3600 / 1852, s.course_deg(), s.utc.day, s.utc.month,
                                     s.utc.year % 100));
}

std::string native_row(const EightSample& s) {
    return fmt::format("{},{:.9f},{:.9f},{:.3f},{:.3f},{:.3f},{:.3f}\n", iso(s), s.latitude_deg, s.longitude_deg,
                       s.height_m, s.velocity_enu.y(), s.velocity_enu.x(), -s.velocity_enu.z());
}

std::string motion_ecef_row(const EightSample& s) {
    return fmt::format("{:.1f},{:.3f},{:.3f},{:.3f}\n", s.elapsed_s, s.ecef.x(), s.ecef.y(), s.ecef.z());
}

std::string motion_geodetic_row(const EightSample& s) {
    return fmt::format("{:.1f},{:.9f},{:.9f},{:.3f}\n", s.elapsed_s, s.latitude_deg, s.longitude_deg, s.height_m);
}

std::string rtklib_row(const EightSample& s) {
    return fmt::format("{} {:.3f} {:.9f} {:.9f} {:.4f} 1 12 0 0 0 0 0 0 0 0 {:.5f} {:.5f} {:.5f} 0 0 0 0 0 0\n",
                       week_and_tow(s.time).week, week_and_tow(s.time).tow_seconds(), s.latitude_deg, s.longitude_deg,
                       s.height_m, s.velocity_enu.y(), s.velocity_enu.x(), s.velocity_enu.z());
}

std::string tum_row(const EightSample& s) {
    return fmt::format("{:.4f} {:.4f} {:.4f} {:.4f} 0 0 0 1\n", s.posix_s(), s.enu.x(), s.enu.y(), s.enu.z());
}

std::string euroc_row(const EightSample& s) {
    return fmt::format("{:.0f}{:09},{:.4f},{:.4f},{:.4f},1,0,0,0\n", std::floor(s.posix_s()), s.utc.nanosecond,
                       s.enu.x(), s.enu.y(), s.enu.z());
}

std::string unicsv_row(const EightSample& s) {
    return fmt::format("1,{:.6f},{:.6f},{:.1f},{:.2f},{:.1f},{:04}/{:02}/{:02},{}\n", s.latitude_deg, s.longitude_deg,
                       s.sea_level_m(), s.speed_mps(), s.course_deg(), s.utc.year, s.utc.month, s.utc.day,
                       clock_of(s, ":"));
}

std::string logger_row(const EightSample& s) {
    return fmt::format("Fix,GPS,{:.8f},{:.8f},{:.3f},{:.3f},3,{:.3f},{:.0f}\n", s.latitude_deg, s.longitude_deg,
                       s.height_m, s.speed_mps(), s.course_deg(), s.posix_s() * 1000);
}

std::string hazer_row(const EightSample& s) {
    return fmt::format("\"a\", 1, 3, {:.0f}.{:09}, {:.7f}, {:.7f}, {:.3f}, {:.3f}, {:.4f}, {:.3f}\n",
                       std::floor(s.posix_s()), s.utc.nanosecond, s.latitude_deg, s.longitude_deg, s.sea_level_m(),
                       s.height_m, s.speed_mps() * 3600 / 1852, s.course_deg());
}

std::string sexagesimal_text(double degrees) {
    const double size = std::abs(degrees);
    const double whole = std::floor(size), minutes = std::floor((size - whole) * 60);
    return fmt::format("{}{:.0f} {:.0f} {:.5f}", degrees < 0 ? "-" : "", whole, minutes,
                       ((size - whole) * 60 - minutes) * 60);
}

// The body looks where it goes, level.
std::string explorer_row(const EightSample& s) {
    return fmt::format("{:.2f} {} {:.2f} {} {} {:.3f} 0 {:.3f} {:.3f} 0 0 0 0 0 {:.6f} 1\n", s.posix_s(),
                       week_and_tow(s.time).week, week_and_tow(s.time).tow_seconds(), sexagesimal_text(s.latitude_deg),
                       sexagesimal_text(s.longitude_deg), s.height_m, s.speed_mps(), s.velocity_enu.z(),
                       s.course_deg());
}

std::string whole_eight(const EightFormat& format) {
    std::string text = format.head;
    for (int row = 0; row < eight_rows; ++row)
        text += format.row(eight_at(row));
    return text + format.tail;
}

void expect_eight(const Track& track, const EightFormat& format) {
    ASSERT_EQ(track.points.size(), static_cast<std::size_t>(eight_rows));
    ASSERT_EQ(track.origin.has_value(), format.dated);
    double horizontal = 0, vertical = 0, velocity = 0;
    for (int row = 0; row < eight_rows; ++row) {
        const EightSample sample = eight_at(row);
        const TrackRow& point = track.points[static_cast<std::size_t>(row)];
        const Nanoseconds elapsed = format.dated ? *track.origin + point.time - eight_start : point.time;
        EXPECT_EQ(elapsed, to_nanoseconds(Seconds(sample.elapsed_s))) << row;
        const LocalFrame here(to_geodetic(Position<Ecef>(sample.ecef)));
        const Eigen::Vector3d error = here.to_enu(point.position).vector();
        horizontal = std::max(horizontal, error.head<2>().norm());
        vertical = std::max(vertical, std::abs(error.z()));
        ASSERT_EQ(point.velocity.has_value(), format.velocity_mps > 0) << row;
        if (point.velocity)
            velocity = std::max(velocity, (here.to_enu(*point.velocity).vector() - sample.velocity_enu).norm());
    }
    EXPECT_LE(horizontal, format.horizontal_m);
    EXPECT_LE(vertical, format.vertical_m);
    EXPECT_LE(velocity, format.velocity_mps);
}

class EightRoundTrip : public testing::TestWithParam<EightFormat> {};

TEST_P(EightRoundTrip, ComesBackWithinTheDigitsOfTheFormat) {
    const EightFormat& format = GetParam();
    expect_eight(test::track_of(whole_eight(format), "t.txt", eight_origin), format);
}

// Half of the last digit: 1e-7 degrees are 11 mm, 1e-5 minutes 19 mm, 1e-5 seconds 0.3 mm. The climb of a format
// without one comes from heights 0.5 s apart, each wrong by half a digit.
INSTANTIATE_TEST_SUITE_P(
    Formats, EightRoundTrip,
    testing::Values(
        EightFormat{"Gpx10", "<gpx version='1.0'><trk><trkseg>", gpx10_row, "</trkseg></trk></gpx>", 0.008, 0.006,
                    0.03},
        EightFormat{"Gpx11", "<gpx version='1.1' xmlns:x='y'><trk><trkseg>", gpx11_row, "</trkseg></trk></gpx>", 0.008,
                    0.006, 0.03},
        EightFormat{"KmlTrack", "<kml><gx:Track><altitudeMode>absolute</altitudeMode>", kml_row, "</gx:Track></kml>",
                    0.008, 0.006},
        EightFormat{"KmlPlacemarks", "<kml>", placemark_row, "</kml>", 0.008, 0.006},
        EightFormat{"Igc", "AXXX\r\nHFDTE290224\r\nHFALGALTGPS:ELL\r\nI033637LAD3839LOD4042TDS\r\n", igc_row, "", 0.015,
                    0.51},
        EightFormat{"Nmea", "", nmea_row, "", 0.015, 0.006, 0.03},
        EightFormat{"Native", "utc,lat_deg,lon_deg,h_ell_m,vn_mps,ve_mps,vd_mps\n", native_row, "", 0.001, 0.001,
                    0.002},
        EightFormat{"MotionEcef", "", motion_ecef_row, "", 0.001, 0.001, 0, false},
        EightFormat{"MotionGeodetic", "", motion_geodetic_row, "", 0.001, 0.001, 0, false},
        EightFormat{"Rtklib", "%  GPST  latitude(deg) longitude(deg)  height(m)\n", rtklib_row, "", 0.001, 0.001,
                    0.001},
        EightFormat{"Tum", "# timestamp tx ty tz qx qy qz qw\n", tum_row, "", 0.001, 0.001},
        EightFormat{"Euroc", "#timestamp [ns], p_RS_R_x [m]\n", euroc_row, "", 0.001, 0.001},
        EightFormat{"Unicsv", "No,Latitude,Longitude,Altitude,Speed,Course,Date,Time\n", unicsv_row, "", 0.08, 0.06,
                    0.2},
        EightFormat{"GnssLogger", "# Fix,Provider,Latitude,Longitude,Altitude,Speed,Accuracy,Bearing,UnixTimeMillis\n",
                    logger_row, "", 0.002, 0.001, 0.01},
        EightFormat{"Hazer", "NAM, NUM, FIX, TIM, LAT, LON, MSL, GEO, SOG, COG\n", hazer_row, "", 0.008, 0.001, 0.01},
        EightFormat{"InertialExplorer", "", explorer_row, "", 0.001, 0.001, 0.002}),
    [](const auto& one) { return one.param.name; });

TEST(EightRoundTrip, ComesBackOutOfAKmz) {
    const EightFormat kml{
        "Kmz", "<kml><gx:Track><altitudeMode>absolute</altitudeMode>", kml_row, "</gx:Track></kml>", 0.008, 0.006};
    expect_eight(test::track_of(test::stored_zip("doc.kml", whole_eight(kml)), "t.kmz"), kml);
}

struct ConvertedFormat {
    std::string name, type;
    double horizontal_m, vertical_m;
    double velocity_mps = 0;
    Nanoseconds step{std::chrono::milliseconds(500)};  // of its times
};

void PrintTo(const ConvertedFormat& format, std::ostream* out) { *out << format.name; }

class ConvertedByGpsbabel : public testing::TestWithParam<ConvertedFormat> {};

// gpsbabel, a stranger, writes the same path out of its own table.
TEST_P(ConvertedByGpsbabel, ComesBackWithinTheDigitsThatItWrites) {
    if (std::system("gpsbabel -V >/dev/null 2>&1") != 0) GTEST_SKIP() << "gpsbabel is not installed";
    const ConvertedFormat& format = GetParam();
    const std::string stem = testing::TempDir() + "skyloop-eight-" + format.name;
    {
        std::ofstream table(stem + ".csv");
        table << "No,Latitude,Longitude,Altitude,Speed,Course,Date,Time\n";
        for (int row = 0; row < eight_rows; ++row)
            table << unicsv_row(eight_at(row));
    }
    const std::string command =
        fmt::format("gpsbabel -t -i unicsv,utc=0 -f {0}.csv -o {1} -F {0}.out", stem, format.type);
    ASSERT_EQ(std::system(command.c_str()), 0);
    const auto text = read_text_file(stem + ".out");
    ASSERT_TRUE(text.has_value());
    Track track = test::track_of(*text, "t.txt");
    ASSERT_TRUE(clean_track(track, Seconds(10)).has_value());
    std::size_t compared = 0;
    for (const TrackRow& point : track.points) {
        const Nanoseconds elapsed = *track.origin + point.time - eight_start;
        if (elapsed % format.step != Nanoseconds(0)) continue;
        const EightSample sample = eight_at(static_cast<int>(elapsed / std::chrono::milliseconds(500)));
        const LocalFrame here(to_geodetic(Position<Ecef>(sample.ecef)));
        const Eigen::Vector3d error = here.to_enu(point.position).vector();
        EXPECT_LE(error.head<2>().norm(), format.horizontal_m);
        EXPECT_LE(std::abs(error.z()), format.vertical_m);
        ASSERT_EQ(point.velocity.has_value(), format.velocity_mps > 0);
        const auto velocity = point.velocity ? here.to_enu(*point.velocity).vector() : sample.velocity_enu;
        EXPECT_LE((velocity - sample.velocity_enu).norm(), format.velocity_mps);
        ++compared;
    }
    EXPECT_GE(compared, 59u);
}

// Its input has 0.06 m horizontally and 0.05 m of height; IGC and NMEA write thousandths of minutes, IGC whole seconds,
// of two rows in one of which the later one is kept, half a second late at 44 m/s.
INSTANTIATE_TEST_SUITE_P(Formats, ConvertedByGpsbabel,
                         testing::Values(ConvertedFormat{"Gpx10", "gpx,gpxver=1.0", 0.08, 0.06, 0.2},
                                         ConvertedFormat{"Gpx11", "gpx,gpxver=1.1", 0.08, 0.06},
                                         ConvertedFormat{"Kml", "kml,track=1", 0.2, 0.06},
                                         ConvertedFormat{"Unicsv", "unicsv,utc=0", 0.2, 0.06, 0.3},
                                         ConvertedFormat{"Nmea", "nmea,gprmc=1,gpgga=1", 1.4, 0.06, 0.6},
                                         ConvertedFormat{"Igc", "igc", 1.4 + 23, 1.1, 0, std::chrono::seconds(1)}),
                         [](const auto& one) { return one.param.name; });

}  // namespace
}  // namespace skyloop
