#include "world/sky/satellite_tracks.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "support/oracle_table.hpp"
#include "world/gnss/navigation_data.hpp"
#include "world/gnss/orbit.hpp"
#include "world/rinex/navigation_file.hpp"

namespace skyloop::test {
namespace {

using namespace std::chrono_literals;

const NominalConstellation nominal;
const GpsTime noon = to_gps_time(2304, 216000.0);

TEST(SatelliteTracks, AgreesWithTheOracleOver46Hours) {
    SKYLOOP_REQUIRE_SHARED(path, "oracles/nav/nav_20200625_eu_MN.rnx");
    const auto file = read_navigation_file(path);
    ASSERT_TRUE(file);
    std::map<std::string, SatelliteTrack> tracks;
    int checked = 0;
    for (const OracleRow& row : oracle_rows("orbit_trajectory_46h.csv")) {
        SCOPED_TRACE(row.id());
        const GpsTime toe = advanced(GpsTime{}, Seconds(row.number("toe_gpst_total_s")));
        const auto [track, is_new] = tracks.try_emplace(row.text("sat"));
        if (is_new) {
            // One record alone, extrapolated.
            const auto record = std::find_if(file->records.begin(), file->records.end(), [&](const Ephemeris& e) {
                return to_string(satellite_of(e)) == row.text("sat") && toe_of(e) == toe &&
                       iode_of(e) == row.integer("iode");
            });
            ASSERT_NE(record, file->records.end());
            const NavigationData source({*record}, std::nullopt, "one record");
            track->second =
                satellite_tracks(source, {.start = toe, .duration = Seconds(46 * 3600), .step = Seconds(3600)}).at(0);
            ASSERT_EQ(track->second.points.size(), 47u);
        }
        const TrackPoint& point = track->second.points.at(static_cast<std::size_t>(row.integer("hours_since_toe")));
        EXPECT_EQ(point.time, to_gps_time(row.integer("gps_week"), row.number("gps_tow_s")));
        const double tolerance = row.number("tol_m");
        EXPECT_NEAR(point.position.vector().x(), row.number("x_m"), tolerance);
        EXPECT_NEAR(point.position.vector().y(), row.number("y_m"), tolerance);
        EXPECT_NEAR(point.position.vector().z(), row.number("z_m"), tolerance);
        ++checked;
    }
    EXPECT_EQ(checked, 94);
}

TEST(SatelliteTracks, FollowsTheNominalConstellationForHours) {
    const auto tracks =
        satellite_tracks(nominal, {.start = noon, .duration = Seconds(46 * 3600), .step = Seconds(600)});
    ASSERT_EQ(tracks.size(), 31u);
    for (const SatelliteTrack& track : tracks) {
        ASSERT_EQ(track.points.size(), 46u * 6 + 1);
        EXPECT_EQ(track.points.front().time, noon);
        EXPECT_EQ(track.points.back().time, noon + 46h);
        for (const TrackPoint& p : track.points) {
            const SatelliteState state = satellite_state(*nominal.ephemeris(track.satellite, p.time), p.time);
            ASSERT_LT((p.position - state.position).length().value(), 1e-4);
        }
    }
}

TEST(SatelliteTracks, TakesTheNearestRecordAndGoesOnBeyondTheLast) {
    const SatelliteId g01{Constellation::gps, 1};
    KeplerEphemeris first = *nominal.record(g01, noon);
    KeplerEphemeris second = *nominal.record(g01, noon + 2h);
    second.crc = 1000;  // so that the two can be told apart
    const NavigationData source({first, second}, std::nullopt, "test");
    const auto tracks =
        satellite_tracks(source, {.start = noon - 3h, .duration = Seconds(10 * 3600), .step = Seconds(1800)});
    ASSERT_EQ(tracks.size(), 1u);
    ASSERT_EQ(tracks[0].points.size(), 21u);
    for (const TrackPoint& p : tracks[0].points) {
        const KeplerEphemeris& expected = p.time < noon + 1h ? first : second;
        EXPECT_EQ(p.position.vector(), satellite_state(expected, p.time).position.vector()) << (p.time - noon).count();
    }
}

TEST(SatelliteTracks, LeavesGeostationarySatellitesWhereTheirRecordEnds) {
    SbasEphemeris record;
    record.satellite = {Constellation::sbas, 43};
    record.toe = noon;
    record.position_m = {-30e6, 29e6, 1e5};
    record.velocity_mps = {0.5, 1, -2};
    record.acceleration_mps2 = {2e-4, -1e-4, 0};
    const NavigationData source({record}, std::nullopt, "test");
    const auto tracks = satellite_tracks(source, {.start = noon - 6h, .duration = Seconds(30 * 3600)});
    ASSERT_EQ(tracks.size(), 1u);
    for (const TrackPoint& p : tracks[0].points) {
        const GpsTime served = std::clamp(p.time, noon - 6min, noon + 6min);
        EXPECT_EQ(p.position.vector(), satellite_state(Ephemeris(record), served).position.vector());
    }
}

TEST(SatelliteTracks, LeavesOutSatellitesWithoutNearRecords) {
    const NavigationData source({*nominal.record({Constellation::gps, 1}, noon)}, std::nullopt, "test");
    EXPECT_TRUE(satellite_tracks(source, {.start = noon + std::chrono::days(30)}).empty());
    EXPECT_TRUE(satellite_tracks(NavigationData({}, std::nullopt, "none"), {.start = noon}).empty());
    EXPECT_EQ(satellite_tracks(source, {.start = noon + 24h}).size(), 1u);
}

}  // namespace
}  // namespace skyloop::test
