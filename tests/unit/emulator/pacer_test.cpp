#include "run/emulator/timing.hpp"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/time.h>

#include <csignal>

namespace skyloop {
namespace {

using namespace std::chrono_literals;

constexpr GpsTime pacer_start{1'400'000'000s};

TEST(VirtualPacer, NeverWaitsAndCountsSimulatedTime) {
    VirtualPacer pacer(pacer_start);
    EXPECT_EQ(pacer.wait_until(pacer_start + 24h * 365), Nanoseconds(0));
    EXPECT_TRUE(pacer.is_virtual());
    EXPECT_EQ(pacer.tick(true), 0ns);
    EXPECT_EQ(pacer.monotonic_ns(pacer_start + 1500ms), 1'500'000'000);
    pacer.pause(pacer_start);
    EXPECT_FALSE(pacer.paused()) << "nobody could let it go on";
}

TEST(RealtimePacer, NeverComesEarly) {
    for (const double speed : {1.0, 10.0}) {
        const std::int64_t begun = steady_clock_ns();
        RealtimePacer pacer(pacer_start, begun, speed);
        const auto lateness = pacer.wait_until(pacer_start + 50ms);
        ASSERT_TRUE(lateness);
        EXPECT_GE(*lateness, 0ns);
        EXPECT_GE(static_cast<double>(steady_clock_ns() - begun), 50e6 / speed);
    }
}

TEST(RealtimePacer, AnInstantThatIsPastComesAtOnceAndLate) {
    RealtimePacer pacer(pacer_start, steady_clock_ns() - 3'600'000'000'000, 1);
    const auto lateness = pacer.wait_until(pacer_start);
    ASSERT_TRUE(lateness);
    EXPECT_GE(*lateness, 1h);
    // Twice the speed: what is due after an hour of simulated time was due half an hour ago.
    RealtimePacer fast(pacer_start, steady_clock_ns() - 3'600'000'000'000, 2);
    const auto less = fast.wait_until(pacer_start + 1h);
    ASSERT_TRUE(less);
    EXPECT_GE(*less, 30min);
    EXPECT_LT(*less, 1h);
}

TEST(RealtimePacer, LooksAtTheWiresMoreOftenWhileBytesAreOnTheirWay) {
    const RealtimePacer real(pacer_start, 0, 1);
    EXPECT_FALSE(real.is_virtual());
    EXPECT_EQ(real.tick(true), 1ms);
    EXPECT_EQ(real.tick(false), 5ms);
    EXPECT_EQ(RealtimePacer(pacer_start, 0, 20).tick(true), 20ms);
}

TEST(RealtimePacer, ASignalCutsAWaitShort) {
    struct sigaction action {
    }, before{};
    action.sa_handler = [](int) {};
    sigaction(SIGALRM, &action, &before);
    const itimerval every_20_ms{{0, 20'000}, {0, 20'000}};
    const itimerval none{};
    setitimer(ITIMER_REAL, &every_20_ms, nullptr);
    RealtimePacer pacer(pacer_start, steady_clock_ns(), 1);
    const auto lateness = pacer.wait_until(pacer_start + 1h);
    setitimer(ITIMER_REAL, &none, nullptr);
    sigaction(SIGALRM, &before, nullptr);
    EXPECT_FALSE(lateness);
}

TEST(LatenessHistogram, CountsEachEpochInItsBin) {
    LatenessHistogram histogram;
    EXPECT_EQ(histogram.mean_ms(), 0);
    histogram.add(0ns);
    histogram.add(99us);
    histogram.add(100us);  // a bound belongs to the bin above
    histogram.add(2ms);
    histogram.add(5s);
    const std::array<std::uint64_t, 10> expected{2, 1, 0, 1, 0, 0, 0, 0, 0, 1};
    EXPECT_EQ(histogram.counts(), expected);
    EXPECT_EQ(histogram.largest(), 5s);
    histogram.add(1ms);
    EXPECT_EQ(histogram.largest(), 5s);
    EXPECT_NEAR(histogram.mean_ms(), (0 + 0.099 + 0.1 + 2 + 5000 + 1) / 6, 1e-9);
}

}  // namespace
}  // namespace skyloop
