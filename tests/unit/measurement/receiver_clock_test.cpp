#include "skyloop/measurement/receiver_clock.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "skyloop/gnss/constants.hpp"
#include "support/oracle_table.hpp"

namespace skyloop {
namespace {

TEST(ClockCovariance, EveryOracleRow) {
    for (const test::OracleRow& row : test::oracle_rows("receiver_clock_q.csv")) {
        SCOPED_TRACE(row.id());
        const ClockCovariance q =
            clock_covariance({row.number("h0"), row.number("h_minus2")}, Seconds(row.number("dt_s")));
        EXPECT_NEAR(q.bias / row.number("Q11_m2"), 1, row.number("tol_rel"));
        EXPECT_NEAR(q.bias_drift / row.number("Q12_m2_per_s"), 1, row.number("tol_rel"));
        EXPECT_NEAR(q.drift / row.number("Q22_m2_per_s2"), 1, row.number("tol_rel"));
    }
}

TEST(ReceiverClock, WithoutNoiseItDriftsStraight) {
    ReceiverClock clock({{0, 0}, Metres(10), MetresPerSecond(150), ClockSteering::free_running},
                        RandomStream(1, "clock"));
    for (int i = 0; i < 100; ++i)
        clock.advance(Seconds(0.5));
    EXPECT_NEAR(clock.bias().value(), 10 + 150 * 50, 1e-9);
    EXPECT_EQ(clock.drift(), MetresPerSecond(150));
    EXPECT_EQ(clock.jumped_milliseconds(), 0);
}

TEST(ReceiverClock, HasTheCovarianceOfItsOscillator) {
    const OscillatorNoise noise;
    const Seconds dt(1);
    const ClockCovariance q = clock_covariance(noise, dt);
    ClockCovariance seen;
    constexpr int runs = 20000;
    ReceiverClock clock({noise, {}, MetresPerSecond(0)}, RandomStream(7, "clock"));
    for (int i = 0; i < runs; ++i) {
        const Metres bias = clock.bias();
        const MetresPerSecond drift = clock.drift();
        clock.advance(dt);
        const double b = (clock.bias() - bias).value() - drift.value() * dt.value();
        const double d = (clock.drift() - drift).value();
        seen.bias += b * b / runs;
        seen.bias_drift += b * d / runs;
        seen.drift += d * d / runs;
    }
    EXPECT_NEAR(seen.bias / q.bias, 1, 0.05);
    EXPECT_NEAR(seen.bias_drift / q.bias_drift, 1, 0.05);
    EXPECT_NEAR(seen.drift / q.drift, 1, 0.05);
}

TEST(ReceiverClock, JumpsByWholeMilliseconds) {
    const ReceiverClockParameters steered{{}, {}, MetresPerSecond(150), ClockSteering::millisecond_jumps};
    ReceiverClockParameters free = steered;
    free.steering = ClockSteering::free_running;
    ReceiverClock jumping(steered, RandomStream(1, "clock")), running(free, RandomStream(1, "clock"));
    const double millisecond = speed_of_light * 1e-3;
    for (int i = 0; i < 5000; ++i) {
        jumping.advance(Seconds(1));
        running.advance(Seconds(1));
        ASSERT_LE(std::abs(jumping.bias().value()), millisecond / 2 + 1e-6);
        ASSERT_NEAR(jumping.bias().value() - running.bias().value(), jumping.jumped_milliseconds() * millisecond, 1e-4);
    }
    EXPECT_LT(jumping.jumped_milliseconds(), -1);
}

TEST(ReceiverClock, TheSameSeedGivesTheSameClock) {
    ReceiverClock a({}, RandomStream(3, "clock")), b({}, RandomStream(3, "clock")), c({}, RandomStream(4, "clock"));
    for (ReceiverClock* clock : {&a, &b, &c})
        clock->advance(Seconds(1));
    EXPECT_EQ(a.bias(), b.bias());
    EXPECT_NE(a.bias(), c.bias());
}

}  // namespace
}  // namespace skyloop
