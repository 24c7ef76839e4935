#include "world/gnss/navigation_data.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

#include "base/time/utc_time.hpp"
#include "support/oracle_table.hpp"
#include "world/gnss/orbit.hpp"

namespace skyloop::test {
namespace {

using namespace std::chrono_literals;

constexpr SatelliteId g15{Constellation::gps, 15};
const GpsTime monday = to_gps_time(2111, 86400.0);

KeplerEphemeris plain_record(GpsTime toe, SatelliteId satellite = g15) {
    KeplerEphemeris e;
    e.satellite = satellite;
    e.toe = e.toc = toe;
    e.sqrt_a = 5153.7;
    e.e = 0.012;
    e.i0 = 0.96;
    e.omega0 = 1.2;
    e.omega = -2.1;
    e.omega_dot = -8.1e-9;
    e.idot = 2e-10;
    e.m0 = 0.7;
    e.delta_n = 4.5e-9;
    e.crs = 30;
    e.crc = 220;
    e.iode = 11;
    return e;
}

NavigationData data_of(std::vector<Ephemeris> records, EphemerisRule rule = EphemerisRule::nearest) {
    return NavigationData(std::move(records), std::nullopt, "test data", {.rule = rule});
}

// An instant given as a total of GPS seconds, to the nanosecond.
GpsTime total_seconds(double seconds) { return advanced(GpsTime{}, Seconds(seconds)); }

void check_choice(const OracleRow& row, const std::string& column, const std::optional<Ephemeris>& chosen,
                  const std::vector<Ephemeris>& records) {
    SCOPED_TRACE(column);
    const std::string expected = row.text(column);
    ASSERT_EQ(chosen.has_value(), !expected.empty());
    if (!chosen) return;
    if (expected == "tie") {
        const GpsTime time = total_seconds(row.number("t_gpst_total_s"));
        const Nanoseconds age = std::chrono::abs(time - toe_of(*chosen));
        for (const Ephemeris& r : records)
            EXPECT_LE(age, std::chrono::abs(time - toe_of(r)));
    } else {
        EXPECT_EQ(toe_of(*chosen), total_seconds(row.number(column)));
    }
}

TEST(NavigationData, ChoosesRecordsAsTheOracle) {
    for (const OracleRow& row : oracle_rows("ephemeris_selection.csv")) {
        SCOPED_TRACE(row.id());
        const SatelliteId satellite = parse_satellite(row.text("sat")).value();
        std::vector<Ephemeris> records;
        std::istringstream toes(row.text("toe_list_gpst_total_s"));
        for (double toe = 0; toes >> toe;)
            records.push_back(plain_record(total_seconds(toe), satellite));
        const GpsTime time = total_seconds(row.number("t_gpst_total_s"));

        check_choice(row, "paper_toe", data_of(records, EphemerisRule::forward).ephemeris(satellite, time), records);
        check_choice(row, "nearest_toe", data_of(records, EphemerisRule::nearest).ephemeris(satellite, time), records);
    }
}

TEST(NavigationData, ForwardRulePassesOverUnhealthyRecords) {
    auto unhealthy = plain_record(monday + 1h);
    unhealthy.health = 63;
    const NavigationData data = data_of({plain_record(monday), unhealthy}, EphemerisRule::forward);
    EXPECT_EQ(toe_of(*data.ephemeris(g15, monday + 90min)), monday);
    EXPECT_EQ(toe_of(*data.ephemeris(g15, monday + 2h)), monday) << "exactly two hours old is valid";
    EXPECT_FALSE(data.ephemeris(g15, monday + 2h + 1ns));
    EXPECT_FALSE(data.ephemeris(g15, monday - 1ns));
}

TEST(NavigationData, RecordsWithoutAPredictedAccuracyAreUnhealthy) {
    auto later = plain_record(monday + 1h);
    const auto served = [&](double accuracy_m) {
        later.accuracy_m = accuracy_m;
        const NavigationData data = data_of({plain_record(monday), later}, EphemerisRule::forward);
        return toe_of(*data.ephemeris(g15, monday + 90min));
    };
    EXPECT_EQ(served(6144), monday + 1h);
    EXPECT_EQ(served(8192), monday);
    EXPECT_EQ(served(-1), monday);
    later.message = NavigationMessage::almanac;
    EXPECT_TRUE(later.healthy());
}

TEST(NavigationData, NearestRuleKeepsUnhealthyRecords) {
    auto unhealthy = plain_record(monday + 1h);
    unhealthy.health = 63;
    const NavigationData data = data_of({plain_record(monday), unhealthy});
    EXPECT_FALSE(is_healthy(*data.ephemeris(g15, monday + 90min)));
    EXPECT_TRUE(data.ephemeris(g15, monday - 2h));
    EXPECT_FALSE(data.ephemeris(g15, monday - 2h - 1ns));
    EXPECT_TRUE(data.ephemeris(g15, monday + 3h));
    EXPECT_FALSE(data.ephemeris(g15, monday + 3h + 1ns));
}

TEST(NavigationData, KeepsRepetitionsOnceAndTheLastOfOneToe) {
    auto reissued = plain_record(monday);
    reissued.iode = 12;
    const NavigationData data =
        data_of({plain_record(monday), plain_record(monday + 2h), plain_record(monday), reissued});
    EXPECT_EQ(data.record_count(), 3u);
    EXPECT_EQ(iode_of(*data.ephemeris(g15, monday + 1min)), 12);
    EXPECT_EQ(iode_of(*data.ephemeris(g15, monday - 1min)), 12) << "from before, too";
}

TEST(NavigationData, KnowsItsSatellitesAndSpan) {
    const SatelliteId g02{Constellation::gps, 2};
    const SatelliteId j01{Constellation::qzss, 1};
    const std::vector<Ephemeris> records{plain_record(monday + 4h, j01), plain_record(monday, g15),
                                         plain_record(monday + 1h, g02)};
    const NavigationData nearest = data_of(records);
    EXPECT_EQ(nearest.satellites(), (std::vector<SatelliteId>{g02, g15, j01}));
    EXPECT_EQ(nearest.span()->first, monday - 2h);
    EXPECT_EQ(nearest.span()->last, monday + 6h);
    EXPECT_EQ(data_of(records, EphemerisRule::forward).span()->first, monday);
    EXPECT_EQ(nearest.satellites_at(monday + 1h), 2u);
    EXPECT_FALSE(nearest.ephemeris({Constellation::gps, 3}, monday));
    EXPECT_FALSE(data_of({}).span());
    EXPECT_TRUE(data_of({}).satellites().empty());
}

SatelliteId other_system(Constellation constellation) { return {constellation, 12}; }

KeplerEphemeris record_of_message(GpsTime toe, SatelliteId satellite, NavigationMessage message) {
    KeplerEphemeris e = plain_record(toe, satellite);
    e.message = message;
    return e;
}

GlonassEphemeris glonass_record(GpsTime toe) {
    GlonassEphemeris e;
    e.satellite = other_system(Constellation::glonass);
    e.toe = toe;
    e.position_m = {7003e3, -12206e3, 21280e3};
    e.velocity_mps = {780, 2800, 1300};
    return e;
}

TEST(NavigationData, KeepsToTheValidityOfEachSystem) {
    SbasEphemeris sbas;
    sbas.satellite = other_system(Constellation::sbas);
    sbas.toe = monday;
    const auto inav = NavigationMessage::inav;
    const std::vector<std::pair<Ephemeris, Nanoseconds>> rows{
        {plain_record(monday), 7200s},
        {plain_record(monday, other_system(Constellation::qzss)), 7200s},
        {record_of_message(monday, other_system(Constellation::galileo), inav), 14400s},
        {record_of_message(monday, other_system(Constellation::beidou), NavigationMessage::d1), 21600s},
        {glonass_record(monday), 1800s},
        {sbas, 360s},
        {record_of_message(monday, {Constellation::gps, 20}, NavigationMessage::almanac), 604800s},
    };
    for (const EphemerisRule rule : {EphemerisRule::forward, EphemerisRule::nearest})
        for (const auto& [record, validity] : rows) {
            const SatelliteId id = satellite_of(record);
            const NavigationData data = data_of({record}, rule);
            EXPECT_TRUE(data.ephemeris(id, monday + validity)) << to_string(id);
            EXPECT_FALSE(data.ephemeris(id, monday + validity + 1ns)) << to_string(id);
            EXPECT_EQ(data.span()->last, monday + validity);
            const NavigationData bounded({record}, std::nullopt, "test", {rule, Seconds(60)});
            EXPECT_FALSE(bounded.ephemeris(id, monday + 61s));
        }
}

TEST(NavigationData, NeverMixesMessages) {
    const SatelliteId e12 = other_system(Constellation::galileo);
    const SatelliteId e13{Constellation::galileo, 13};
    const auto inav = record_of_message(monday, e12, NavigationMessage::inav);
    const auto fnav = record_of_message(monday + 10min, e12, NavigationMessage::fnav);
    const auto other = record_of_message(monday, e13, NavigationMessage::fnav);
    const NavigationData both = data_of({inav, fnav, other});
    EXPECT_EQ(message_of(*both.ephemeris(e12, monday + 10min)), NavigationMessage::inav);
    ASSERT_TRUE(both.ephemeris(e13, monday)) << "of this one there is nothing else";
    EXPECT_EQ(message_of(*both.ephemeris(e13, monday)), NavigationMessage::fnav);
    EXPECT_EQ(data_of({fnav, other}).record_count(), 2u);

    const auto almanac = record_of_message(monday + 3h, g15, NavigationMessage::almanac);
    const NavigationData mixed = data_of({plain_record(monday), almanac});
    EXPECT_FALSE(mixed.ephemeris(g15, monday + 3h)) << "an almanac is no ephemeris that has aged";
    EXPECT_TRUE(data_of({almanac}).ephemeris(g15, monday + 3h));
}

// ECEF positions at one time of day before and after a move.
double displacement_by_move(const Ephemeris& record, std::int64_t days) {
    const Ephemeris moved = moved_by_days(record, days);
    double worst = 0;
    for (const auto offset : {-120min, 0min, 15min, 120min}) {
        const GpsTime then = toe_of(record) + offset;
        const GpsTime now = then + std::chrono::days(days);
        const Displacement<Ecef> d = satellite_state(moved, now).position - satellite_state(record, then).position;
        worst = std::max(worst, d.length().value());
    }
    return worst;
}

TEST(Rebase, KeepsEcefPositionsAtTheSameTimeOfDay) {
    // Two records near the ends of a week, so that moves cross the week's border in both directions.
    for (const double tow : {3600.0, 302400.0, 604800.0 - 16})
        for (const std::int64_t days : {-8000, -8, -7, -6, -1, 0, 1, 6, 7, 8, 8000})
            EXPECT_LT(displacement_by_move(plain_record(to_gps_time(2111, tow)), days), 1e-5)
                << tow << " s, " << days << " days";
}

TEST(Rebase, KeepsEcefPositionsOfEverySystem) {
    const GpsTime toe = to_gps_time(2111, 604800.0 - 16);
    for (const std::int64_t days : {-8, -1, 1, 6, 7, 8000}) {
        for (const int number : {3, 21, 60})
            EXPECT_LT(displacement_by_move(plain_record(toe, {Constellation::beidou, number}), days), 1e-5) << number;
        EXPECT_LT(displacement_by_move(plain_record(toe, other_system(Constellation::galileo)), days), 1e-5);
        EXPECT_EQ(displacement_by_move(glonass_record(toe), days), 0);
    }
}

// Of GLONASS the time of day is one of UTC: readers round t_b to a quarter of an hour.
TEST(Rebase, KeepsTheQuarterHoursOfGlonass) {
    const LeapSeconds& leap = LeapSeconds::announced();
    const GlonassEphemeris record = glonass_record(to_gps_time(UtcTime{2009, 4, 1, 12, 15, 0}, leap));
    const auto moved_to = [&](std::int64_t days) {
        return to_utc(toe_of(moved_by_days(Ephemeris(record), days)), leap);
    };
    EXPECT_EQ(moved_to(6239), (UtcTime{2026, 5, 1, 12, 15, 0}));
    EXPECT_EQ(moved_to(-3622), (UtcTime{1999, 5, 2, 12, 15, 0}));
    EXPECT_EQ(moved_to(0), (UtcTime{2009, 4, 1, 12, 15, 0}));
}

// Three leap seconds came between 2009 and 2026, one at the end of 2016: records of either side of it go on in one
// orbit.
TEST(Rebase, KeepsGlonassOrbitsWhereLeapSecondsCome) {
    const LeapSeconds& leap = LeapSeconds::announced();
    GlonassEphemeris record = glonass_record(to_gps_time(UtcTime{2009, 4, 1, 12, 15, 0}, leap));
    record.clock_drift = 1e-11;
    EXPECT_LT(displacement_by_move(record, 6239), 0.01);
    EXPECT_LT(displacement_by_move(record, -3622), 0.01);
    const auto moved = std::get<GlonassEphemeris>(moved_by_days(Ephemeris(record), 6239));
    EXPECT_NEAR(moved.clock_bias, 3e-11, 1e-20) << "three seconds after the record's time";

    const GpsTime day_before = to_gps_time(UtcTime{2016, 12, 30, 23, 45, 0}, leap);
    const Ephemeris first = glonass_record(day_before);
    const Ephemeris second = carried_to(first, day_before + 30min);
    const GpsTime between = day_before + std::chrono::days(1) + 15min;
    const auto at = [&](const Ephemeris& r) { return satellite_state(moved_by_days(r, 1), between).position; };
    EXPECT_LT((at(first) - at(second)).length().value(), 0.01);
}

TEST(Rebase, KeepsTimeOfDayAndClock) {
    KeplerEphemeris record = plain_record(to_gps_time(1590, 345584.0));
    record.toc = record.toe - 16s;
    const KeplerEphemeris moved = moved_by_days(record, 5000);
    EXPECT_EQ(moved.toe - record.toe, Nanoseconds(std::chrono::days(5000)));
    EXPECT_EQ(moved.toc - record.toc, Nanoseconds(std::chrono::days(5000)));
    EXPECT_EQ(moved.af0, record.af0);
}

TEST(Rebase, BringsADayOfDataToTheStart) {
    std::vector<Ephemeris> records;
    for (int hour = 0; hour <= 22; hour += 2)
        for (const int number : {3, 15, 22})
            records.push_back(plain_record(monday + std::chrono::hours(hour), {Constellation::gps, number}));
    // A stray record of the day before must not pull the data to its own day.
    records.push_back(plain_record(monday - 6h, {Constellation::gps, 3}));
    const NavigationData data = data_of(records);
    for (const auto& start :
         {to_gps_time(2300, 0.0), to_gps_time(2300, 43200.0), to_gps_time(1100, 86399.0), monday + 1h}) {
        const Result<NavigationData> moved = rebased(data, start);
        ASSERT_TRUE(moved);
        EXPECT_EQ(moved->record_count(), data.record_count());
        EXPECT_EQ(moved->satellites_at(start), 3u);
        const Nanoseconds shift = moved->span()->first - data.span()->first;
        EXPECT_EQ(shift % Nanoseconds(std::chrono::days(1)), Nanoseconds(0));
        EXPECT_EQ(moved->description(), data.description());
    }
    EXPECT_EQ(rebased(data, monday + 1h)->span()->first, data.span()->first) << "data of the same day stays";
}

TEST(Rebase, LeavesWhatItWouldMovePastTheEndOfTime) {
    const GpsTime two_centuries_on = monday + std::chrono::days(73'000);
    const NavigationData data = data_of({plain_record(monday), plain_record(two_centuries_on)});
    const Result<NavigationData> moved = rebased(data, two_centuries_on + std::chrono::days(1'234));
    ASSERT_TRUE(moved);
    EXPECT_EQ(moved->satellites_at(two_centuries_on + std::chrono::days(1'234)), 1u);
    EXPECT_EQ(moved->record_count(), 1u);
}

TEST(Rebase, RefusesATimeOfDayWithoutData) {
    const NavigationData data = data_of({plain_record(monday + 12h)});
    EXPECT_TRUE(rebased(data, to_gps_time(2300, 10 * 3600.0)));
    const Result<NavigationData> refused = rebased(data, to_gps_time(2300, 9 * 3600.0));
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, ErrorCode::usage);
    EXPECT_NE(refused.error().message.find("test data"), std::string::npos);
    EXPECT_NE(refused.error().message.find("09:00:00"), std::string::npos) << refused.error().message;
    EXPECT_FALSE(rebased(data_of({}), monday));
}

}  // namespace
}  // namespace skyloop::test
