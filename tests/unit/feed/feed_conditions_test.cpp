// What a path makes of a source under all the conditions of a network and of simulators (FEEDS.md 5.3, number 5).
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "base/geo/local_frame.hpp"
#include "motion/trajectory/live_path.hpp"
#include "motion/trajectory/source_clock.hpp"

namespace skyloop {
namespace {

constexpr double source_step_s = 0.02, ask_s = 0.01, circle_speed_mps = 20, circle_m = 80;

// When the statement number `i` of the source arrives, s; nothing: it is lost. Its own time is i times source_step_s.
using Arrival = std::function<std::optional<double>(int)>;

struct Outcome {
    double largest_step_m = 0;   // of the path beyond its own velocity, between two looks
    double largest_error_m = 0;  // from where the source was, in the last second
    double largest_speed_mps = 0;
    LivePathCounts counts;
    int states[5] = {};
    int restarts = 0;
};

TruthSample circling(double t) {
    static const LocalFrame frame(Geodetic::degrees(48, 11, 500));
    const double angle = circle_speed_mps / circle_m * t;
    TruthSample sample;
    sample.source_time = to_nanoseconds(Seconds(t));
    sample.position = frame.to_ecef(Position<Enu>(circle_m * std::sin(angle), circle_m * std::cos(angle), 0));
    sample.velocity =
        frame.to_ecef(Velocity<Enu>(circle_speed_mps * std::cos(angle), -circle_speed_mps * std::sin(angle), 0));
    return sample;
}

// Real time: the path is asked every 10 ms for the present.
Outcome watch_source(double seconds, const Arrival& arrival, const std::function<double(int)>& source_time) {
    const GpsTime start = GpsTime() + std::chrono::hours(24 * 365 * 46);
    SourceClock clock(ClockMode::realtime, start, 0);
    LivePathSettings settings;
    settings.before = to_geodetic(circling(0).position);
    LivePath path(settings);
    std::vector<std::pair<double, int>> arrivals;
    for (int i = 0; i < static_cast<int>(4 * seconds / source_step_s); ++i)
        if (const auto at = arrival(i)) arrivals.emplace_back(*at, i);
    std::stable_sort(arrivals.begin(), arrivals.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    Outcome outcome;
    std::optional<TruthState> before;
    std::uint64_t jumps = 0;
    auto next = arrivals.begin();
    double newest_said = 0;
    for (double now = 0; now < seconds; now += ask_s) {
        for (; next != arrivals.end() && next->first <= now; ++next) {
            TruthSample sample = circling(source_time(next->second));
            sample.received_ns = to_nanoseconds(Seconds(next->first)).count();
            const auto stamp = clock.stamp(sample.source_time, sample.received_ns);
            sample.jump = stamp.restarted;
            outcome.restarts += stamp.restarted ? 1 : 0;
            path.add(stamp.time, sample);
            newest_said = std::max(newest_said, source_time(next->second));
        }
        const GpsTime time = advanced(start, Seconds(now));
        const TruthState state = path.at(time);
        ++outcome.states[static_cast<std::size_t>(path.state(time))];
        outcome.largest_speed_mps = std::max(outcome.largest_speed_mps, state.velocity.length().value());
        if (before && path.counts().jumps == jumps && path.counts().samples > 1) {
            const Eigen::Vector3d moved = (state.position - before->position).vector();
            const Eigen::Vector3d told = (state.velocity.vector() + before->velocity.vector()) / 2 * ask_s;
            outcome.largest_step_m = std::max(outcome.largest_step_m, (moved - told).norm());
        }
        if (now > seconds - 1)
            outcome.largest_error_m =
                std::max(outcome.largest_error_m, (state.position - circling(newest_said).position).length().value());
        jumps = path.counts().jumps;
        before = state;
    }
    outcome.counts = path.counts();
    return outcome;
}

double own_time(int i) { return source_step_s * i; }

TEST(FeedConditions, DelaysThatScatterAreNotSeen) {
    std::mt19937 random(21);
    std::exponential_distribution<double> delay(1 / 0.004);
    const Outcome seen = watch_source(
        20, [&](int i) { return own_time(i) + 0.001 + delay(random); }, own_time);
    EXPECT_EQ(seen.counts.jumps, 0u);
    EXPECT_LT(seen.largest_step_m, 0.1);   // beside the velocity, which is the source's: what the clock learns
    EXPECT_LT(seen.largest_error_m, 1.5);  // the age of the newest sample: at most 50 ms or so
    EXPECT_EQ(seen.states[static_cast<int>(LiveState::holding)], 0);
}

TEST(FeedConditions, AFifthOfTheDatagramsMayBeLostDoubledOrOvertaken) {
    std::mt19937 random(22);
    std::uniform_real_distribution<double> lot(0, 1);
    const Arrival arrival = [&](int i) -> std::optional<double> {
        if (lot(random) < 0.2) return std::nullopt;
        return own_time(i) + (lot(random) < 0.2 ? 0.05 : 0.001);
    };
    // Every statement twice.
    const Outcome seen = watch_source(
        20, [&](int i) { return arrival(i / 2); }, [](int i) { return own_time(i / 2); });
    EXPECT_EQ(seen.counts.jumps, 0u);
    EXPECT_GT(seen.counts.late, 50u);
    EXPECT_LT(seen.largest_step_m, 0.1);  // while the way between the clocks is found
    EXPECT_LT(seen.largest_speed_mps, 1.3 * circle_speed_mps);
}

TEST(FeedConditions, StallsOfASecondGoThroughCoastAndFadeToAReturn) {
    // Every five seconds nothing comes for one; then all of it at once.
    const Outcome seen = watch_source(
        21,
        [](int i) {
            const double t = own_time(i), inside = std::fmod(t, 5);
            return inside >= 3 && inside < 4 ? t - inside + 4 : t + 0.001;
        },
        own_time);
    EXPECT_GE(seen.counts.coasts, 4u);
    EXPECT_GT(seen.states[static_cast<int>(LiveState::fading)], 100);
    EXPECT_EQ(seen.counts.holds, 0u);
    EXPECT_LE(seen.counts.jumps, 4u);
    EXPECT_LT(seen.largest_step_m, 0.1);
    EXPECT_LT(seen.largest_error_m, 1);
}

TEST(FeedConditions, AnySpeedOfTheSourceIsSteadyAfterItsFirstSeconds) {
    for (const double rate : {0.5, 0.9, 1.0, 2.0}) {
        const Outcome seen = watch_source(
            20, [&](int i) { return own_time(i) / rate + 0.001; }, own_time);
        EXPECT_LE(seen.counts.jumps, 3u) << rate;  // while the rate is learned
        EXPECT_LT(seen.largest_error_m, 1.5) << rate;
        EXPECT_EQ(seen.counts.holds, 0u) << rate;
    }
}

TEST(FeedConditions, APauseHoldsAndARestartIsAJump) {
    // It stands still from 5 s to 9 s, and begins anew at 15 s.
    const Outcome seen = watch_source(
        20, [](int i) { return own_time(i) + (own_time(i) >= 5 ? 4 : 0) + 0.001; },
        [](int i) { return own_time(i) >= 11 ? own_time(i) - 11 : own_time(i); });
    EXPECT_EQ(seen.counts.holds, 1u);
    EXPECT_EQ(seen.restarts, 1);
    EXPECT_GE(seen.counts.jumps, 1u);
    EXPECT_LE(seen.counts.jumps, 3u);
    EXPECT_GT(seen.states[static_cast<int>(LiveState::holding)], 200);
    EXPECT_LT(seen.largest_step_m, 0.1);
}

}  // namespace
}  // namespace skyloop
