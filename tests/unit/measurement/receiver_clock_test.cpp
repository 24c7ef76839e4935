#include "receiver/measurement/receiver_clock.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "support/oracle_table.hpp"
#include "world/gnss/constants.hpp"

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

constexpr OscillatorTemperature constant_temperature{5e-8, Kelvin(0), Seconds(600)};

TEST(ReceiverClock, WithoutNoiseItDriftsStraight) {
    ReceiverClock clock({{0, 0}, Metres(10), MetresPerSecond(150), ClockSteering::free_running, constant_temperature},
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
    ReceiverClock clock({noise, {}, MetresPerSecond(0), ClockSteering::free_running, constant_temperature},
                        RandomStream(7, "clock"));
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

TEST(ReceiverClock, AtAConstantTemperatureItHasTheAllanVarianceOfItsCoefficients) {
    const OscillatorNoise noise;
    ReceiverClock clock({noise, {}, MetresPerSecond(0), ClockSteering::free_running, constant_temperature},
                        RandomStream(7, "clock"));
    std::vector<double> phase;  // s, once a second
    for (int i = 0; i < 100000; ++i) {
        clock.advance(Seconds(1));
        phase.push_back(clock.bias().value() / speed_of_light);
    }
    for (const std::size_t tau : {1u, 10u, 30u}) {
        SCOPED_TRACE(tau);
        const std::size_t count = phase.size() - 2 * tau;
        double sum = 0;
        for (std::size_t i = 0; i < count; ++i)
            sum += std::pow(phase[i + 2 * tau] - 2 * phase[i + tau] + phase[i], 2);
        const double t = static_cast<double>(tau), seen = sum / (2 * t * t * static_cast<double>(count));
        const double wanted = noise.h0 / (2 * t) + 2 * std::numbers::pi * std::numbers::pi / 3 * noise.h_minus_2 * t;
        EXPECT_NEAR(std::sqrt(seen / wanted), 1, 0.06);
    }
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

TEST(ReceiverClock, FollowsTheTemperatureOfItsOscillator) {
    // Without other noise the drift is that of the start and what the temperature makes of it: c·5e-8/K·σ = 3 m/s.
    ReceiverClockParameters parameters{{0, 0}, {}, MetresPerSecond(150)};
    ReceiverClock clock(parameters, RandomStream(5, "clock"));
    EXPECT_EQ(clock.drift(), MetresPerSecond(150));
    double sum = 0, square = 0, products = 0, before = 0;
    constexpr int steps = 20000;
    for (int i = 0; i < steps; ++i) {
        clock.advance(Seconds(59.9));
        const Metres last = clock.bias();
        const double drift_before = clock.drift().value();
        clock.advance(Seconds(0.1));
        ASSERT_NEAR((clock.bias() - last).value(), (drift_before + clock.drift().value()) / 2 * 0.1, 1e-6);
        const double d = clock.drift().value() - 150;
        sum += d;
        square += d * d;
        products += d * before;
        before = d;
    }
    EXPECT_NEAR(std::sqrt(square / steps), speed_of_light * 5e-8 * 0.2, 0.15);
    EXPECT_NEAR(sum / steps, 0, 0.3);
    EXPECT_NEAR(products / square, std::exp(-0.1), 0.01);
}

TEST(ReceiverClock, ContinuousSteeringHoldsItWithinTensOfNanoseconds) {
    for (const double dt : {0.1, 1.0, 30.0}) {
        SCOPED_TRACE(dt);
        ReceiverClock clock({{}, {}, MetresPerSecond(150), ClockSteering::continuous}, RandomStream(3, "clock"));
        double square = 0;
        constexpr int steps = 20000;
        for (int i = 0; i < steps; ++i) {
            clock.advance(Seconds(dt));
            ASSERT_LT(std::abs(clock.bias().value()), speed_of_light * 100e-9);
            square += clock.bias().value() * clock.bias().value() / steps;
        }
        EXPECT_GT(std::sqrt(square), speed_of_light * 1e-9);
        EXPECT_LT(std::sqrt(square), speed_of_light * 30e-9);
        EXPECT_EQ(clock.jumped_milliseconds(), 0);
    }
}

TEST(ReceiverClock, ContinuousSteeringTakesAnInitialBiasOut) {
    ReceiverClock clock({{0, 0}, Metres(1000), {}, ClockSteering::continuous, constant_temperature},
                        RandomStream(1, "clock"));
    EXPECT_EQ(clock.bias(), Metres(1000));
    // Critically damped from rest: (1 + t/τ) exp(−t/τ), in one step or in many.
    clock.advance(Seconds(10));
    EXPECT_NEAR(clock.bias().value(), 2000 * std::exp(-1.0), 1e-9);
    for (int i = 0; i < 100; ++i)
        clock.advance(Seconds(0.1));
    EXPECT_NEAR(clock.bias().value(), 3000 * std::exp(-2.0), 1e-9);
    EXPECT_NEAR(clock.drift().value(), -200 * std::exp(-2.0), 1e-9);
}

TEST(ReceiverClock, RunsAlikeHoweverOftenItIsLookedAt) {
    ReceiverClock seldom({{}, {}, MetresPerSecond(150), ClockSteering::millisecond_jumps}, RandomStream(5, "clock"));
    ReceiverClock often = seldom;
    for (int second = 0; second < 3000; ++second) {
        seldom.advance(Seconds(1));
        for (int i = 0; i < 25; ++i)
            often.advance(Seconds(0.04));
        ASSERT_NEAR(seldom.bias().value(), often.bias().value(), 1e-6) << second;
        ASSERT_NEAR(seldom.drift().value(), often.drift().value(), 1e-9) << second;
    }
    EXPECT_NE(seldom.jumped_milliseconds(), 0);
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
