// Each fault of time in the client's bytes, and its end.
#include <gtest/gtest.h>

#include "firmware/messages/field_values.hpp"
#include "receiver/protocol/ubx_time.hpp"
#include "receiver_bench.hpp"

namespace skyloop {
namespace {

using namespace std::chrono_literals;
using fault_test::Given;
using fault_test::make_fault;
using fault_test::ReceiverBench;

std::string date_of(const NavPvt& pvt) {
    return std::to_string(pvt.year) + "-" + std::to_string(pvt.month) + "-" + std::to_string(pvt.day);
}

// The epoch after the end of a fault tells the true time.
void expect_true_time(ReceiverBench& bench) {
    bench.end();
    const NavPvt after = bench.next();
    const GpsTime epoch = std::chrono::floor<std::chrono::seconds>(bench.now());
    const UtcTime utc = to_utc(epoch, LeapSeconds::announced());
    EXPECT_EQ(after.i_tow, static_cast<std::uint32_t>(week_and_tow(epoch).tow / std::chrono::milliseconds(1)));
    EXPECT_EQ(after.year, utc.year);
    EXPECT_EQ(after.day, utc.day);
    EXPECT_EQ(after.second, utc.second);
    EXPECT_EQ(after.valid & 7, 7);
    EXPECT_EQ(bench.last<NavTimegps>().week, week_and_tow(epoch).week);
    EXPECT_EQ(bench.last<NavTimegps>().leap_s, 18);
}

TEST(TimeFaults, BelievesAWrongNumberOfLeapSeconds) {
    ReceiverBench bench;
    const NavPvt before = bench.next();
    const std::string clock = bench.sentence("GGA")[1];
    bench.begin("leap_second_wrong");
    const NavPvt wrong = bench.next();
    EXPECT_EQ(wrong.second, before.second + 1 + 2) << "two leap seconds too few: UTC is ahead";
    EXPECT_EQ(wrong.i_tow, before.i_tow + 1000) << "GPS time is right";
    EXPECT_EQ(wrong.valid & 4, 0);
    EXPECT_EQ(bench.last<NavTimegps>().leap_s, 16);
    EXPECT_NEAR(std::stod(bench.sentence("GGA")[1]) - std::stod(clock), 3, 1e-6);
    expect_true_time(bench);
}

TEST(TimeFaults, CountsALeapSecondAtTheEndOfTheDay) {
    ReceiverBench bench("2024-03-05T23:59:55Z");
    bench.begin("leap_second_event");
    bench.wait(3);
    EXPECT_EQ(bench.last<NavTimels>().ls_change, 1);
    bench.forget();
    bench.wait(5);
    std::vector<int> seconds;
    for (const NavPvt& pvt : bench.all<NavPvt>())
        seconds.push_back(pvt.second);
    EXPECT_EQ(seconds, (std::vector<int>{59, 60, 0, 1, 2}));
    EXPECT_EQ(bench.last<NavTimegps>().leap_s, 19);
    EXPECT_EQ(bench.sentence("RMC")[1], "000002.00");
    EXPECT_EQ(date_of(bench.last<NavPvt>()), "2024-3-6");
    expect_true_time(bench);
}

// Where one was announced for that day, it is the same one.
TEST(TimeFaults, CountsAnAnnouncedLeapSecondOnce) {
    ReceiverBench bench("2016-12-31T23:59:55Z");
    bench.begin("leap_second_event");
    bench.wait(5);
    EXPECT_EQ(bench.last<NavPvt>().second, 60);
    EXPECT_EQ(bench.last<NavTimegps>().leap_s, 17);
    bench.fix().leap_seconds = 18;
    EXPECT_EQ(bench.next().second, 0);
    EXPECT_EQ(bench.last<NavTimegps>().leap_s, 18);
    EXPECT_EQ(bench.last<NavTimels>().curr_ls, 18);
}

TEST(TimeFaults, LeavesASecondOutAtTheEndOfTheDay) {
    ReceiverBench bench("2024-03-05T23:59:55Z");
    bench.begin("leap_second_event", {{"change", std::string("deleted")}});
    bench.wait(2);
    bench.forget();
    bench.wait(3);
    std::vector<int> seconds;
    for (const NavPvt& pvt : bench.all<NavPvt>())
        seconds.push_back(pvt.second);
    EXPECT_EQ(seconds, (std::vector<int>{58, 0, 1}));
    expect_true_time(bench);
}

TEST(TimeFaults, DatesLie1024WeeksBack) {
    ReceiverBench bench;
    const NavPvt before = bench.next();
    const int week = bench.last<NavTimegps>().week;
    bench.begin("week_rollover");
    const NavPvt back = bench.next();
    EXPECT_EQ(back.i_tow, before.i_tow + 1000);
    EXPECT_EQ(bench.last<NavTimegps>().week, week - 1024);
    EXPECT_EQ(date_of(back), "2004-7-20");
    EXPECT_EQ(bench.sentence("RMC")[9], "200704");
    expect_true_time(bench);
}

TEST(TimeFaults, ChangesTheWeekAfterTheTimeOfWeekOrBefore) {
    for (const double lag : {2.0, -2.0}) {
        ReceiverBench bench("2024-03-09T23:59:37Z");  // 5 s to the end of GPS week 2304
        bench.begin("week_order", {{"lag_s", lag}});
        bench.forget();
        bench.wait(9);
        std::vector<int> weeks;
        for (const NavTimegps& m : bench.all<NavTimegps>())
            weeks.push_back(m.week);
        const std::size_t begun_anew = 4;  // this epoch has time of week 0
        ASSERT_EQ(bench.all<NavTimegps>()[begun_anew].i_tow, 0U);
        EXPECT_EQ(bench.all<NavPvt>()[begun_anew].i_tow, 0U);
        const int shown = lag > 0 ? 2304 : 2305;
        for (std::size_t i = 0; i < weeks.size(); ++i) {
            const bool wrong =
                lag > 0 ? i == begun_anew || i == begun_anew + 1 : i == begun_anew - 1 || i == begun_anew - 2;
            EXPECT_EQ(weeks[i], wrong ? shown : i < begun_anew ? 2304 : 2305) << i;
        }
        expect_true_time(bench);
    }
}

TEST(TimeFaults, StepsByItsAmount) {
    ReceiverBench bench;
    const NavPvt before = bench.next();
    bench.begin("time_step", {{"step_s", 7200.0}}, 0.5);
    const NavPvt stepped = bench.next();
    EXPECT_EQ(stepped.i_tow, before.i_tow + 1000 + 3'600'000);
    EXPECT_EQ(stepped.hour, before.hour + 1);
    EXPECT_EQ(stepped.lat, before.lat);
    expect_true_time(bench);
    bench.begin("time_step", {{"step_s", -1e9}});
    EXPECT_EQ(bench.next().year, 1992);
    expect_true_time(bench);
}

TEST(TimeFaults, RunsBackwards) {
    ReceiverBench bench;
    bench.wait(1);
    bench.begin("time_backwards");
    const NavPvt first = bench.next(), second = bench.next(), third = bench.next();
    EXPECT_EQ(second.i_tow, first.i_tow - 1000);
    EXPECT_EQ(third.i_tow, first.i_tow - 2000);
    expect_true_time(bench);
}

TEST(TimeFaults, DriftsAway) {
    ReceiverBench bench;
    bench.wait(1);
    bench.begin("time_drift", {{"ppm", 10'000.0}});
    const NavPvt first = bench.next(), second = bench.next();
    EXPECT_EQ(second.i_tow, first.i_tow + 1010);
    expect_true_time(bench);
}

// What is reported at an instant, with these faults under way.
firmware::NavigationState reported_with(const std::vector<Fault*>& faults, GpsTime now) {
    firmware::NavigationState state;
    state.epoch.fix.time = now;
    state.epoch.fix.leap_seconds = 18;
    for (Fault* fault : faults)
        fault->report(state, {now, Seconds(1), 1, nullptr, nullptr});
    return state;
}

GpsTime instant(const char* utc) { return to_gps_time(*parse_utc(utc), LeapSeconds::announced()); }

TEST(TimeFaults, RunBackwardsFromTheTrueTimeBesideOthers) {
    const GpsTime start = instant("2024-03-05T12:00:00Z");
    const std::map<std::string, Nanoseconds> others{{"time_step", 3600s}, {"week_rollover", -1024s * seconds_per_week}};
    for (const auto& [kind, shift] : others) {
        auto other = make_fault(kind, {}), backwards = make_fault("time_backwards", {});
        ASSERT_TRUE(other && backwards);
        for (int second = 0; second < 6; ++second) {
            const GpsTime now = start + std::chrono::seconds(second);
            const GpsTime right = start - std::chrono::seconds(second);
            if (second < 3)
                EXPECT_EQ(reported_with({&*other, &*backwards}, now).epoch.fix.time, right + shift) << kind;
            else
                EXPECT_EQ(reported_with({&*backwards}, now).epoch.fix.time, right) << kind << " has ended";
        }
    }
}

TEST(TimeFaults, AddUp) {
    const GpsTime start = instant("2024-03-05T12:00:00Z");
    auto one = make_fault("time_backwards", {}), other = make_fault("time_backwards", {});
    auto drift = make_fault("time_drift", {{"ppm", 500'000.0}});
    ASSERT_TRUE(one && other && drift);
    for (int second = 0; second < 4; ++second)
        EXPECT_EQ(reported_with({&*one, &*other, &*drift}, start + std::chrono::seconds(second)).epoch.fix.time,
                  start - second * 2500ms);  // 1 − 2 − 2 + 0.5
}

TEST(TimeFaults, CountALeapSecondThroughARolloverInEitherOrder) {
    const GpsTime start = instant("2024-03-05T23:59:57Z");
    for (const bool rollover_first : {true, false})
        for (const int rollover_ends : {2, 10}) {
            auto rollover = make_fault("week_rollover", {}), event = make_fault("leap_second_event", {});
            ASSERT_TRUE(rollover && event);
            std::vector<Fault*> faults{&*rollover, &*event};
            if (!rollover_first) std::swap(faults[0], faults[1]);
            for (int second = 0; second < 7; ++second) {
                if (second == rollover_ends) faults = {&*event};
                const auto state = reported_with(faults, start + std::chrono::seconds(second));
                EXPECT_EQ(state.epoch.fix.leap_seconds, second < 4 ? 18 : 19);
                ASSERT_TRUE(state.leap_event);
                EXPECT_EQ(state.leap_event->at - state.epoch.fix.time, std::chrono::seconds(4 - second));
            }
        }
}

// Two leap seconds too few: UTC is ahead, and its day ends as much earlier.
TEST(TimeFaults, BelieveAWrongNumberOfLeapSecondsAroundALeapSecondInEitherOrder) {
    const GpsTime start = instant("2024-03-05T23:59:55Z");
    for (const bool wrong_first : {true, false}) {
        auto wrong = make_fault("leap_second_wrong", {}), event = make_fault("leap_second_event", {});
        ASSERT_TRUE(wrong && event);
        std::vector<Fault*> faults{&*event};
        std::vector<int> seconds, counts;
        for (int second = 0; second < 8; ++second) {
            if (second == 1) faults.insert(wrong_first ? faults.begin() : faults.end(), &*wrong);
            if (second == 6) faults = {&*event};
            const auto state = reported_with(faults, start + std::chrono::seconds(second));
            const Fix& fix = state.epoch.fix;
            const firmware::ReportedTime told{fix.time, fix.leap_seconds, state.leap_event};
            seconds.push_back(static_cast<int>(to_utc(fix.time, firmware::counted_leap_seconds(told)).second));
            counts.push_back(fix.leap_seconds);
        }
        EXPECT_EQ(seconds, (std::vector<int>{55, 58, 59, 60, 0, 1, 0, 1}));
        EXPECT_EQ(counts, (std::vector<int>{18, 16, 16, 16, 17, 17, 19, 19}));
    }
}

TEST(TimeFaults, DoesNotKnowTheDate) {
    ReceiverBench bench;
    bench.begin("date_unknown");
    const NavPvt undated = bench.next();
    EXPECT_EQ(undated.valid & 1, 0);
    EXPECT_EQ(undated.valid & 2, 2);
    EXPECT_EQ(bench.last<NavTimegps>().valid & 3, 1) << "the time of week is known, the week is not";
    EXPECT_EQ(bench.sentence("RMC")[9], "");
    EXPECT_NE(bench.sentence("RMC")[1], "");
    expect_true_time(bench);
    bench.begin("date_unknown", {{"time_too", true}});
    EXPECT_EQ(bench.next().valid & 3, 0);
    EXPECT_EQ(bench.last<NavTimegps>().valid & 3, 0);
    EXPECT_EQ(bench.sentence("RMC")[1], "");
    expect_true_time(bench);
}

}  // namespace
}  // namespace skyloop
