// How a run plays a recorded path: each option is a law that holds at every instant.
#include "motion/trajectory/recorded_path.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "base/geo/attitude.hpp"
#include "law_track.hpp"

namespace skyloop {
namespace {

const GpsTime played_start = to_gps_time(2304, 300000.0);

std::unique_ptr<RecordedPath> played_circle(double seconds, GpsTime first) {
    Track track = track_of(circle_of(60, 20, 0), evenly(0, seconds, 0.5), true);
    const auto gaps = clean_track(track, Seconds(10));
    return std::make_unique<RecordedPath>(track, *gaps, first, CurveSettings{VehicleClass::car, {}, {}});
}

PlayedPath play(const Playback& playback, double seconds = 30) {
    return PlayedPath(played_circle(seconds, played_start), played_start, playback);
}

TruthState played_at(const Trajectory& path, double t) { return path.at(advanced(played_start, Seconds(t))); }

void expect_same(const TruthState& a, const TruthState& b, double pace, double t) {
    EXPECT_LT((a.position - b.position).length().value(), 1e-6) << t;
    EXPECT_LT((a.velocity.vector() - pace * b.velocity.vector()).norm(), 1e-6) << t;
    ASSERT_EQ(a.orientation.has_value(), b.orientation.has_value());
    EXPECT_LT((a.orientation->turn_rate - pace * b.orientation->turn_rate).norm(), 1e-6) << t;
    EXPECT_LT(a.orientation->attitude.body_to_ned().angularDistance(b.orientation->attitude.body_to_ned()), 1e-6) << t;
}

TEST(PlayedPath, WithoutOptionsItIsTheTrack) {
    const auto track = played_circle(30, played_start);
    const PlayedPath path = play({});
    for (double t = -2; t < 35; t += 0.1)
        expect_same(played_at(path, t), played_at(*track, t), 1, t);
}

TEST(PlayedPath, DelayAndSkipAreShiftsOfTime) {
    const auto track = played_circle(30, played_start);
    const PlayedPath path = play({Seconds(4), Seconds(7.5), 1, EndOfPath::hold});
    for (double t = 4; t < 40; t += 0.1)
        expect_same(played_at(path, t), played_at(*track, t - 4 + 7.5), 1, t);
    const TruthState before = played_at(path, 1);
    EXPECT_LT((before.position - played_at(*track, 7.5).position).length().value(), 1e-6) << "it stands there";
    EXPECT_EQ(before.velocity.length().value(), 0);
    EXPECT_EQ(before.orientation->turn_rate.norm(), 0);
    EXPECT_EQ(path.first_end(), advanced(played_start, Seconds(26.5)));
}

TEST(PlayedPath, ScaledTimeScalesVelocities) {
    const auto track = played_circle(30, played_start);
    for (const double scale : {0.25, 2.0, 10.0}) {
        const PlayedPath path = play({Seconds(0), Seconds(0), scale, EndOfPath::hold});
        for (double t = 0; t < 30 / scale; t += 0.1 / scale)
            expect_same(played_at(path, t), played_at(*track, t * scale), scale, t);
        EXPECT_NEAR(difference(path.first_end(), played_start).value(), 30 / scale, 1e-9);
        EXPECT_EQ(played_at(path, 31 / scale).velocity.length().value(), 0);
    }
}

TEST(PlayedPath, ALoopClosesSmoothlyAndRepeats) {
    // Ten metres before the circle is full.
    const double nearly = std::floor(2 * (120 * std::numbers::pi - 10) / 20) / 2;
    const PlayedPath path = play({Seconds(0), Seconds(0), 1, EndOfPath::loop}, nearly);
    ASSERT_TRUE(path.period().has_value());
    EXPECT_FALSE(path.jumps_back());
    const double period = path.period()->value();
    const double way = 120 * std::numbers::pi - 20 * nearly;
    EXPECT_NEAR(period - nearly, way / 20, 0.1 * way / 20) << "at its speed";
    for (double t = 0; t < period; t += 0.37) {
        expect_same(played_at(path, t + period), played_at(path, t), 1, t);
        expect_same(played_at(path, t + 1000 * period), played_at(path, t), 1, t);
    }
    // Neither velocity nor turn rate steps, and both are the slopes of what they belong to.
    for (double t = nearly - 1; t < nearly + 4; t += 0.005) {
        const TruthState before = played_at(path, t - 0.001), now = played_at(path, t),
                         after = played_at(path, t + 0.001);
        ASSERT_LT((after.velocity.vector() - before.velocity.vector()).norm(), 0.002 * 9) << t;
        ASSERT_LT(((after.position - before.position).vector() / 0.002 - now.velocity.vector()).norm(), 1e-3) << t;
        ASSERT_LT((after.orientation->turn_rate - before.orientation->turn_rate).norm(), 0.02) << t;
    }
}

TEST(PlayedPath, ALoopFarFromItsBeginningJumps) {
    Track track = track_of([](double t) { return Eigen::Vector3d(10 * t, 0, 0); }, evenly(0, 60, 1), true);
    const auto gaps = clean_track(track, Seconds(10));
    const PlayedPath path(std::make_unique<RecordedPath>(track, *gaps, played_start), played_start,
                          {Seconds(0), Seconds(20), 1, EndOfPath::loop});
    EXPECT_TRUE(path.jumps_back());
    EXPECT_NEAR((played_at(path, 39.999).position - track.points[60].position).length().value(), 0, 0.02);
    EXPECT_NEAR((played_at(path, 40.001).position - track.points[0].position).length().value(), 0, 0.02)
        << "the next round begins at the first row, whatever was skipped";
    for (double t = 0; t < 300; t += 0.5)
        ASSERT_NEAR(played_at(path, t).velocity.length().value(), 10, 1e-6);
}

}  // namespace
}  // namespace skyloop
