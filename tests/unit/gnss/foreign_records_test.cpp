#include "world/gnss/foreign_records.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "world/gnss/navigation_data.hpp"
#include "world/gnss/orbit.hpp"

namespace skyloop::test {
namespace {

using namespace std::chrono_literals;

const GpsTime day = to_gps_time(2200, 0.0);

SatelliteId gps(int number) { return {Constellation::gps, number}; }

// Records every two hours from `first_hour` to `last_hour` of a satellite of the nominal constellation.
std::vector<Ephemeris> records_of(int number, int first_hour, int last_hour) {
    std::vector<Ephemeris> records;
    for (int hour = first_hour; hour <= last_hour; hour += 2)
        records.push_back(*NominalConstellation().record(gps(number), day + std::chrono::hours(hour)));
    return records;
}

void append(std::vector<Ephemeris>& records, const std::vector<Ephemeris>& more) {
    records.insert(records.end(), more.begin(), more.end());
}

// The record of satellite `true_number` at `hour`, broadcast as `claimed`.
KeplerEphemeris foreign(int true_number, int claimed, int hour) {
    KeplerEphemeris record = *NominalConstellation().record(gps(true_number), day + std::chrono::hours(hour));
    record.satellite = gps(claimed);
    return record;
}

TEST(ForeignRecords, LeavesGoodOrbitsAlone) {
    std::vector<Ephemeris> records;
    for (int number = 1; number <= 31; ++number)
        append(records, records_of(number, 0, 24));
    EXPECT_TRUE(drop_foreign_records(records).empty());
    EXPECT_EQ(records.size(), 31u * 13);
    std::vector<Ephemeris> none;
    EXPECT_TRUE(drop_foreign_records(none).empty());
}

TEST(ForeignRecords, DropsAForeignOneWhereverItStands) {
    for (const int hour : {0, 6, 12, 24}) {
        std::vector<Ephemeris> records = records_of(1, 0, 24);
        records[static_cast<std::size_t>(hour / 2)] = foreign(9, 1, hour);
        append(records, records_of(9, 0, 24));
        const auto dropped = drop_foreign_records(records);
        ASSERT_EQ(dropped.size(), 1u) << hour;
        EXPECT_EQ(toe_of(dropped[0].record), day + std::chrono::hours(hour));
        EXPECT_EQ(records.size(), 25u);
        EXPECT_NE(dropped[0].reason.find("G01: record with toe 2022-03-0"), std::string::npos) << dropped[0].reason;
        EXPECT_NE(dropped[0].reason.find(" km from its neighbours (it is the orbit of G09); dropped"),
                  std::string::npos)
            << dropped[0].reason;
    }
}

TEST(ForeignRecords, DropsSeveralInARowAndAnUnknownOrbit) {
    std::vector<Ephemeris> records = records_of(1, 0, 24);
    records[4] = foreign(20, 1, 8);
    records[5] = foreign(20, 1, 10);
    const auto dropped = drop_foreign_records(records);
    ASSERT_EQ(dropped.size(), 2u);
    EXPECT_EQ(dropped[0].reason.find("orbit of"), std::string::npos)
        << "nobody else has this orbit: " << dropped[0].reason;
    EXPECT_EQ(records.size(), 11u);
}

TEST(ForeignRecords, BetweenTwoTheOrbitOfAnotherSatelliteGoes) {
    std::vector<Ephemeris> records = records_of(1, 0, 0);
    records.push_back(foreign(9, 1, 2));
    append(records, records_of(9, 0, 4));
    const auto dropped = drop_foreign_records(records);
    ASSERT_EQ(dropped.size(), 1u);
    EXPECT_EQ(toe_of(dropped[0].record), day + 2h);

    std::vector<Ephemeris> undecided = records_of(1, 0, 0);
    undecided.push_back(foreign(9, 1, 2));
    EXPECT_TRUE(drop_foreign_records(undecided).empty()) << "nothing tells which of the two is right";
}

// A GLONASS satellite on a circular orbit, broadcast every half hour.
std::vector<Ephemeris> glonass_day(int number, double start_angle) {
    GlonassEphemeris e;
    e.satellite = {Constellation::glonass, number};
    e.toe = day;
    const double c = std::cos(start_angle), s = std::sin(start_angle);
    e.position_m = {25.5e6 * c, 25.5e6 * 0.42 * s, 25.5e6 * 0.907 * s};
    e.velocity_mps = {-3950 * s + 1860 * 0.42 * s, 3950 * 0.42 * c - 1860 * c, 3950 * 0.907 * c};
    std::vector<Ephemeris> records;
    for (int i = 0; i < 12; ++i)
        records.push_back(carried_to(e, day + i * 30min));
    return records;
}

TEST(ForeignRecords, FindsTheOppositeSatelliteOfAGlonassPlane) {
    std::vector<Ephemeris> records = glonass_day(1, 0.3);
    const std::vector<Ephemeris> opposite = glonass_day(5, 0.3 + std::numbers::pi);
    for (const std::size_t i : {4u, 5u}) {
        auto wrong = std::get<GlonassEphemeris>(opposite[i]);
        wrong.satellite.number = 1;
        records[i] = wrong;
    }
    append(records, opposite);
    const auto dropped = drop_foreign_records(records);
    ASSERT_EQ(dropped.size(), 2u);
    EXPECT_NE(dropped[0].reason.find("it is the orbit of R05"), std::string::npos) << dropped[0].reason;
    EXPECT_EQ(records.size(), 22u);
}

TEST(ForeignRecords, LeavesUnhealthyRecordsAndManoeuvres) {
    std::vector<Ephemeris> records = records_of(1, 0, 24);
    KeplerEphemeris unhealthy = foreign(9, 1, 6);
    unhealthy.health = 63;
    records[3] = unhealthy;
    // From 12 h on the satellite drifts along its orbit by 0.1° an hour: 46 km between neighbours, 500 km over the day.
    for (std::size_t i = 7; i < records.size(); ++i)
        std::get<KeplerEphemeris>(records[i]).m0 += static_cast<double>(i - 6) * 0.1 * std::numbers::pi / 180;
    EXPECT_TRUE(drop_foreign_records(records).empty());
    EXPECT_EQ(records.size(), 13u);
}

}  // namespace
}  // namespace skyloop::test
