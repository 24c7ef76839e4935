#include "receiver/pvt/observation_equations.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "base/core/random.hpp"
#include "world/gnss/constants.hpp"

namespace skyloop {
namespace {

Observations one_signal(int second, double range, double noise) {
    Observation o;
    o.satellite = {Constellation::gps, 3};
    o.carrier = Hertz(carrier_frequency_l1);
    o.pseudorange = Metres(range + noise);
    o.carrier_phase = range / (speed_of_light / carrier_frequency_l1) + 777;
    Observations all;
    all.receive_time = GpsTime(std::chrono::seconds(1'000'000'000 + second));
    all.signals.push_back(o);
    return all;
}

double moving_range(int second) { return 2e7 + 500.0 * second + 0.1 * second * second; }

TEST(CodeSmoother, AveragesTheCodeAlongThePhase) {
    CodeSmoother smoother(Seconds(100));
    RandomStream noise(3, "smoother");
    double sum = 0;
    int count = 0;
    for (int s = 0; s < 4000; ++s) {
        Observations all = one_signal(s, moving_range(s), noise.normal());
        smoother.smooth(all);
        if (s < 500) continue;
        const double error = all.signals[0].pseudorange->value() - moving_range(s);
        sum += error * error;
        ++count;
    }
    // An exponential mean over 100 epochs leaves 1/√199 of white noise.
    EXPECT_NEAR(std::sqrt(sum / count), 1 / std::sqrt(199.0), 0.02);
}

TEST(CodeSmoother, StartsAnewAfterSlipsGapsAndClockJumps) {
    for (int kind = 0; kind < 4; ++kind) {
        CodeSmoother smoother(Seconds(100));
        for (int s = 0; s < 50; ++s) {
            Observations all = one_signal(s, moving_range(s), 5);
            smoother.smooth(all);
        }
        Observations last = one_signal(kind == 2 ? 80 : 50, moving_range(50), -5);
        if (kind == 0) last.signals[0].slipped = true;
        if (kind == 1) last.signals[0].carrier_phase.reset();
        if (kind == 3) last.clock_was_set = true;
        smoother.smooth(last);
        EXPECT_DOUBLE_EQ(last.signals[0].pseudorange->value(), moving_range(50) - 5) << kind;
    }
}

TEST(CodeSmoother, WithoutAWindowChangesNothing) {
    CodeSmoother smoother(Seconds(0));
    for (int s = 0; s < 3; ++s) {
        Observations all = one_signal(s, moving_range(s), s);
        smoother.smooth(all);
        EXPECT_DOUBLE_EQ(all.signals[0].pseudorange->value(), moving_range(s) + s);
    }
}

}  // namespace
}  // namespace skyloop
