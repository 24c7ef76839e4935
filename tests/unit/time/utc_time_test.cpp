#include "base/time/utc_time.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "base/core/random.hpp"
#include "support/oracle_table.hpp"

namespace skyloop {
namespace {

using namespace std::chrono_literals;
using test::OracleRow;

const LeapSeconds& announced() { return LeapSeconds::announced(); }

UtcTime utc_of(const OracleRow& row) {
    const auto nanoseconds = static_cast<std::int64_t>(std::llround(row.number("utc_s") * 1e9));
    return {static_cast<int>(row.integer("utc_y")),
            static_cast<unsigned>(row.integer("utc_m")),
            static_cast<unsigned>(row.integer("utc_d")),
            static_cast<unsigned>(row.integer("utc_h")),
            static_cast<unsigned>(row.integer("utc_min")),
            static_cast<unsigned>(nanoseconds / 1'000'000'000),
            static_cast<std::uint32_t>(nanoseconds % 1'000'000'000)};
}

// The oracle writes calendars cut to the second.
std::string to_the_second(const UtcTime& calendar) {
    std::string text = format_utc(calendar, 0);
    text.pop_back();
    return text;
}

TEST(UtcOracle, GpsTimeWeekAndLeapSecondsAgree) {
    for (const OracleRow& row : test::oracle_rows("time_utc_gps.csv")) {
        SCOPED_TRACE(row.id());
        const GpsTime time = to_gps_time(utc_of(row), announced());
        const WeekAndTow gps = week_and_tow(time);
        EXPECT_EQ(announced().offset(time), row.integer("leap_gps_minus_utc_s"));
        EXPECT_EQ(gps.week, row.integer("gps_week"));
        EXPECT_EQ(gps.week % 1024, row.integer("gps_week_mod1024"));
        EXPECT_EQ(gps.week % 8192, row.integer("gps_week_mod8192"));
        EXPECT_NEAR(gps.tow_seconds(), row.number("gps_tow_s"), 1e-9);
        EXPECT_EQ(to_the_second(gps_calendar(time)), row.text("gpst_calendar"));
        EXPECT_EQ(to_utc(time, announced()), utc_of(row));
    }
}

TEST(UtcOracle, CalendarCountsAgree) {
    for (const OracleRow& row : test::oracle_rows("time_utc_gps.csv")) {
        SCOPED_TRACE(row.id());
        const UtcTime utc = utc_of(row);
        EXPECT_EQ(static_cast<std::int64_t>(day_of_year(utc)), row.integer("doy_utc"));
        EXPECT_NEAR(day_of_year(utc), row.number("doy_utc_fraction_1based"), 2e-12);
        EXPECT_EQ(modified_julian_day(utc), row.integer("mjd_utc"));
    }
}

TEST(UtcOracle, OtherSystemsAgree) {
    for (const OracleRow& row : test::oracle_rows("time_utc_gps.csv")) {
        SCOPED_TRACE(row.id());
        const GpsTime time = to_gps_time(utc_of(row), announced());
        if (!row.empty("bdt_week")) {
            EXPECT_EQ(bdt_week_and_tow(time).week, row.integer("bdt_week"));
            EXPECT_NEAR(bdt_week_and_tow(time).tow_seconds(), row.number("bdt_tow_s"), 1e-9);
        }
        if (!row.empty("gst_week")) {
            EXPECT_EQ(gst_week_and_tow(time).week, row.integer("gst_week"));
        }
        // GLONASST = UTC + 3 h (GLONASS ICD 5.1, 3.3.3); no row of the table stands in a leap second.
        const UtcTime moscow = to_utc(time + 3h, LeapSeconds::constant(announced().offset(time)));
        EXPECT_EQ(to_the_second(moscow), row.text("glonasst_calendar"));
    }
}

// The last second before each step is 23:59:60, the one after it 00:00:00, and no instant is told twice.
TEST(LeapSecondSteps, EveryInstantAroundEachHasItsOwnName) {
    ASSERT_EQ(announced().steps().size(), 18u);
    int expected_offset = 0;
    for (const LeapSeconds::Step& step : announced().steps()) {
        SCOPED_TRACE(format_utc(to_utc(step.from, announced())));
        EXPECT_EQ(step.offset, ++expected_offset);
        EXPECT_EQ(announced().offset(step.from - 1ns), step.offset - 1);
        EXPECT_EQ(announced().offset(step.from), step.offset);
        UtcTime earlier = to_utc(step.from - 4s, announced());
        for (GpsTime time = step.from - 3'750ms; time < step.from + 4s; time += 250ms) {
            const UtcTime utc = to_utc(time, announced());
            EXPECT_GT(utc, earlier);
            EXPECT_EQ(utc.second == 60, time >= step.from - 1s && time < step.from) << format_utc(utc);
            EXPECT_EQ(to_gps_time(utc, announced()), time) << format_utc(utc);
            earlier = utc;
        }
    }
}

TEST(LeapSecondSteps, TheLastOneIsSpelledOut) {
    const GpsTime midnight = to_gps_time({2017, 1, 1, 0, 0, 0, 0}, announced());
    EXPECT_EQ(midnight, to_gps_time(1930, 18.0));
    EXPECT_EQ(format_utc(to_utc(midnight - 1ns, announced()), 9), "2016-12-31T23:59:60.999999999Z");
    EXPECT_EQ(format_utc(to_utc(midnight - 1s, announced()), 0), "2016-12-31T23:59:60Z");
    EXPECT_EQ(format_utc(to_utc(midnight - 1s - 1ns, announced()), 9), "2016-12-31T23:59:59.999999999Z");
    EXPECT_EQ(format_utc(to_utc(midnight, announced()), 0), "2017-01-01T00:00:00Z");
    EXPECT_EQ(to_gps_time({2016, 12, 31, 23, 59, 60, 500'000'000}, announced()), midnight - 500ms);
}

TEST(LeapSecondSteps, AComingOneIsData) {
    std::vector<LeapSeconds::Step> steps = announced().steps();
    const GpsTime midnight = to_gps_time({2030, 1, 1, 0, 0, 0, 0}, announced());
    steps.push_back({midnight + 1s, 19});
    const LeapSeconds coming(steps);
    EXPECT_EQ(format_utc(to_utc(midnight, coming), 0), "2029-12-31T23:59:60Z");
    EXPECT_EQ(format_utc(to_utc(midnight + 1s, coming), 0), "2030-01-01T00:00:00Z");
    EXPECT_EQ(to_gps_time({2030, 1, 1, 0, 0, 0, 0}, coming), midnight + 1s);
    EXPECT_EQ(to_gps_time({2029, 12, 31, 23, 59, 60, 0}, coming), midnight);
}

TEST(LeapSecondSteps, ANegativeOneLeavesOutASecond) {
    std::vector<LeapSeconds::Step> steps = announced().steps();
    const GpsTime midnight = to_gps_time({2030, 1, 1, 0, 0, 0, 0}, announced());
    steps.push_back({midnight - 1s, 17});
    const LeapSeconds coming(steps);
    EXPECT_EQ(format_utc(to_utc(midnight - 1s - 1ns, coming), 9), "2029-12-31T23:59:58.999999999Z");
    EXPECT_EQ(format_utc(to_utc(midnight - 1s, coming), 0), "2030-01-01T00:00:00Z");
    EXPECT_EQ(to_gps_time({2030, 1, 1, 0, 0, 0, 0}, coming), midnight - 1s);
}

TEST(LeapSecondSteps, AConstantHoldsForAllTime) {
    const LeapSeconds sixteen = LeapSeconds::constant(16);
    EXPECT_EQ(sixteen.offset(GpsTime(0s)), 16);
    EXPECT_EQ(sixteen.offset(to_gps_time(4000, 0.0)), 16);
    const UtcTime utc{2024, 3, 5, 12, 0, 0, 0};
    EXPECT_EQ(to_gps_time(utc, sixteen), to_gps_time(utc, announced()) - 2s);
    EXPECT_EQ(to_utc(to_gps_time(utc, sixteen), sixteen), utc);
}

TEST(LeapSecondSteps, ABelieverOfTheAnnouncedOnesCountsToSixtyAndAnyOtherJustSubtracts) {
    const GpsTime step = to_gps_time({2017, 1, 1, 0, 0, 0, 0}, announced()) - 1s;
    const int before = announced().offset(step - 1s);
    EXPECT_EQ(to_utc(step, LeapSeconds::believed(step, announced().offset(step))).second, 60);
    EXPECT_EQ(to_utc(step, LeapSeconds::believed(step, before - 1)).second, 1);
    EXPECT_EQ(LeapSeconds::believed(step, before - 1).offset(step), before - 1);
}

TEST(UtcRoundTrip, HoldsForRandomInstants) {
    RandomStream random(1, "test.utc_round_trip");
    const auto span = static_cast<double>((to_gps_time({2100, 1, 1, 0, 0, 0, 0}, announced()) - GpsTime(0s)).count());
    for (int i = 0; i < 20'000; ++i) {
        const GpsTime time(Nanoseconds(static_cast<std::int64_t>(random.uniform() * span)));
        const UtcTime utc = to_utc(time, announced());
        ASSERT_EQ(to_gps_time(utc, announced()), time) << format_utc(utc, 9);
        ASSERT_EQ(parse_utc(format_utc(utc, 9)).value(), utc);
        const UtcTime calendar = gps_calendar(time);
        ASSERT_EQ(gps_calendar_time(calendar.year, calendar.month, calendar.day, calendar.hour, calendar.minute,
                                    calendar.second) +
                      Nanoseconds(calendar.nanosecond),
                  time);
    }
}

TEST(GpsCalendar, CarriesASecondOf60) {
    EXPECT_EQ(gps_calendar_time(2024, 12, 31, 23, 59, 60.0), gps_calendar_time(2025, 1, 1, 0, 0, 0.0));
    EXPECT_EQ(gps_calendar_time(1980, 1, 6, 0, 0, 0.0), GpsTime(0s));
    EXPECT_EQ(gps_calendar_time(2010, 7, 1, 12, 0, 0.5), to_gps_time(1590, 388'800.5));
}

TEST(ParseUtc, ReadsIso8601) {
    const UtcTime noon{2024, 3, 5, 12, 0, 0, 0};
    for (const char* text : {"2024-03-05T12:00:00Z", "2024-03-05T12:00:00", "2024-03-05 12:00:00Z",
                             "2024-03-05 12:00:00.000", "2024-03-05T12:00:00,0Z"})
        EXPECT_EQ(parse_utc(text).value(), noon) << text;
    EXPECT_EQ(parse_utc("2024-02-29T23:59:59.000000001Z").value(), (UtcTime{2024, 2, 29, 23, 59, 59, 1}));
    EXPECT_EQ(parse_utc("2024-03-05T12:00:00.25Z").value().nanosecond, 250'000'000u);
    EXPECT_EQ(parse_utc("2016-12-31T23:59:60.5Z").value(), (UtcTime{2016, 12, 31, 23, 59, 60, 500'000'000}));
    EXPECT_EQ(parse_utc("2015-06-30T23:59:60Z").value(), (UtcTime{2015, 6, 30, 23, 59, 60, 0}));
    EXPECT_EQ(parse_utc("1980-01-06T00:00:00Z").value(), UtcTime{});
}

TEST(ParseUtc, RefusesAllElseAndQuotesIt) {
    for (const char* text : {"",
                             "now",
                             "2024",
                             "2024-03-05",
                             "2024-03-05T12:00",
                             "2024-03-05T12:00:00ZZ",
                             "2024-03-05T12:00:00+02:00",
                             "2024-3-5T12:00:00Z",
                             "2024-13-05T12:00:00Z",
                             "2024-00-05T12:00:00Z",
                             "2023-02-29T12:00:00Z",
                             "2024-04-31T12:00:00Z",
                             "2024-03-00T12:00:00Z",
                             "2024-03-05T24:00:00Z",
                             "2024-03-05T12:60:00Z",
                             "2024-03-05T12:00:61Z",
                             "2024-03-05T12:00:60Z",
                             "2024-03-05T23:59:60Z",
                             "2015-12-31T23:59:60Z",
                             "2017-06-30T23:59:60Z",
                             "2029-12-31T23:59:60Z",
                             "2016-12-31T22:59:60Z",
                             "2024-03-05T12:00:00.Z",
                             "2024-03-05T12:00:00.1234567890Z",
                             "1979-12-31T00:00:00Z",
                             "1980-01-05T23:59:59Z",
                             "2200-01-01T00:00:00Z",
                             " 2024-03-05T12:00:00Z",
                             "2024-03-05T12:00:00Z ",
                             "-024-03-05T12:00:00Z",
                             "2024/03/05T12:00:00Z"}) {
        const Result<UtcTime> result = parse_utc(text);
        ASSERT_FALSE(result.has_value()) << text;
        EXPECT_EQ(result.error().code, ErrorCode::usage);
        EXPECT_THAT(result.error().message, testing::HasSubstr("'" + std::string(text) + "'"));
        EXPECT_THAT(result.error().message, testing::HasSubstr("2024-03-05T12:00:00Z"));
    }
}

TEST(ParseInstant, ReadsWhatPeopleAndProgramsWrite) {
    const UtcTime noon{2026, 3, 1, 12, 0, 0, 0};
    for (const char* text :
         {"2026-03-01T12:00:00Z", "2026-03-01 12:00:00", "2026-03-01T12:00:00+00:00", "2026-03-01T12:00:00.000-00:00",
          "20260301T120000Z", "20260301T120000.0+0000", "2026-03-01T12:00Z", "2026-03-01T12:00", "20260301T1200",
          "2026-03-01T14:00:00+02:00", "2026-03-01T08:30-0330", "2026-03-02T02:00:00+14", "2026-02-28T23:00:00-13:00"})
        EXPECT_EQ(parse_instant(text).value(), noon) << text;
    for (const char* text : {"2026-03-01", "20260301"})
        EXPECT_EQ(parse_instant(text).value(), (UtcTime{2026, 3, 1, 0, 0, 0, 0})) << text;
    EXPECT_EQ(parse_instant("2026-03-01T12:00:00.123456+00:00").value().nanosecond, 123'456'000u);
    EXPECT_EQ(parse_instant("2017-01-01T00:59:60+01:00").value(), (UtcTime{2016, 12, 31, 23, 59, 60, 0}));
}

TEST(ParseInstant, RefusesAllElseAndQuotesIt) {
    for (const char* text : {"", "now", "2026", "2026-03", "2026-0301", "202603-01", "2026-03-01T", "2026-03-01T12",
                             "2026-03-01T1200", "20260301T12:00", "2026-03-01T12:00:", "2026-03-01T12:00:00.Z",
                             "2026-03-01T12:00:00+15:00", "2026-03-01T12:00:00 UTC", "2026-02-29T12:00:00Z",
                             "2026-03-01T24:00Z", "2026-03-01T12:00:60Z", "1980-01-06T00:00:00+01:00", "2200-01-01"}) {
        const Result<UtcTime> result = parse_instant(text);
        ASSERT_FALSE(result.has_value()) << text;
        EXPECT_THAT(result.error().message, testing::HasSubstr("'" + std::string(text) + "'"));
    }
}

TEST(ParseUtc, NeverFailsOtherwiseOnNoise) {
    RandomStream random(1, "test.parse_utc");
    constexpr std::string_view letters = "0123456789-:TZ ., \x01";
    for (int i = 0; i < 20'000; ++i) {
        std::string text = "2024-03-05T12:00:00.5Z";
        for (int edits = 0; edits < 3; ++edits)
            text[random.bits() % text.size()] = letters[random.bits() % letters.size()];
        const Result<UtcTime> result = parse_utc(text);
        if (result) {
            ASSERT_EQ(to_utc(to_gps_time(*result, announced()), announced()).year, result->year);
        }
    }
}

TEST(FormatUtc, CutsAndDoesNotRound) {
    const UtcTime utc{2024, 3, 5, 1, 2, 59, 999'999'999};
    EXPECT_EQ(format_utc(utc), "2024-03-05T01:02:59.999Z");
    EXPECT_EQ(format_utc(utc, 0), "2024-03-05T01:02:59Z");
    EXPECT_EQ(format_utc(utc, 9), "2024-03-05T01:02:59.999999999Z");
    EXPECT_EQ(format_utc({2024, 3, 5, 0, 0, 0, 7'000'000}, 2), "2024-03-05T00:00:00.00Z");
}

TEST(UtcTime, FindsMidnightsByTheCalendar) {
    EXPECT_EQ(midnight_of({2016, 12, 31, 23, 59, 60, 5}, 1), (UtcTime{2017, 1, 1, 0, 0, 0, 0}));
    EXPECT_EQ(midnight_of({2024, 3, 1, 12, 0, 0, 0}, -1), (UtcTime{2024, 2, 29, 0, 0, 0, 0}));
    EXPECT_EQ(midnight_of({2024, 3, 1, 12, 0, 0, 0}, 0), (UtcTime{2024, 3, 1, 0, 0, 0, 0}));
}

TEST(UtcTime, OrdersByTime) {
    EXPECT_LT((UtcTime{2024, 3, 5, 1, 2, 3, 4}), (UtcTime{2024, 3, 5, 1, 2, 3, 5}));
    EXPECT_LT((UtcTime{2024, 3, 5, 23, 59, 59, 0}), (UtcTime{2024, 3, 6, 0, 0, 0, 0}));
    EXPECT_DOUBLE_EQ((UtcTime{2024, 3, 5, 1, 2, 3, 500'000'000}).seconds_of_day(), 3723.5);
    EXPECT_DOUBLE_EQ(day_of_year({2024, 12, 31, 12, 0, 0, 0}), 366.5);
}

// POSIX counts the second before and after the leap second of 2016 as neighbours; in GPS time two seconds pass.
TEST(UtcTime, CountsWithoutLeapSecondsFindThem) {
    const auto count_of = [](const UtcTime& utc, int offset) {
        return to_gps_time(utc, LeapSeconds::announced()).time_since_epoch() - std::chrono::seconds(offset);
    };
    const UtcTime before{2016, 12, 31, 23, 59, 59, 0}, after{2017, 1, 1, 0, 0, 0, 0};
    EXPECT_EQ(count_of(after, 18) - count_of(before, 17), Nanoseconds(std::chrono::seconds(1)));
    EXPECT_EQ(from_utc_count(count_of(before, 17), LeapSeconds::announced()),
              to_gps_time(before, LeapSeconds::announced()));
    EXPECT_EQ(from_utc_count(count_of(after, 18), LeapSeconds::announced()),
              to_gps_time(after, LeapSeconds::announced()));
}

}  // namespace
}  // namespace skyloop
