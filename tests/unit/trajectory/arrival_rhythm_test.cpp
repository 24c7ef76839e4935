#include "motion/trajectory/source_clock.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <random>
#include <vector>

#include "base/geo/local_frame.hpp"

namespace skyloop {
namespace {

using namespace std::chrono_literals;

constexpr double rhythm_step_ms = 20;

// What becomes of statements at 50 Hz.
struct RhythmSeen {
    double largest_step_error_ms = 0;  // of the time between two, from what it was at the source
    double largest_error_ms = 0;       // from the source's time, of which the mean delay is a part
    double period_ms = 0;
};

struct RhythmLaw {
    double scatter_ms = 0, lost = 0;
    bool tells_steps = false;
    double rate = 1;  // of the source
    int first = 64;   // that is looked at
};

RhythmSeen even_out(const RhythmLaw& law, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> delay(0, law.scatter_ms), lot(0, 1);
    ArrivalRhythm rhythm;
    RhythmSeen seen;
    double before_ms = 0;
    int before = -1;
    for (int i = 0; i < 1000; ++i) {
        const double late = law.scatter_ms > 0 ? delay(random) : 0;
        if (i > 0 && lot(random) < law.lost) continue;
        std::optional<Nanoseconds> step;
        if (law.tells_steps && before >= 0) step = Nanoseconds(std::llround((i - before) * rhythm_step_ms * 1e6));
        const double said_ms = i * rhythm_step_ms / law.rate;
        const double evened_ms =
            static_cast<double>(rhythm.evened(std::llround((said_ms + late) * 1e6) + 1'000'000'000, step)) * 1e-6 -
            1000;
        if (i >= law.first) {
            const double wanted = (i - before) * rhythm_step_ms / law.rate;
            seen.largest_step_error_ms = std::max(seen.largest_step_error_ms, std::abs(evened_ms - before_ms - wanted));
            seen.largest_error_ms = std::max(seen.largest_error_ms, std::abs(evened_ms - said_ms - law.scatter_ms / 2));
        }
        before = i;
        before_ms = evened_ms;
    }
    seen.period_ms = rhythm.period_ns() * 1e-6;
    return seen;
}

TEST(ArrivalRhythm, DelaysWithinAPeriodAreNoLosses) {
    for (const double scatter_ms : {0.0, 5.0, 10.0, 12.0, 15.0})
        for (unsigned seed = 1; seed <= 40; ++seed) {
            const RhythmSeen seen = even_out({scatter_ms}, seed);
            EXPECT_LT(seen.largest_step_error_ms, 2.1) << scatter_ms << " " << seed;
            EXPECT_LT(seen.largest_error_ms, 6) << scatter_ms << " " << seed;
            EXPECT_NEAR(seen.period_ms, rhythm_step_ms, 0.2) << scatter_ms << " " << seed;
        }
}

TEST(ArrivalRhythm, CountsWhatIsLostInDelaysThatScatter) {
    for (const double lost : {0.02, 0.1, 0.2})
        for (unsigned seed = 1; seed <= 40; ++seed) {
            const RhythmSeen seen = even_out({8, lost}, seed);
            EXPECT_LT(seen.largest_step_error_ms, 2.1) << lost << " " << seed;
            EXPECT_NEAR(seen.period_ms, rhythm_step_ms, 0.2) << lost << " " << seed;
        }
}

TEST(ArrivalRhythm, TheVehiclesOwnStepsCountWhatIsLostFromTheFirstStatementOn) {
    for (const double lost : {0.0, 0.05, 0.2})
        for (const double scatter_ms : {5.0, 15.0, 19.0})
            for (unsigned seed = 1; seed <= 20; ++seed) {
                const RhythmSeen seen = even_out({scatter_ms, lost, true, 1, 2}, seed);
                EXPECT_LT(seen.largest_step_error_ms, 5.1) << lost << " " << scatter_ms << " " << seed;
                const RhythmSeen later = even_out({scatter_ms, lost, true, 1, 100}, seed);
                EXPECT_LT(later.largest_step_error_ms, 1.5) << lost << " " << scatter_ms << " " << seed;
                EXPECT_NEAR(later.period_ms, rhythm_step_ms, 0.2) << lost << " " << scatter_ms << " " << seed;
            }
}

TEST(ArrivalRhythm, StepsOfASlowOrFastSourceCountAlike) {
    for (const double rate : {0.5, 0.9, 2.0})
        for (unsigned seed = 1; seed <= 20; ++seed) {
            const RhythmSeen seen = even_out({0.6 * rhythm_step_ms / rate, 0.1, true, rate, 100}, seed);
            EXPECT_LT(seen.largest_step_error_ms, 2.1 / rate) << rate << " " << seed;
            EXPECT_NEAR(seen.period_ms, rhythm_step_ms / rate, 0.2 / rate) << rate << " " << seed;
        }
}

TEST(ArrivalRhythm, ReadsAStepFromTheWayAndTheVelocities) {
    const LocalFrame frame(Geodetic::degrees(48, 11, 500));
    TruthSample before, now;
    before.position = frame.to_ecef(Position<Enu>(0, 0, 0));
    now.position = frame.to_ecef(Position<Enu>(0.24, 0, 0));
    EXPECT_FALSE(own_step(before, now));
    before.velocity = now.velocity = frame.to_ecef(Velocity<Enu>(12, 0, 0));
    ASSERT_TRUE(own_step(before, now));
    EXPECT_NEAR(static_cast<double>(own_step(before, now)->count()), 20e6, 1e3);
    EXPECT_FALSE(own_step(now, before)) << "backwards";
    now.jump = true;
    EXPECT_FALSE(own_step(before, now));
    now.jump = false;
    before.velocity = now.velocity = frame.to_ecef(Velocity<Enu>(0.5, 0, 0));
    EXPECT_FALSE(own_step(before, now)) << "hardly moves";
}

}  // namespace
}  // namespace skyloop
