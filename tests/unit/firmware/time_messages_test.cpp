#include <gtest/gtest.h>

#include "receiver/protocol/ubx_nav.hpp"
#include "receiver/protocol/ubx_time.hpp"
#include "ubx_reports.hpp"

namespace skyloop::firmware {
namespace {

using namespace std::chrono_literals;

// RECEIVER.md 4.9: UTC to the nearest 10 ms, the rest in nano.
TEST(TimeOfMessages, RoundsToTenMilliseconds) {
    UbxReport m9(9, "2012-01-01T00:00:00Z");
    m9.state.epoch.fix.time -= 700us;
    auto pvt = m9.report<NavPvt>();
    EXPECT_EQ(pvt.year, 2012);
    EXPECT_EQ(pvt.month, 1);
    EXPECT_EQ(pvt.day, 1);
    EXPECT_EQ(pvt.second, 0);
    EXPECT_EQ(pvt.nano, -700000);
    m9.state.epoch.fix.time -= 4300us;
    pvt = m9.report<NavPvt>();
    EXPECT_EQ(pvt.year, 2012);
    EXPECT_EQ(pvt.nano, -5000000);
    m9.state.epoch.fix.time -= 1ns;
    pvt = m9.report<NavPvt>();
    EXPECT_EQ(pvt.year, 2011);
    EXPECT_EQ(pvt.month, 12);
    EXPECT_EQ(pvt.day, 31);
    EXPECT_EQ(pvt.second, 59);
    EXPECT_EQ(pvt.nano, 994999999);
}

// Its clock is ahead: the whole second that it shows is not there yet. A ZED-F9T had clkB 92265, nano -92265.
TEST(TimeOfMessages, TellsTheInstantThatTheReceiversClockCallsWhole) {
    UbxReport f9(9, "2012-01-01T00:00:00Z");
    f9.state.epoch.fix.clock_bias = Metres(299792458.0 * 92265e-9);
    const auto pvt = f9.report<NavPvt>();
    EXPECT_EQ(std::tuple(pvt.year, pvt.second, pvt.nano), std::tuple(2012, 0, -92265));
    EXPECT_EQ(f9.report<NavTimeutc>().nano, -92265);
    EXPECT_EQ(f9.report<NavTimegps>().f_tow, -92265);
    EXPECT_EQ(f9.report<NavTimegps>().i_tow, pvt.i_tow);
    EXPECT_EQ(pvt.i_tow % 1000, 0u);
    EXPECT_EQ(f9.report<NavClock>().clk_b, 92265);
    EXPECT_EQ(f9.report<NavTimels>().time_to_ls_event % 86400, 0);
}

TEST(TimeOfMessages, CallsTheWholeMillisecondThatIsNearest) {
    UbxReport m8(8, "2024-03-05T12:49:23Z");
    for (const auto& [bias_ns, told] :
         {std::pair(-300e3, 300000), {12.7e6, 300000}, {0.5e6, -499999}, {-0.5e6, 499999}}) {
        m8.state.epoch.fix.clock_bias = Metres(299792458e-9 * bias_ns);
        EXPECT_EQ(m8.report<NavPvt>().nano, told);
        EXPECT_EQ(m8.report<NavPvt>().second, 23);
        EXPECT_EQ(m8.report<NavClock>().clk_b, -told);
        EXPECT_EQ(m8.report<NavPvt>().i_tow % 1000, 0u);
    }
}

TEST(TimeOfMessages, HasNoRemainderBeforeTheClockWasSolved) {
    UbxReport m8(8, "2024-03-05T12:49:23Z");
    m8.state.epoch.fix.clock_bias = Metres(60'000);
    m8.state.ever_had_fix = false;
    EXPECT_EQ(m8.report<NavPvt>().nano, 0);
    EXPECT_EQ(m8.report<NavTimegps>().f_tow, 0);
}

TEST(TimeOfMessages, KeepsTheFlooredSecondInsideIt) {
    UbxReport m8(8, "2017-07-19T08:50:01.8Z");
    m8.state.epoch.fix.time -= 100313ns;
    const auto pvt = m8.report<NavPvt>();
    EXPECT_EQ(pvt.second, 1);
    EXPECT_EQ(pvt.nano, 799899687);
    const auto utc = m8.report<NavTimeutc>();
    EXPECT_EQ(utc.nano, pvt.nano);
    EXPECT_EQ(utc.second, pvt.second);
    EXPECT_EQ(utc.valid, 0x37);
    EXPECT_EQ(m8.report<NavTimegps>().f_tow, -100313);
    EXPECT_EQ(pvt.i_tow % 200, 0u);
}

TEST(TimeOfMessages, CountsToSixtyInALeapSecond) {
    UbxReport m8(8, "2016-12-31T23:59:60Z");
    EXPECT_EQ(m8.report<NavPvt>().second, 60);
    EXPECT_EQ(m8.report<NavPvt>().day, 31);
    EXPECT_EQ(m8.report<NavTimeutc>().second, 60);
    m8.state.epoch.fix.time += 1s;
    m8.state.epoch.fix.leap_seconds = 18;
    EXPECT_EQ(m8.report<NavPvt>().second, 0);
    EXPECT_EQ(m8.report<NavPvt>().year, 2017);
}

TEST(TimeOfMessages, BelievesAWrongLeapSecond) {
    UbxReport m8(8, "2024-03-05T12:00:00Z");
    m8.state.epoch.fix.leap_seconds = 17;
    EXPECT_EQ(m8.report<NavPvt>().second, 1);
    EXPECT_EQ(m8.report<NavTimegps>().leap_s, 17);
}

TEST(TimeOfMessages, BeginsTheWeekAtZero) {
    UbxReport m9(9);
    m9.state.epoch.fix.time = to_gps_time({2300, 0ns}) - 400us;
    EXPECT_EQ(m9.report<NavTimegps>().i_tow, 0u);
    EXPECT_EQ(m9.report<NavTimegps>().week, 2300);
    EXPECT_EQ(m9.report<NavTimegps>().f_tow, -400000);
    m9.state.epoch.fix.time -= 200us;
    EXPECT_EQ(m9.report<NavTimegps>().i_tow, 604799999u);
    EXPECT_EQ(m9.report<NavTimegps>().week, 2299);
    EXPECT_EQ(m9.report<NavEoe>().i_tow, 604799999u);
}

TEST(NavTimegpsMessage, GoesFromThreeToSeven) {
    UbxReport m9(9);
    EXPECT_EQ(m9.report<NavTimegps>().valid, 7);
    EXPECT_EQ(m9.report<NavTimegps>().t_acc, 25u);
    m9.state.time.leap_seconds = false;
    EXPECT_EQ(m9.report<NavTimegps>().valid, 3);
    m9.state.time.date = false;
    EXPECT_EQ(m9.report<NavTimegps>().valid, 1) << "before the week is known";
    EXPECT_EQ(m9.report<NavTimegal>().valid, 1);
    EXPECT_EQ(m9.report<NavTimebds>().valid, 1);
    EXPECT_EQ(m9.report<NavTimeutc>().valid & 3, 1);
    EXPECT_EQ(m9.report<NavStatus>().flags & 0x0C, 8);
    m9.start_cold(5);
    EXPECT_EQ(m9.report<NavTimegps>().valid, 0);
    EXPECT_EQ(m9.report<NavTimegps>().t_acc, 4294967295u);
}

TEST(NavTimegpsMessage, CountsFromTheDateThatAllOthersShowBeforeTimeIsKnown) {
    UbxReport m9(9);
    m9.config.set(in_ram, key::navspg_wknrollover, 1867);
    m9.start_cold(5);
    EXPECT_EQ(m9.report<NavTimegps>().week, 1867);
    EXPECT_EQ(m9.report<NavTimegps>().i_tow, m9.report<NavTimeutc>().i_tow);
    EXPECT_EQ(m9.report<NavTimeutc>().year, 2015);
    EXPECT_EQ(m9.report<NavTimeutc>().month, 10);
    EXPECT_EQ(m9.report<NavTimeutc>().day, 18);
}

// One instant of the captured ZED-F9P (2025-04-25 06:38:04 UTC): NAV-TIMEGLO, BDS, GAL and QZSS beside each other.
TEST(NavTimeMessages, AgreeWithACapturedReceiver) {
    UbxReport f9(9);
    f9.state.epoch.fix.time = to_gps_time({2363, 455902s}) - 64933ns;
    const auto glonass = f9.report<NavTimeglo>();
    EXPECT_EQ(glonass.tod, 0x877Cu);
    EXPECT_EQ(glonass.n_t, 0x01E1);
    EXPECT_EQ(glonass.n_4, 8);
    EXPECT_EQ(glonass.f_tod, -64933);
    EXPECT_EQ(glonass.valid, 3);
    const auto beidou = f9.report<NavTimebds>();
    EXPECT_EQ(beidou.tow, 0x06F4D0u);
    EXPECT_EQ(beidou.week, 0x03EF);
    EXPECT_EQ(beidou.leap_s, 4);
    const auto galileo = f9.report<NavTimegal>();
    EXPECT_EQ(galileo.tow, 0x06F4DEu);
    EXPECT_EQ(galileo.week, 0x053B);
    EXPECT_EQ(galileo.leap_s, 18);
    EXPECT_EQ(f9.report<NavTimeqzss>().week, 0x093B);
    EXPECT_EQ(f9.report<NavTimeqzss>().tow, galileo.tow);
    EXPECT_EQ(f9.report<NavTimeqzss>().f_tow, -64933);
}

TEST(NavTimelsMessage, TellsWhereTheNumberIsFrom) {
    UbxReport m9(9, "2024-03-05T12:00:00Z");
    EXPECT_EQ(m9.report<NavTimels>().src_of_curr_ls, 2);
    EXPECT_EQ(m9.report<NavTimels>().curr_ls, 18);
    EXPECT_EQ(m9.report<NavTimels>().ls_change, 0);
    EXPECT_LT(m9.report<NavTimels>().time_to_ls_event, 0);
    EXPECT_EQ(m9.report<NavTimels>().valid, 3);
    m9.state.time.leap_seconds = false;
    EXPECT_EQ(m9.report<NavTimels>().src_of_curr_ls, 0) << "that of the firmware";
    EXPECT_EQ(m9.report<NavTimels>().valid, 0);
}

TEST(NavTimelsMessage, TellsWhoseSatellitesToldIt) {
    using enum Constellation;
    UbxReport m9(9);
    for (const auto& [system, now, change] :
         {std::tuple{galileo, 5, 5}, std::tuple{beidou, 4, 4}, std::tuple{glonass, 1, 6}, std::tuple{gps, 2, 2}}) {
        m9.state.time.leap_source = system;
        EXPECT_EQ(m9.report<NavTimels>().src_of_curr_ls, now);
        EXPECT_EQ(m9.report<NavTimels>().src_of_ls_change, change);
    }
    m9.state.time.leap_source.reset();
    constexpr std::uint32_t gps_signals = 0x1031001F;
    m9.config.set(in_ram, gps_signals, 0);
    EXPECT_EQ(m9.report<NavTimels>().src_of_curr_ls, 5) << "known from before: by what is on";
}

TEST(NavTimelsMessage, AnnouncesTheNextOne) {
    const UbxReport m8(8, "2016-12-31T23:00:00Z");
    const auto m = m8.report<NavTimels>();
    EXPECT_EQ(m.curr_ls, 17);
    EXPECT_EQ(m.ls_change, 1);
    EXPECT_NEAR(m.time_to_ls_event, 3600, 1);
    EXPECT_EQ(m.date_of_ls_gps_wn, 1929);  // Saturday 31 December 2016
    EXPECT_EQ(m.date_of_ls_gps_dn, 7);
}

TEST(NavClockMessage, StaysWithinHalfAMillisecond) {
    UbxReport m9(9);
    m9.state.epoch.fix.clock_bias = Metres(299792458.0 * 0.0002);
    EXPECT_EQ(m9.report<NavClock>().clk_b, 200000);
    EXPECT_EQ(m9.report<NavClock>().clk_d, 500);
    EXPECT_EQ(m9.report<NavClock>().f_acc, 834u);
    m9.state.epoch.fix.clock_bias = Metres(299792458.0 * 0.0127);
    EXPECT_EQ(m9.report<NavClock>().clk_b, -300000);
    m9.start_cold(1);
    EXPECT_EQ(m9.report<NavClock>().clk_b, 0);
    EXPECT_EQ(m9.report<NavClock>().t_acc, 4294967295u);
}

TEST(TimTpMessage, NamesTheNextPulse) {
    UbxReport m8(8);
    const auto tp = m8.report<TimTp>();
    EXPECT_EQ(tp.tow_ms, 218964000u);  // UTC grid: 12:49:24
    EXPECT_EQ(tp.tow_sub_ms, 0u);
    EXPECT_EQ(tp.week, 2304);
    EXPECT_EQ(tp.flags, 0x0B);
    EXPECT_EQ(tp.ref_info, 0x0F);
    EXPECT_LE(std::abs(tp.q_err), 15000);
    // The clock of the receiver is a bit behind at the pulse of 12:49:24: the next is that of :25.
    m8.state.epoch.fix.time += 478'999'900ns;
    EXPECT_EQ(m8.report<TimTp>().tow_ms, 218965000u);
    m8.lose_fix();
    EXPECT_EQ(m8.report<TimTp>().flags, 0x13);
    UbxReport m9(9);
    m9.lose_fix();
    EXPECT_EQ(m9.report<TimTp>().flags & 0x38, 0x30) << "TpNotLocked";
    EXPECT_EQ(m8.report<TimTp>().q_err, 0);
}

// 12:49:24 UTC of 2024-03-05 by each time base: BDT is 14 s behind GPS time, GLONASS three hours ahead of UTC.
TEST(TimTpMessage, NamesThePulseByTheTimeOfItsGrid) {
    constexpr std::uint32_t grid = 0x2005000C;
    UbxReport m8(8);
    struct Expected {
        std::uint64_t base;
        std::uint32_t tow_ms;
        std::uint16_t week;
    };
    for (const Expected& e :
         {Expected{0, 218'964'000, 2304}, Expected{1, 218'982'000, 2304}, Expected{2, 218'964'000 + 10'800'000, 2304},
          Expected{3, 218'968'000, 2304 - 1356}, Expected{4, 218'982'000, 2304 - 1024}}) {
        m8.config.set(in_ram, grid, e.base);
        EXPECT_EQ(m8.report<TimTp>().tow_ms, e.tow_ms) << e.base;
        EXPECT_EQ(m8.report<TimTp>().week, e.week) << e.base;
    }
    // Pulses of 4 s lie on whole multiples of the grid's own seconds.
    m8.config.set(in_ram, grid, 3);
    m8.config.set(in_ram, 0x40050003, 4'000'000);
    EXPECT_EQ(m8.report<TimTp>().tow_ms, 218'968'000U);
}

TEST(TimTpMessage, CountsAndNamesEachPulseOfALeapSecond) {
    UbxReport m8(8, "2016-12-31T23:59:58Z");
    const GpsTime first = m8.state.epoch.fix.time;
    constexpr std::uint32_t midnight = 0;  // between Saturday and Sunday
    const std::uint32_t of_next[] = {604'799'000, midnight, midnight, 1000, 2000};
    const std::int64_t count = *pulses_until_epoch(m8.context());
    for (int i = 0; i < 5; ++i) {
        m8.state.epoch.fix.time = first + std::chrono::seconds(i);
        m8.state.epoch.fix.leap_seconds = i < 3 ? 17 : 18;
        EXPECT_EQ(m8.report<TimTp>().tow_ms, of_next[i]) << i << " s after 23:59:58";
        EXPECT_EQ(*pulses_until_epoch(m8.context()), count + i) << i << " s after 23:59:58";
    }
    constexpr std::uint32_t period_lock = 0x40050003;
    m8.config.set(in_ram, period_lock, 4'000'000);
    m8.state.epoch.fix.time = first + 2500ms;
    m8.state.epoch.fix.leap_seconds = 17;
    EXPECT_EQ(m8.report<TimTp>().tow_ms, midnight) << "half a second later the grid begins there anew";
}

TEST(TimTpMessage, FollowsThePulseThatIsConfigured) {
    constexpr std::uint32_t period = 0x40050002, period_lock = 0x40050003, frequency_lock = 0x40050025,
                            pulse_def = 0x20050023, enabled = 0x10050007, use_locked = 0x10050009, grid = 0x2005000C;
    UbxReport m8(8);
    m8.config.set(in_ram, pulse_def, 1);
    m8.config.set(in_ram, frequency_lock, 5);
    const std::uint32_t first = m8.report<TimTp>().tow_ms;
    m8.state.epoch.fix.time += 200ms;
    EXPECT_EQ(m8.report<TimTp>().tow_ms, first + 200) << "five a second";
    // 12:49:23.521 of the receiver's clock: pulses of 3 Hz lie at whole seconds and thirds of them.
    m8.state.epoch.fix.time -= 200ms;
    m8.config.set(in_ram, frequency_lock, 3);
    EXPECT_EQ(m8.report<TimTp>().tow_ms, 218'963'666U);
    EXPECT_NEAR(m8.report<TimTp>().tow_sub_ms / 4294967296.0, 0.666667, 1e-9);
    const std::int64_t before = *pulses_until_epoch(m8.context());
    m8.state.epoch.fix.time += 300ms;
    EXPECT_EQ(m8.report<TimTp>().tow_ms, 218'964'000U);
    EXPECT_EQ(m8.report<TimTp>().tow_sub_ms, 0U);
    m8.state.epoch.fix.time += 1s;
    EXPECT_EQ(*pulses_until_epoch(m8.context()), before + 4);
    m8.config.set(in_ram, frequency_lock, 0);
    EXPECT_TRUE(m8.frames(TimTp::message_id).empty());
    m8.config.set(in_ram, pulse_def, 0);
    m8.config.set(in_ram, period_lock, 4'000'000);
    EXPECT_EQ(m8.report<TimTp>().tow_ms % 4000, 0U);
    m8.config.set(in_ram, use_locked, 0);
    m8.config.set(in_ram, period, 500'000);
    EXPECT_EQ(m8.report<TimTp>().tow_ms % 500, 0U);
    const std::pair<std::uint64_t, int> references[] = {{0, 0x0F}, {1, 0}, {2, 1}, {3, 2}, {4, 3}};
    for (const auto& [base, reference] : references) {
        m8.config.set(in_ram, grid, base);
        EXPECT_EQ(m8.report<TimTp>().ref_info, reference) << base;
        EXPECT_EQ(m8.report<TimTp>().flags & 1, base == 0 ? 1 : 0);
    }
    m8.config.set(in_ram, enabled, 0);
    EXPECT_TRUE(m8.frames(TimTp::message_id).empty());
}

}  // namespace
}  // namespace skyloop::firmware
