#include "motion/trajectory/source_clock.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

namespace skyloop {
namespace {

using namespace std::chrono_literals;

const GpsTime clock_start = GpsTime() + std::chrono::hours(24 * 365 * 46);
constexpr std::int64_t clock_start_ns = 70'000'000'000'000;
constexpr std::int64_t ms = 1'000'000;

std::int64_t since_start_ns(GpsTime time) { return (time - clock_start).count(); }

SourceClock clock_of(ClockMode mode) { return {mode, clock_start, clock_start_ns}; }

// Statements of a source at `rate`, every 20 ms of its time, each under way for `delay_ms()`.
template <class Delay>
std::vector<double> errors_ms(SourceClock& clock, double rate, int count, Delay delay_ms) {
    std::vector<double> errors;
    const std::int64_t source_start = 1'795'222'620'000'000'000;  // counts as Unix does
    for (int i = 0; i < count; ++i) {
        const double said_ms = 20.0 * i / rate;
        const std::int64_t received =
            clock_start_ns + static_cast<std::int64_t>((said_ms + delay_ms(i)) * static_cast<double>(ms));
        const auto stamp = clock.stamp(Nanoseconds(source_start + i * 20 * ms), received);
        errors.push_back(static_cast<double>(since_start_ns(stamp.time)) / static_cast<double>(ms) - said_ms);
    }
    return errors;
}

TEST(SourceClock, FollowTakesTheSourcesOwnTimeWhateverTheWallClockDoes) {
    for (const ClockMode mode : {ClockMode::follow, ClockMode::lock_step}) {
        SourceClock clock = clock_of(mode);
        EXPECT_FALSE(clock.run_time(0s));
        EXPECT_EQ(clock.stamp(100s, clock_start_ns + 12345).time, clock_start);
        EXPECT_EQ(clock.stamp(100s + 20ms, clock_start_ns + 99'000 * ms).time, clock_start + 20ms);
        EXPECT_EQ(clock.stamp(100s + 40ms, clock_start_ns + 99'001 * ms).time, clock_start + 40ms);
        EXPECT_EQ(clock.run_time(101s), clock_start + 1s);
    }
}

TEST(SourceClock, ALateStatementTellsNoRate) {
    SourceClock clock = clock_of(ClockMode::lock_step);
    clock.stamp(100s, clock_start_ns);
    clock.stamp(101s, clock_start_ns + 10 * ms);
    clock.stamp(100s, clock_start_ns + 1000 * ms);
    EXPECT_FALSE(clock.rate());
    clock.stamp(103s, clock_start_ns + 2010 * ms);
    clock.stamp(102s + 500ms, clock_start_ns + 2400 * ms);
    EXPECT_NEAR(clock.rate().value_or(0), 1, 0.01);
}

TEST(SourceClock, GoesOnFromWhereItWasWhenTheSourceBeginsAnew) {
    SourceClock clock = clock_of(ClockMode::follow);
    clock.stamp(100s, clock_start_ns);
    clock.stamp(105s, clock_start_ns + 1);
    const auto anew = clock.stamp(1s, clock_start_ns + 2);
    EXPECT_TRUE(anew.restarted);
    EXPECT_EQ(anew.time, clock_start + 5s);
    EXPECT_EQ(clock.stamp(2s, clock_start_ns + 3).time, clock_start + 6s);
    EXPECT_TRUE(clock.stamp(1000s, clock_start_ns + 4).restarted) << "nobody waits for a quarter of an hour";
    EXPECT_FALSE(clock.stamp(999s + 100ms, clock_start_ns + 5).restarted) << "overtaken";
}

TEST(SourceClock, LockStepGoesAnyWayAhead) {
    SourceClock clock = clock_of(ClockMode::lock_step);
    clock.stamp(0s, clock_start_ns);
    const auto far = clock.stamp(3600s, clock_start_ns + 1);
    EXPECT_FALSE(far.restarted);
    EXPECT_EQ(far.time, clock_start + 3600s);
}

TEST(SourceClock, FollowStartsWithAStatementThatHasNoTimeAndGoesOnFromIt) {
    SourceClock clock = clock_of(ClockMode::follow);
    EXPECT_EQ(clock.stamp(std::nullopt, clock_start_ns + 900 * ms).time, clock_start) << "not when the run was begun";
    EXPECT_EQ(clock.stamp(7s, clock_start_ns + 920 * ms).time, clock_start + 20ms);
    EXPECT_EQ(clock.stamp(7s + 30ms, clock_start_ns + 950 * ms).time, clock_start + 50ms);
}

TEST(SourceClock, FollowGoesOnWhereOnlyStatementsWithoutATimeAreLeft) {
    SourceClock clock = clock_of(ClockMode::follow);
    for (int i = 0; i <= 100; ++i)
        clock.stamp(7s + i * 20ms, clock_start_ns + i * 20 * ms);
    for (int i = 1; i <= 500; ++i)
        EXPECT_NEAR(
            static_cast<double>(since_start_ns(clock.stamp(std::nullopt, clock_start_ns + (2000 + i * 20) * ms).time)),
            (2000.0 + i * 20) * ms, 0.2 * ms * i);
}

TEST(SourceClock, LooksThroughTheScatterOfDelays) {
    std::mt19937 random(8);
    std::exponential_distribution<double> delay(1 / 8.0);
    SourceClock clock = clock_of(ClockMode::realtime);
    const auto errors = errors_ms(clock, 1, 3000, [&](int) { return 2 + delay(random); });
    for (std::size_t i = 250; i < errors.size(); ++i)
        ASSERT_NEAR(errors[i], 2, 2) << i;  // 8 ms of scatter at the input
    ASSERT_TRUE(clock.rate());
    EXPECT_NEAR(*clock.rate(), 1, 0.005);
}

TEST(SourceClock, KnowsTheRateAndStaysWithSlowAndFastSources) {
    for (const double rate : {0.5, 0.9, 0.98, 1.02, 2.0}) {
        std::mt19937 random(9);
        std::uniform_real_distribution<double> delay(0, 10);
        SourceClock clock = clock_of(ClockMode::realtime);
        const auto errors = errors_ms(clock, rate, 1000, [&](int) { return 1 + delay(random); });
        for (std::size_t i = 400; i < errors.size(); ++i)
            ASSERT_NEAR(errors[i], 1, 11) << rate << " " << i;
        ASSERT_TRUE(clock.rate());
        EXPECT_NEAR(*clock.rate(), rate, 0.01 * rate);
    }
}

TEST(SourceClock, StepsAfterAPauseOfTheSource) {
    SourceClock clock = clock_of(ClockMode::realtime);
    // Its clock stands still for 3 s of ours after 5 s.
    const auto errors = errors_ms(clock, 1, 1000, [](int i) { return i < 250 ? 1.0 : 3001.0; });
    EXPECT_NEAR(errors[249], 1, 0.1);
    for (std::size_t i = 300; i < errors.size(); ++i)
        ASSERT_NEAR(errors[i], 3001, 1) << i;  // within a second
}

// A source that starts at `first` and runs with ours for 6 s, then leaps ahead by `leap`. @return what its statements
// are late by, every 20 ms; all of them are under way for up to 5 ms.
std::vector<double> errors_around_leap(SourceClock& clock, Nanoseconds first, Nanoseconds leap, int& steps) {
    std::mt19937 random(12);
    std::uniform_int_distribution<std::int64_t> delay(0, 5 * ms);
    std::vector<double> errors;
    for (int i = 0; i < 900; ++i) {
        const std::int64_t said = i * 20 * ms;
        const Nanoseconds source = first + Nanoseconds(said) + (i >= 300 ? leap : 0ns);
        const auto stamp = clock.stamp(source, clock_start_ns + said + delay(random));
        EXPECT_FALSE(stamp.restarted) << i;
        EXPECT_TRUE(!stamp.stepped || i == 300) << i;
        steps += stamp.stepped ? 1 : 0;
        errors.push_back(static_cast<double>(since_start_ns(stamp.time) - said) / static_cast<double>(ms));
    }
    return errors;
}

TEST(SourceClock, StepsAtOnceWhenTheSourceLeapsAhead) {
    constexpr std::chrono::seconds since_1970{1'772'366'400};
    for (const Nanoseconds first : {Nanoseconds(60s), Nanoseconds(since_1970)})
        for (const Nanoseconds leap : {Nanoseconds(300ms), Nanoseconds(500ms), Nanoseconds(2s), Nanoseconds(10s),
                                       Nanoseconds(3600s), Nanoseconds(since_1970)}) {
            SourceClock clock = clock_of(ClockMode::realtime);
            int steps = 0;
            const auto errors = errors_around_leap(clock, first, leap, steps);
            EXPECT_EQ(steps, 1);
            for (std::size_t i = 0; i < errors.size(); ++i)
                ASSERT_NEAR(errors[i], 2.5, 3) << leap.count() << " " << i;
            EXPECT_NEAR(clock.rate().value_or(0), 1, 0.005);
        }
}

TEST(SourceClock, SlewsToASmallLeapAheadAndTakesItForNoRate) {
    SourceClock clock = clock_of(ClockMode::realtime);
    int steps = 0;
    const auto errors = errors_around_leap(clock, 60s, 200ms, steps);
    EXPECT_EQ(steps, 0);
    for (std::size_t i = 300; i < errors.size(); ++i) {
        const double since_s = 0.02 * static_cast<double>(i - 300);
        ASSERT_NEAR(errors[i], 202 - 2 * since_s, 10) << i;
    }
}

TEST(SourceClock, StaysWithASparseSourceWhoseRateChanges) {
    for (const double rate : {1.5, 2.0}) {
        SourceClock clock = clock_of(ClockMode::realtime);
        double received_ms = 0, error = 0;
        for (int i = 0; i < 60; ++i) {
            received_ms += i < 20 ? 1000 : 1000 / rate;
            const auto received = clock_start_ns + static_cast<std::int64_t>(received_ms * static_cast<double>(ms));
            const auto stamp = clock.stamp(100s + i * 1s, received);
            error = static_cast<double>(since_start_ns(stamp.time)) / static_cast<double>(ms) - received_ms;
            ASSERT_TRUE(i <= 30 || std::abs(error) < 10) << rate << " " << i << " " << error;
        }
        EXPECT_NEAR(clock.rate().value_or(0), rate, 0.02 * rate);
    }
}

TEST(SourceClock, IsNotMovedByAStallOfTheNetwork) {
    SourceClock clock = clock_of(ClockMode::realtime);
    // Nothing comes for a second, then all of it at once.
    const auto errors = errors_ms(clock, 1, 1000, [](int i) { return i >= 400 && i < 450 ? 20.0 * (450 - i) : 1.0; });
    for (std::size_t i = 0; i < errors.size(); ++i)
        ASSERT_NEAR(errors[i], 1, 0.5) << i;
}

TEST(SourceClock, RestartsInRealTimeWhereTheSourceIs) {
    SourceClock clock = clock_of(ClockMode::realtime);
    errors_ms(clock, 1, 500, [](int) { return 1.0; });
    const auto anew = clock.stamp(0s, clock_start_ns + 20'000 * ms);
    EXPECT_TRUE(anew.restarted);
    EXPECT_EQ(since_start_ns(anew.time), 20'000 * ms);
    EXPECT_EQ(since_start_ns(clock.stamp(20ms, clock_start_ns + 20'020 * ms).time), 20'020 * ms);
    clock.set_run(clock_start + 100s, clock_start_ns + 30'000 * ms);
    EXPECT_EQ(clock.run_time(40ms), clock_start + 100s - 10s + 40ms);
}

TEST(SourceClock, EvensOutArrivalsOfASourceWithoutAClock) {
    std::mt19937 random(10);
    std::uniform_real_distribution<double> scatter(-4, 4), lot(0, 1);
    SourceClock clock = clock_of(ClockMode::realtime);
    double sum_in = 0, sum_out = 0;
    int counted = 0;
    for (int i = 0; i < 2000; ++i) {
        const double jitter = scatter(random);
        if (lot(random) < 0.2) continue;  // lost
        const std::int64_t received = clock_start_ns + static_cast<std::int64_t>((20.0 * i + 10 + jitter) * ms);
        const double error =
            static_cast<double>(since_start_ns(clock.stamp(std::nullopt, received).time)) / ms - (20.0 * i + 10);
        if (i < 500) continue;
        sum_in += jitter * jitter;
        sum_out += error * error;
        ++counted;
    }
    EXPECT_LT(std::sqrt(sum_out / counted), 0.4 * std::sqrt(sum_in / counted));
}

TEST(SourceClock, LocksAgainAfterASilence) {
    SourceClock clock = clock_of(ClockMode::realtime);
    for (int i = 0; i < 100; ++i)
        clock.stamp(std::nullopt, clock_start_ns + i * 20 * ms);
    const auto late = clock.stamp(std::nullopt, clock_start_ns + 5'007 * ms);
    EXPECT_EQ(since_start_ns(late.time), 5'007 * ms);
}

TEST(SourceClock, TakesAnyNumberForATime) {
    constexpr std::int64_t most = std::numeric_limits<std::int64_t>::max();
    for (const ClockMode mode : {ClockMode::realtime, ClockMode::follow}) {
        std::mt19937_64 random(11);
        SourceClock clock = clock_of(mode);
        for (int i = 0; i < 20000; ++i) {
            const int shift = static_cast<int>(random() % 63);
            const auto value = static_cast<std::int64_t>(random() >> 1) >> shift;
            const std::int64_t source = i % 7 == 0          ? most
                                        : i % 11 == 0       ? -most - 1
                                        : random() % 2 == 0 ? value
                                                            : -value;
            clock.stamp(Nanoseconds(source), clock_start_ns + i * ms);
            std::ignore = clock.run_time(Nanoseconds(-source / 2));
            std::ignore = clock.rate();
        }
    }
}

}  // namespace
}  // namespace skyloop
