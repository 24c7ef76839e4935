// One flight in the logs of autopilots and receivers, written by tests/support/flights/write_flights.py.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <random>
#include <sstream>

#include "base/core/files.hpp"
#include "base/geo/local_frame.hpp"
#include "base/time/utc_time.hpp"
#include "motion/tracks/read_track.hpp"
#include "receiver/protocol/mavlink_vehicle.hpp"
#include "support/flat_geoid.hpp"
#include "support/oracle_table.hpp"

namespace skyloop {
namespace {

using test::flat_geoid;
using test::shared_data;
using testing::Contains;
using testing::HasSubstr;

struct FlightTruth {
    Geodetic place;
    Eigen::Vector3d velocity_ned;
    Attitude attitude;
};
using FlightTruths = std::map<std::int64_t, FlightTruth>;  // by GPS time, ns

// How far rows may be from the truth.
struct FlightLimits {
    double place_m = 0, velocity_mps = 0, attitude_deg = 0;
};

// The logs, as long as the program runs.
class FlightsFolder {
public:
    FlightsFolder()
        : path_(std::filesystem::path(::testing::TempDir()) /
                ("skyloop-flights-" + std::to_string(std::random_device()()))) {
        std::filesystem::create_directories(path_);
        const std::string command = std::string("python3 -B ") + SKYLOOP_SOURCE_DIR +
                                    "/tests/support/flights/write_flights.py " + path_.string();
        EXPECT_EQ(std::system(command.c_str()), 0) << command;
    }
    FlightsFolder(const FlightsFolder&) = delete;
    FlightsFolder& operator=(const FlightsFolder&) = delete;
    ~FlightsFolder() { std::filesystem::remove_all(path_); }
    [[nodiscard]] const std::filesystem::path& path() const { return path_; }

private:
    std::filesystem::path path_;
};

const std::filesystem::path& flights_folder() {
    static const FlightsFolder folder;
    return folder.path();
}

Bytes flight_bytes(const std::filesystem::path& path) {
    const auto text = read_text_file(path);
    EXPECT_TRUE(text.has_value()) << path;
    return text ? to_bytes(*text) : Bytes();
}

FlightTruths read_truths() {
    FlightTruths truths;
    std::ifstream file(flights_folder() / "truth.csv");
    for (std::string line; std::getline(file, line);) {
        std::istringstream cells(line);
        std::vector<std::string> parts;
        for (std::string cell; std::getline(cells, cell, ',');)
            parts.push_back(cell);
        const auto number = [&](std::size_t i) { return std::strtod(parts.at(i).c_str(), nullptr); };
        truths[std::stoll(parts.at(0))] = {
            Geodetic::degrees(number(1), number(2), number(3)),
            {number(4), number(5), number(6)},
            Attitude::roll_pitch_yaw(Angle::degrees(number(7)), Angle::degrees(number(8)), Angle::degrees(number(9)))};
    }
    return truths;
}

Track read_flight(const std::string& file) {
    const auto geoid = flat_geoid(48);
    EXPECT_TRUE(geoid.has_value());
    auto track = read_track(flight_bytes(flights_folder() / file), file, {&*geoid});
    EXPECT_TRUE(track.has_value()) << (track ? "" : track.error().message);
    return track ? std::move(*track) : Track{};
}

void expect_rows(const Track& track, const FlightLimits& limits) {
    const FlightTruths truths = read_truths();
    ASSERT_TRUE(track.origin.has_value());
    for (const TrackRow& row : track.points) {
        const auto found = truths.find((*track.origin + row.time).time_since_epoch().count());
        ASSERT_NE(found, truths.end()) << row.time.count();
        const FlightTruth& truth = found->second;
        EXPECT_LE((row.position - to_ecef(truth.place)).length().value(), limits.place_m) << row.time.count();
        if (limits.velocity_mps > 0) {
            ASSERT_TRUE(row.velocity.has_value()) << row.time.count();
            const Eigen::Vector3d enu = LocalFrame(truth.place).to_enu(*row.velocity).vector();
            const Eigen::Vector3d ned(enu.y(), enu.x(), -enu.z());
            EXPECT_LE((ned - truth.velocity_ned).norm(), limits.velocity_mps) << row.time.count();
        }
        if (limits.attitude_deg > 0) {
            ASSERT_TRUE(row.attitude.has_value()) << row.time.count();
            const double off = row.attitude->body_to_ned().angularDistance(truth.attitude.body_to_ned());
            EXPECT_LE(Angle::radians(off).deg(), limits.attitude_deg) << row.time.count();
        }
    }
}

std::size_t jumps_of(const Track& track) {
    return static_cast<std::size_t>(
        std::count_if(track.points.begin(), track.points.end(), [](const TrackRow& row) { return row.jump; }));
}

TEST(FlightLogs, UlogTakesTheFilterAndUndoesItsReset) {
    const Track track = read_flight("local.ulg");
    EXPECT_EQ(track.format, "ULog, vehicle_local_position");
    EXPECT_EQ(track.points.size(), 101u);
    EXPECT_EQ(jumps_of(track), 0u);
    EXPECT_THAT(track.notes, Contains(HasSubstr("the places are the 101 of vehicle_local_position at 10.0 Hz")));
    EXPECT_THAT(track.notes, Contains(HasSubstr("1 resets of vehicle_local_position by up to 3.74 m")));
    expect_rows(track, {0.002, 1e-5, 0.01});
}

// EKF2 without a place on the Earth tells NaN as its reference, in every record.
TEST(FlightLogs, UlogFromIndoorsFliesFromTheOriginThatIsTold) {
    const Geodetic origin = Geodetic::degrees(47, 8.5, 500);
    const auto track = read_track(flight_bytes(flights_folder() / "indoors.ulg"), "indoors.ulg", {nullptr, origin});
    ASSERT_TRUE(track.has_value()) << track.error().message;
    EXPECT_EQ(jumps_of(*track), 0u);
    EXPECT_THAT(track->notes, Contains(HasSubstr("1 resets of vehicle_local_position by up to 3.74 m")));
    const FlightTruths truths = read_truths();
    ASSERT_EQ(track->points.size(), truths.size());
    auto truth = truths.begin();
    for (const TrackRow& row : track->points) {
        EXPECT_LE((row.position - to_ecef(truth->second.place)).length().value(), 0.002) << row.time.count();
        EXPECT_TRUE(row.velocity.has_value()) << row.time.count();
        ++truth;
    }
}

TEST(FlightLogs, UlogOfTodayTellsTheReceiverInDegrees) {
    const Track track = read_flight("receiver.ulg");
    EXPECT_EQ(track.format, "ULog, sensor_gps");
    EXPECT_EQ(track.points.size(), 101u);
    EXPECT_THAT(track.notes, Contains("101 rows have no attitude"));
    expect_rows(track, {1e-4, 1e-5, 0});
}

// Two starts of the autopilot, the second one after 6 s.
TEST(FlightLogs, DataflashJoinsMetresDegreesAndTheCoreInCharge) {
    const Track track = read_flight("new.bin");
    EXPECT_EQ(track.format, "DataFlash, POS and XKF1 of core 1");
    EXPECT_EQ(track.points.size(), 101u);
    EXPECT_EQ(jumps_of(track), 1u);
    EXPECT_TRUE(track.points[60].jump);
    EXPECT_THAT(track.notes, Contains(HasSubstr("the autopilot started 2 times")));
    expect_rows(track, {0.01, 1e-5, 0.02});
}

TEST(FlightLogs, OldDataflashScalesByLetters) {
    const Track track = read_flight("old.bin");
    EXPECT_EQ(track.format, "DataFlash, GPS of receiver 0");
    EXPECT_EQ(track.points.size(), 101u);
    expect_rows(track, {0.012, 1e-5, 0.02});
}

TEST(FlightLogs, DataflashOfASimulationTellsItsTruth) {
    const Track track = read_flight("simulated.bin");
    EXPECT_EQ(track.format, "DataFlash, SIM and SIM2");
    EXPECT_EQ(track.points.size(), 101u);
    expect_rows(track, {0.01, 1e-5, 0.01});
}

TEST(FlightLogs, TlogCountsByTheAutopilotsClock) {
    const Track track = read_flight("global.tlog");
    EXPECT_EQ(track.format, "MAVLink tlog, GLOBAL_POSITION_INT");
    EXPECT_EQ(track.points.size(), 101u);
    EXPECT_THAT(track.notes, Contains(HasSubstr("by system 1, component 1")));
    EXPECT_THAT(track.notes, Contains(HasSubstr("left out: 9/1")));
    EXPECT_THAT(track.notes, Contains("SYSTEM_TIME gives UTC"));
    expect_rows(track, {0.012, 0.01, 0.01});
}

TEST(FlightLogs, TlogOfVersionOneIsDatedByTheStampsThatAreNotLate) {
    const Track track = read_flight("local.tlog");
    EXPECT_EQ(track.format, "MAVLink tlog, LOCAL_POSITION_NED");
    EXPECT_EQ(track.points.size(), 101u);
    EXPECT_EQ(jumps_of(track), 1u);
    expect_rows(track, {0.002, 1e-5, 0.01});
}

// A single float is 3.2e-6° apart from the next one at 47°: 0.36 m north, 0.25 m east at most from the truth.
TEST(FlightLogs, TlogOfASimulationHasPlacesInWholeDegreesTimesTenMillion) {
    const Track track = read_flight("simulated.tlog");
    EXPECT_EQ(track.format, "MAVLink tlog, SIM_STATE");
    EXPECT_EQ(track.points.size(), 101u);
    expect_rows(track, {0.3, 1e-5, 0.01});
}

TEST(FlightLogs, UbxKeepsEpochsWithAFix) {
    const Track track = read_flight("log.ubx");
    EXPECT_EQ(track.format, "UBX");
    EXPECT_EQ(track.points.size(), 99u);
    EXPECT_THAT(track.notes, Contains("1 of 100 epochs have no place and were left out"));
    EXPECT_THAT(track.notes, Contains(HasSubstr("wrong checksum")));
    expect_rows(track, {0.01, 0.001, 0.001});
}

TEST(FlightLogs, WithoutAGeoidTheLogsOwnIsTaken) {
    for (const std::string file : {"local.ulg", "old.bin", "log.ubx"}) {
        const auto track = read_track(flight_bytes(flights_folder() / file), file, {});
        ASSERT_TRUE(track.has_value()) << track.error().message;
        expect_rows(*track, {0.012, 0, 0});
    }
    const auto refused = read_track(flight_bytes(flights_folder() / "global.tlog"), "x.tlog", {});
    ASSERT_FALSE(refused.has_value());
    EXPECT_THAT(refused.error().message, HasSubstr("x.tlog: the heights of GLOBAL_POSITION_INT are above the sea"));
}

TEST(FlightLogs, ALogWithoutAPlaceSaysWhatItHas) {
    Bytes tlog = flight_bytes(flights_folder() / "global.tlog");
    tlog.resize(8 + 12);  // the ground station's heartbeat, cut
    const auto nothing = read_track(tlog, "x.tlog", {});
    ASSERT_FALSE(nothing.has_value());
    EXPECT_THAT(nothing.error().message, HasSubstr("x.tlog: a MAVLink log of 0 senders"));
    Bytes ulog = flight_bytes(flights_folder() / "receiver.ulg");
    ulog.resize(16);
    const auto empty = read_track(ulog, "x.ulg", {});
    ASSERT_FALSE(empty.has_value());
    EXPECT_THAT(empty.error().message, HasSubstr("x.ulg: a ULog without two records of a place"));
}

TEST(FlightLogs, TlogGoesOnWhereTheMillisecondsEnd) {
    Bytes log;
    for (std::uint32_t i = 0; i < 20; ++i) {
        MavlinkGlobalPositionInt place;
        place.time_boot_ms = 4'294'966'296U + i * 100;  // 1 s before 2^32
        place.lat = 470000000, place.lon = 85000000, place.alt = 500000;
        const Bytes stamp{0, 0x06, 0x12, 0xE9, 0x0B, 0x70, 0, static_cast<std::uint8_t>(i)};
        const Bytes frame = encode_mavlink({}, place);
        log.insert(log.end(), stamp.begin(), stamp.end());
        log.insert(log.end(), frame.begin(), frame.end());
    }
    const auto geoid = flat_geoid(48);
    const auto track = read_track(log, "x.tlog", {&*geoid});
    ASSERT_TRUE(track.has_value()) << track.error().message;
    ASSERT_EQ(track->points.size(), 20u);
    EXPECT_EQ(jumps_of(*track), 0u);
    EXPECT_EQ(track->points.back().time - track->points.front().time, std::chrono::milliseconds(1900));
}

TEST(FlightLogs, ANameThatTheContentDoesNotFitIsRefused) {
    const auto refusal = [](std::string_view content, const std::string& name) {
        const auto track = read_track(to_bytes(content), name, {});
        return track ? std::string() : track.error().message;
    };
    EXPECT_EQ(refusal("SQLite format 3", "world.TLOG"),
              "world.TLOG: begins with 53 51 4c 69 74 65 20 66; expected a MAVLink log, which begins with a time of "
              "eight bytes and fe or fd");
    EXPECT_EQ(refusal("", "a.ulg"), "a.ulg: is empty; expected a PX4 log, which begins with 55 4c 6f 67");
    EXPECT_THAT(refusal("x", "a.bin"), HasSubstr("an ArduPilot log"));
    EXPECT_THAT(refusal("x", "a.ubx"), HasSubstr("a UBX log with NAV-PVT"));
}

// What damage leaves is a track or one clear line; every place is one.
void expect_sound(const Bytes& bytes, const std::string& what) {
    const auto track = read_track(bytes, "x", {});
    if (!track) {
        EXPECT_TRUE(track.error().message.starts_with("x:")) << what << ": " << track.error().message;
        EXPECT_EQ(track.error().message.find('\n'), std::string::npos) << what;
        return;
    }
    for (const TrackRow& row : track->points) {
        ASSERT_TRUE(row.position.vector().allFinite()) << what;
        if (row.velocity) {
            ASSERT_TRUE(row.velocity->vector().allFinite()) << what;
        }
    }
    Track cleaned = *track;
    (void)clean_track(cleaned, Seconds(10));
}

TEST(FlightLogs, CutAndDamagedLogsAreSound) {
    std::mt19937 random(8);
    for (const std::string file : {"local.ulg", "new.bin", "global.tlog", "local.tlog", "log.ubx"}) {
        Bytes whole = flight_bytes(flights_folder() / file);
        whole.resize(std::min<std::size_t>(whole.size(), 6000));
        for (std::size_t size = 0; size < whole.size(); size += size < 1200 ? 1 : 37)
            expect_sound(Bytes(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size)), file);
        for (int i = 0; i < 300; ++i) {
            Bytes damaged = whole;
            for (int k = 0; k < 1 + i % 20; ++k)
                damaged[random() % damaged.size()] = static_cast<std::uint8_t>(random());
            expect_sound(damaged, file);
        }
    }
}

struct RealLog {
    const char* path;
    const char* format;
    std::size_t rows, attitudes;
};

// Counted with Python scripts of our own from the formats' descriptions: fixes of vehicle_gps_position; records of
// NKF1; NAV-PVT with gnssFixOK.
TEST(FlightLogs, RealLogsHaveTheirRows) {
    constexpr RealLog logs[] = {
        {"tracks/sample_log_small.ulg", "ULog, vehicle_gps_position", 32, 32},
        {"tracks/test.BIN", "DataFlash, POS and NKF1 of core 0", 24, 24},
        {"receivers/bend_f9t/F9T-L2-5min.ubx.gz", "UBX", 299, 0},
        {"receivers/besancon_20250425_ublox/16dBatt_no_interference_coldstart.ubx.gz", "UBX", 552, 0}};
    const auto geoid = flat_geoid(20);
    ASSERT_TRUE(geoid.has_value());
    for (const RealLog& log : logs) {
        const auto path = shared_data(log.path);
        if (!path) GTEST_SKIP() << "shared data absent: " << log.path;
        const auto track = read_track(flight_bytes(*path), log.path, {&*geoid});
        ASSERT_TRUE(track.has_value()) << track.error().message;
        EXPECT_EQ(track->format, log.format);
        EXPECT_EQ(track->points.size(), log.rows) << log.path;
        std::size_t attitudes = 0;
        for (const TrackRow& row : track->points)
            if (row.attitude) ++attitudes;
        EXPECT_EQ(attitudes, log.attitudes) << log.path;
        EXPECT_TRUE(track->origin.has_value());
    }
}

TEST(FlightLogs, ARealLogOnTheTableTellsThatItHasNoPlace) {
    SKYLOOP_REQUIRE_SHARED(path, "tracks/sample.ulg");
    const auto track = read_track(flight_bytes(path), "sample.ulg", {});
    ASSERT_FALSE(track.has_value());
    EXPECT_THAT(track.error().message, HasSubstr("678 vehicle_local_position"));
}

// GPS week 1973, 6 448.0 s at 81.855 471 s of the autopilot's clock; of NKF1 the first record is at 81.795 742 s. The
// origin that follows from POS and NKF1 is that of ORGN, which is written in steps of 1e-7 degrees: 35.3626381° S,
// 149.1653685° E, 585.6 m.
TEST(FlightLogs, ARealLogOfArduPilotIsDatedAndPlaced) {
    SKYLOOP_REQUIRE_SHARED(path, "tracks/test.BIN");
    const auto geoid = flat_geoid(20);
    const auto track = read_track(flight_bytes(path), "test.BIN", {&*geoid});
    ASSERT_TRUE(track.has_value()) << track.error().message;
    const TrackRow& first = track->points.front();
    const GpsTime time = *track->origin + first.time;
    EXPECT_NEAR(difference(time, to_gps_time(1973, 6448.0 - 0.059729)).value(), 0, 0.02);
    const Geodetic place = to_geodetic(first.position);
    EXPECT_NEAR(place.latitude.deg(), -35.3626381 + 0.9315431 / 111318.845, 1e-7);
    EXPECT_NEAR(place.longitude.deg(), 149.1653685 - 5.7226481 / (111318.845 * std::cos(35.36263 * 3.14159265 / 180)),
                1e-7);
    EXPECT_NEAR(place.height.above_ellipsoid.value(), 585.6 - 1.2151875 + 20, 0.02);
    EXPECT_NEAR(first.attitude->roll().deg(), -7.18, 0.02);
    EXPECT_NEAR(first.attitude->yaw().deg(), 337.1 - 360, 0.02);
}

}  // namespace
}  // namespace skyloop
