// What a receiver tells after its fix is lost, and after a start without one.
#include <gtest/gtest.h>

#include <cmath>
#include <tuple>

#include "firmware/core/state_tracker.hpp"
#include "receiver/protocol/ubx_nav.hpp"
#include "receiver/protocol/ubx_services.hpp"
#include "receiver/protocol/ubx_time.hpp"
#include "ubx_reports.hpp"
#include "world/gnss/constants.hpp"

namespace skyloop::firmware {
namespace {

using namespace std::chrono_literals;

// A receiver with one epoch a second, which has been on for long.
struct LosingReceiver {
    LosingReceiver() : fix(told.state.epoch.fix) {
        told.board.timing.coasting = Seconds(2);
        tracker.start(fix.time, {}, true);
    }
    void step(int epochs = 1) {
        for (int i = 0; i < epochs; ++i) {
            fix.time += 1s;
            told.state = tracker.update(Epoch{fix}, receiver_config(told.config, told.board), {});
        }
    }
    void lose() { fix.type = FixType::none; }
    [[nodiscard]] double clock_ns() const { return told.report<NavClock>().clk_b; }

    UbxReport told{9};
    StateTracker tracker{told.board};
    Fix fix;
};

// As at the cold start of a captured ZED-F9P, but for the place, which is that of before.
void expect_only_a_place(const UbxReport& told, std::int32_t latitude) {
    const auto pvt = told.report<NavPvt>();
    EXPECT_EQ(pvt.fix_type, 0);
    EXPECT_EQ(pvt.lat, latitude);
    EXPECT_EQ(pvt.h_acc, 4294967295u);
    EXPECT_EQ(pvt.v_acc, 3750000128u);
    EXPECT_EQ(pvt.s_acc, 20000u);
    EXPECT_EQ(pvt.head_acc, 18000000u);
    EXPECT_EQ(std::tuple(pvt.vel_n, pvt.vel_e, pvt.vel_d, pvt.g_speed), std::tuple(0, 0, 0, 0));
    EXPECT_EQ(told.report<NavVelned>().s_acc, 2000u);
    EXPECT_EQ(told.report<NavPosecef>().p_acc, 4294967295u);
    EXPECT_EQ(told.report<NavHpposllh>().v_acc, 4294967295u);
    const auto clock = told.report<NavClock>();
    EXPECT_EQ(std::tuple(clock.clk_b, clock.clk_d, clock.f_acc), std::tuple(0, 0, 3749500u));
    EXPECT_FLOAT_EQ(told.report<NavCov>().pos_cov[0], 1.40625e13f);
    EXPECT_FLOAT_EQ(told.report<NavCov>().vel_cov[5], 400);
}

TEST(LostFix, LeavesOnlyThePlaceOverAStartWithoutAFix) {
    for (const StartKind kind : {StartKind::hot, StartKind::warm}) {
        LosingReceiver r;
        r.step(2);
        r.lose();
        r.step(4);
        const std::int32_t latitude = r.told.report<NavPvt>().lat;
        r.tracker.start(r.fix.time, Forgotten::of(kind));
        for (int epoch = 0; epoch < 3; ++epoch) {
            r.step();
            expect_only_a_place(r.told, latitude);
        }
        r.fix.type = FixType::fix_3d;
        r.step(60);
        EXPECT_EQ(r.told.report<NavPvt>().h_acc, 3300u);
        EXPECT_EQ(r.told.report<NavPvt>().g_speed, 5001);
        EXPECT_LT(r.told.report<NavClock>().f_acc, 1000u);
    }
}

// What its drift is unsure by is 10 ns/s (StateTracker), of which tAcc tells.
TEST(LostFix, LetsTheClockRunOnByItsDrift) {
    LosingReceiver r;
    r.fix.clock_bias = Metres(498'200e-9 * speed_of_light);
    r.fix.clock_drift = MetresPerSecond(500e-9 * speed_of_light);
    r.step();
    r.lose();
    r.fix.clock_bias = Metres(0);  // nothing is solved
    r.fix.clock_drift = MetresPerSecond(0);
    const double accuracy = r.told.report<NavClock>().t_acc;
    for (int epoch = 1; epoch <= 8; ++epoch) {
        r.step();
        // It is set by a millisecond where it is half of one ahead.
        EXPECT_NEAR(r.clock_ns(), 498'200 + 500 * epoch - (epoch > 3 ? 1'000'000 : 0), 1) << epoch;
        EXPECT_EQ(r.told.report<NavClock>().clk_d, 500) << epoch;
        EXPECT_NEAR(r.told.report<NavClock>().t_acc, accuracy + 10 * epoch, 1.1) << epoch;
    }
    EXPECT_EQ(r.told.report<NavPvt>().fix_type, 0);
}

// Coasting, as dead reckoning and then without a fix.
TEST(LostFix, HasTheCovariancesOfTheAccuraciesThatItTells) {
    LosingReceiver r;
    r.step();
    r.lose();
    for (int epoch = 1; epoch <= 5; ++epoch) {
        r.step();
        const auto pvt = r.told.report<NavPvt>();
        const auto m = r.told.report<NavCov>();
        EXPECT_EQ(pvt.fix_type, epoch <= 2 ? 1 : 0);
        EXPECT_NEAR(std::sqrt(m.pos_cov[0] + m.pos_cov[3]), pvt.h_acc * 1e-3, 1e-2) << epoch;
        EXPECT_NEAR(std::sqrt(m.pos_cov[5]), pvt.v_acc * 1e-3, 1e-2) << epoch;
        EXPECT_NEAR(std::sqrt(m.vel_cov[0] + m.vel_cov[3] + m.vel_cov[5]), pvt.s_acc * 1e-3, 1e-2) << epoch;
    }
}

TEST(LostFix, HasNoEstimateThatIsWorseThanThatOfNoSolution) {
    LosingReceiver r;
    r.step();
    r.lose();
    r.step(60);
    EXPECT_EQ(r.told.report<NavPvt>().s_acc, 20000u);
    EXPECT_NEAR(r.told.report<NavPvt>().h_acc, 3300 + 60 * 7200, 1);
}

// Beyond the limits of a pedestrian: told as not OK, then withheld, never as dead reckoning that is OK.
TEST(LostFix, IsNotCoastedBeyondTheLimits) {
    LosingReceiver r;
    r.told.config.set(in_ram, key::navspg_dynmodel, 3);
    r.step(2);
    r.fix.speed = MetresPerSecond(31);
    for (int epoch = 1; epoch <= 6; ++epoch) {
        r.step();
        EXPECT_EQ(r.told.state.epoch.fix.type, epoch < 3 ? FixType::fix_3d : FixType::none) << epoch;
        EXPECT_FALSE(r.told.state.fix_ok) << epoch;
    }
}

TEST(LostFix, IsNotCoastedWhereTheSolutionItselfKeepsToTheLimits) {
    LosingReceiver r;
    r.step(2);
    r.lose();
    r.fix.withheld = true;
    for (int epoch = 0; epoch < 3; ++epoch) {
        r.step();
        EXPECT_EQ(r.told.state.epoch.fix.type, FixType::none) << epoch;
        EXPECT_FALSE(r.told.state.fix_ok) << epoch;
    }
    r.fix.withheld = false;
    r.step();
    EXPECT_EQ(r.told.state.epoch.fix.type, FixType::none) << "nor after it";
}

TEST(LostFix, CoastsNoBetterThanItWas) {
    LosingReceiver r;
    r.told.config.set(in_ram, key::navspg_pacc, 1);
    r.step(2);
    EXPECT_FALSE(r.told.state.fix_ok);
    r.lose();
    r.step();
    EXPECT_EQ(r.told.state.epoch.fix.type, FixType::dead_reckoning);
    EXPECT_FALSE(r.told.state.fix_ok);
}

}  // namespace
}  // namespace skyloop::firmware
