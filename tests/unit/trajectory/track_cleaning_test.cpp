// What cleaning makes of times and places that cannot be (FEEDS.md 1.14), and what it tells.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "law_track.hpp"
#include "motion/trajectory/recorded_path.hpp"

namespace skyloop {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

const PathLaw east_at_10 = [](double t) { return Eigen::Vector3d(10 * t, 0, 0); };

Track stamped(const std::vector<double>& times, double real_step = 1) {
    Track track = track_of(east_at_10, evenly(0, real_step * static_cast<double>(times.size() - 1), real_step), false);
    for (std::size_t i = 0; i < times.size(); ++i) {
        track.points[i].time = to_nanoseconds(Seconds(times[i]));
        track.points[i].line = i + 1;
    }
    return track;
}

std::vector<double> times_of(const Track& track) {
    std::vector<double> times;
    for (const TrackRow& row : track.points)
        times.push_back(to_seconds(row.time).value());
    return times;
}

std::vector<std::size_t> jumps_of(const Track& track) {
    std::vector<std::size_t> jumps;
    for (std::size_t i = 0; i < track.points.size(); ++i)
        if (track.points[i].jump) jumps.push_back(i);
    return jumps;
}

TEST(TrackCleaning, CoarseStampsAreSpread) {
    // Five rows a second, stamped in whole seconds.
    Track track = stamped({0, 0, 0, 0, 0, 1, 1, 1, 1, 1, 2, 2, 2, 2, 2}, 0.2);
    ASSERT_TRUE(clean_track(track, Seconds(10)).has_value());
    ASSERT_EQ(track.points.size(), 15u);
    for (std::size_t i = 0; i < 15; ++i)
        EXPECT_NEAR(times_of(track)[i], 0.2 * static_cast<double>(i), 1e-9);
    EXPECT_THAT(track.notes, ElementsAre(HasSubstr("12 rows were spread over steps of 1 s")));
}

TEST(TrackCleaning, RepeatedRowsOfOnePlaceAreNoCoarseStamps) {
    Track track = stamped({0, 1, 1, 1, 2});
    track.points[2].position = track.points[3].position = track.points[1].position;
    ASSERT_TRUE(clean_track(track, Seconds(10)).has_value());
    EXPECT_THAT(times_of(track), ElementsAre(0, 1, 2));
    EXPECT_THAT(track.notes, ElementsAre(HasSubstr("2 rows repeat the time")));
}

TEST(TrackCleaning, ANewBeginningIsAJump) {
    Track track = stamped({100, 101, 102, 103, 5, 6, 7});
    ASSERT_TRUE(clean_track(track, Seconds(10)).has_value());
    EXPECT_THAT(times_of(track), ElementsAre(100, 101, 102, 103, 104, 105, 106));
    EXPECT_THAT(jumps_of(track), ElementsAre(4u));
    EXPECT_THAT(track.notes, ElementsAre(HasSubstr("1 times the time goes back by more than 2 s")));
}

TEST(TrackCleaning, PartsOfOneClockArePutInOrder) {
    Track track = stamped({100, 101, 102, 5, 6, 7});
    track.origin = recorded_start;
    ASSERT_TRUE(clean_track(track, Seconds(1000)).has_value());
    EXPECT_THAT(times_of(track), ElementsAre(5, 6, 7, 100, 101, 102));
    EXPECT_THAT(jumps_of(track), ElementsAre());
    EXPECT_THAT(track.notes, ElementsAre(HasSubstr("2 parts do not follow each other in time")));
}

TEST(TrackCleaning, RowsThatStandNewestFirstAreTurnedRound) {
    Track track = stamped({20, 15, 10, 5, 0});
    const Position<Ecef> newest = track.points.front().position;
    track.points[3].jump = true;  // no way between 10 s and 5 s
    ASSERT_TRUE(clean_track(track, Seconds(100)).has_value());
    EXPECT_THAT(times_of(track), ElementsAre(0, 5, 10, 15, 20));
    EXPECT_EQ((track.points.back().position - newest).length().value(), 0);
    EXPECT_THAT(jumps_of(track), ElementsAre(2u));
    EXPECT_THAT(track.notes, ElementsAre("the rows stand newest first and were turned round"));
}

TEST(TrackCleaning, ARefusalSaysWhyRowsWereLeftOut) {
    Track track = stamped({5, 5, 5});
    track.notes.emplace_back("7 epochs without a fix were left out");
    for (TrackRow& row : track.points)
        row.position = track.points.front().position;
    const auto cleaned = clean_track(track, Seconds(100));
    ASSERT_FALSE(cleaned.has_value());
    EXPECT_THAT(cleaned.error().message, HasSubstr("1 rows with a time and a place of their own; expected two or more; "
                                                   "7 epochs without a fix were left out; 2 rows repeat the time"));
}

// What came late stands with its own time where its place lies between those of its neighbours; with a wrong time
// nowhere.
TEST(TrackCleaning, ALateRowKeepsItsTimeAndAWrongTimeCostsItsRow) {
    const std::vector<double> whole = evenly(0, 20, 1);
    std::vector<double> wrong = whole;
    wrong[8] = -3592, wrong[12] = 6.5, wrong[15] = 10;
    Track track = stamped(wrong);
    track.origin = recorded_start;
    ASSERT_TRUE(clean_track(track, Seconds(100)).has_value());
    EXPECT_THAT(times_of(track), ElementsAre(0, 1, 2, 3, 4, 5, 6, 7, 9, 10, 11, 13, 14, 16, 17, 18, 19, 20));
    EXPECT_THAT(jumps_of(track), ElementsAre());
    EXPECT_THAT(track.notes,
                ElementsAre(HasSubstr("3 rows have a time that fell back and were left out, first in line 9")));

    Track late = stamped(whole);
    late.origin = recorded_start;
    const std::vector<TrackRow> in_order = late.points;
    std::rotate(late.points.begin() + 5, late.points.begin() + 7, late.points.begin() + 12);  // 5 and 6 behind 11
    ASSERT_TRUE(clean_track(late, Seconds(100)).has_value());
    EXPECT_EQ(times_of(late), whole);
    for (std::size_t i = 0; i < in_order.size(); ++i)
        EXPECT_EQ((late.points[i].position - in_order[i].position).length().value(), 0) << i;
    EXPECT_THAT(late.notes, ElementsAre(HasSubstr("2 rows do not stand where their time belongs and were put in its "
                                                  "order, first in line 6")));
}

TEST(TrackCleaning, ManyRowsThatCameLateAreOfTheSameClock) {
    Track track = stamped(evenly(0, 30, 1));
    track.origin = recorded_start;
    std::rotate(track.points.begin() + 5, track.points.begin() + 15, track.points.begin() + 25);
    ASSERT_TRUE(clean_track(track, Seconds(100)).has_value());
    EXPECT_EQ(times_of(track), evenly(0, 30, 1));
    EXPECT_THAT(jumps_of(track), ElementsAre());
    EXPECT_THAT(track.notes, ElementsAre(HasSubstr("2 parts do not follow each other in time")));
}

TEST(TrackCleaning, ALastDateThatFellBackAndDatesOfLongBeforeAreLeftOut) {
    Track track = stamped({-6.2e8, -6.2e8 + 1, -6.2e8 + 2, 3, 4, 5, 6, 7, 8, -3600});
    track.origin = recorded_start;
    ASSERT_TRUE(clean_track(track, Seconds(100)).has_value());
    EXPECT_THAT(times_of(track), ElementsAre(3, 4, 5, 6, 7, 8));
    EXPECT_THAT(track.notes, ElementsAre(HasSubstr("3 rows have a time long before all others and were left out"),
                                         HasSubstr("1 rows have a time that fell back")));
}

// A clock that counts from its start may begin anew, but a single row that the next one goes on from begins nothing.
TEST(TrackCleaning, ALoneRowThatFellBackIsNoBeginning) {
    Track track = stamped({100, 101, 102, 5, 104, 105, 6, 7, 8});
    ASSERT_TRUE(clean_track(track, Seconds(100)).has_value());
    EXPECT_THAT(times_of(track), ElementsAre(100, 101, 102, 104, 105, 106, 107, 108));
    EXPECT_THAT(jumps_of(track), ElementsAre(5u));
    EXPECT_THAT(track.notes, ElementsAre(HasSubstr("1 times the time goes back by more than 2 s"),
                                         HasSubstr("1 rows have a time that fell back and were left out")));
}

TEST(TrackCleaning, AFirstTimeThatRanAheadIsLeftOut) {
    Track track = stamped({100, 5, 6, 7, 8});
    track.origin = recorded_start;
    ASSERT_TRUE(clean_track(track, Seconds(1000)).has_value());
    EXPECT_THAT(times_of(track), ElementsAre(5, 6, 7, 8));
    EXPECT_THAT(track.notes, ElementsAre(HasSubstr("1 rows have a time that ran ahead")));
}

// Segments of a GPX file, the newest first.
TEST(TrackCleaning, PartsThatBeginByAJumpDoSoInWhateverOrderTheyAreStored) {
    Track track = stamped({20, 21, 22, 10, 11, 12, 0, 1, 2});
    track.origin = GpsTime{};
    track.points[3].jump = track.points[6].jump = true;
    ASSERT_TRUE(clean_track(track, Seconds(60), GapPolicy::bridge));
    EXPECT_THAT(times_of(track), ElementsAre(0, 1, 2, 10, 11, 12, 20, 21, 22));
    EXPECT_THAT(jumps_of(track), ElementsAre(3, 6));
}

TEST(TrackCleaning, ASingleStampAheadIsLeftOut) {
    Track track = stamped({0, 1, 2, 900, 4, 5});
    ASSERT_TRUE(clean_track(track, Seconds(10)).has_value());
    EXPECT_THAT(times_of(track), ElementsAre(0, 1, 2, 4, 5));
    EXPECT_THAT(track.notes,
                ElementsAre(HasSubstr("1 rows have a time that ran ahead and were left out, first in line 4")));
}

TEST(TrackCleaning, ALoneRowFarAwayIsLeftOutAndALeapIsAJump) {
    Track track = stamped({0, 1, 2, 3, 4, 5, 6, 7, 8, 9});
    track.points[3].position = to_ecef(Geodetic::degrees(0, 0, 0));
    for (std::size_t i = 7; i < 10; ++i)
        track.points[i].position = track.points[i].position + recorded_frame.to_ecef(Displacement<Enu>(0, 5000, 0));
    ASSERT_TRUE(clean_track(track, Seconds(10)).has_value());
    EXPECT_THAT(times_of(track), ElementsAre(0, 1, 2, 4, 5, 6, 7, 8, 9));
    EXPECT_THAT(jumps_of(track), ElementsAre(6u));
    EXPECT_THAT(track.notes,
                ElementsAre(HasSubstr("1 rows lie far from both neighbours"), HasSubstr("1 times the path leaps")));
}

TEST(TrackCleaning, WhatIsFastAllTheTimeIsNoLeap) {
    // Parked for a minute, then a rocket at up to 30 g.
    Track track = track_of([](double t) { return Eigen::Vector3d(0, 0, t < 60 ? 0 : 150 * (t - 60) * (t - 60)); },
                           evenly(0, 80, 1), false);
    ASSERT_TRUE(clean_track(track, Seconds(10)).has_value());
    EXPECT_THAT(jumps_of(track), ElementsAre());
    EXPECT_TRUE(track.notes.empty());
}

TEST(TrackCleaning, NumbersThatAreNoneAreLeftOut) {
    Track track = stamped({0, 1, 2, 3, 4});
    track.points[1].position = Position<Ecef>(std::numeric_limits<double>::quiet_NaN(), 0, 0);
    track.points[2].position = Position<Ecef>(0, 0, 0);
    track.points[3].velocity = Velocity<Ecef>(0, std::numeric_limits<double>::infinity(), 0);
    ASSERT_TRUE(clean_track(track, Seconds(10)).has_value());
    EXPECT_THAT(times_of(track), ElementsAre(0, 3, 4));
    EXPECT_FALSE(track.points[1].velocity.has_value());
    EXPECT_THAT(track.notes,
                ElementsAre(HasSubstr("2 rows have no place on the Earth"), HasSubstr("1 rows have a velocity")));
}

TEST(TrackCleaning, TimesBeyondAnyTrackAreLeftOut) {
    Track track = stamped({0, 1, 2, 3, 4});
    track.points[1].time = Nanoseconds::max();
    track.points[3].time = Nanoseconds::min();
    ASSERT_TRUE(clean_track(track, Seconds(10)).has_value());
    EXPECT_THAT(times_of(track), ElementsAre(0, 2, 4));
    EXPECT_THAT(track.notes, ElementsAre(HasSubstr("2 rows have a time further than 70 years")));
    // Forty years, again and again, each time a little less.
    Track long_one = stamped({0, 1.26e9, 0, 1.25e9, 0, 1.24e9, 0, 1.23e9, 0, 1.22e9, 0, 1.21e9});
    ASSERT_TRUE(clean_track(long_one, Seconds(5e9)).has_value());
    EXPECT_LT(times_of(long_one).back(), 5e9);
}

TEST(TrackCleaning, DatesOfTheNextHundredYearsAreTimes) {
    for (const double since_1980 : {0.0, 1.4e9, 2.2e9, 2.26e9, 6.9e9}) {  // 1980, 2024, 2049, 2051, 2198
        Track track = stamped({0, 1, 2, 3, 4});
        track.origin = GpsTime{};
        for (TrackRow& row : track.points)
            row.time += to_nanoseconds(Seconds(since_1980));
        ASSERT_TRUE(clean_track(track, Seconds(10)).has_value()) << since_1980;
        ASSERT_EQ(track.points.size(), 5u) << since_1980;
        EXPECT_EQ(*track.origin + track.points[1].time, GpsTime(to_nanoseconds(Seconds(since_1980 + 1))));
        EXPECT_TRUE(track.notes.empty()) << since_1980;
    }
    // One row of before the recorder knew the date.
    Track track = stamped({0, 2.26e9, 2.26e9 + 1, 2.26e9 + 2, 2.26e9 + 3});
    track.origin = GpsTime{};
    ASSERT_TRUE(clean_track(track, Seconds(10)).has_value());
    EXPECT_EQ(track.points.size(), 4u);
    EXPECT_THAT(track.notes, ElementsAre(HasSubstr("1 rows have a time further than 70 years")));
}

TEST(TrackCleaning, EachPolicyOfGaps) {
    const std::vector<double> times{0, 1, 2, 3, 103, 104, 105};
    const auto cleaned = [&](GapPolicy policy, std::size_t gaps) {
        Track track = stamped(times);
        const auto found = clean_track(track, Seconds(10), policy);
        EXPECT_EQ(found->size(), gaps);
        EXPECT_EQ(track.notes.size(), 1u);
        return track;
    };
    EXPECT_THAT(jumps_of(cleaned(GapPolicy::bridge, 1)), ElementsAre());
    EXPECT_THAT(jumps_of(cleaned(GapPolicy::outage, 1)), ElementsAre());
    EXPECT_THAT(jumps_of(cleaned(GapPolicy::hold, 0)), ElementsAre(4u));
    const Track shorter = cleaned(GapPolicy::compress, 0);
    EXPECT_THAT(times_of(shorter), ElementsAre(0, 1, 2, 3, testing::DoubleNear(4, 1e-6), testing::DoubleNear(5, 1e-6),
                                               testing::DoubleNear(6, 1e-6)))
        << "10 m at 10 m/s";
    EXPECT_THAT(jumps_of(shorter), ElementsAre());
}

TEST(TrackCleaning, AnythingBecomesAPathThatCanBeAsked) {
    // Times and places at random, with all defects together.
    std::mt19937 dice(3);
    const auto below = [&](int n) { return static_cast<int>(dice() % static_cast<unsigned>(n)); };
    const auto one_in = [&](int n) { return below(n) == 0; };
    for (int round = 0; round < 300; ++round) {
        Track track = stamped(evenly(0, 2 + below(60), 1));
        for (TrackRow& row : track.points) {
            if (one_in(9)) row.time = to_nanoseconds(Seconds(below(3000) - 1000));
            if (one_in(9)) row.time -= std::chrono::milliseconds(below(4000));
            if (one_in(15)) row.position = Position<Ecef>(std::nan(""), 1, 2);
            if (one_in(15)) row.position = to_ecef(Geodetic::degrees(below(90), below(180), 0));
            if (one_in(5)) row.velocity = Velocity<Ecef>(below(300), below(300), 0);
            if (one_in(5)) row.attitude = Attitude::roll_pitch_yaw(Angle::degrees(below(180)), {}, {});
            if (one_in(15)) row.jump = true;
        }
        if (one_in(2)) track.origin = recorded_start;
        const auto policy = static_cast<GapPolicy>(below(4));
        const auto gaps = clean_track(track, Seconds(5), policy);
        if (!gaps) continue;
        for (std::size_t i = 1; i < track.points.size(); ++i)
            ASSERT_GT(track.points[i].time, track.points[i - 1].time);
        const CurveSettings settings{
            static_cast<VehicleClass>(below(track_vehicle_count)), {}, static_cast<Smoothing>(below(3))};
        const RecordedPath path(track, *gaps, recorded_start, settings);
        for (int k = 0; k < 200; ++k) {
            const double t = path.duration().value() * (k - 5) / 190;
            const TruthState state = path.at(advanced(recorded_start, Seconds(t)));
            ASSERT_TRUE(state.position.vector().allFinite());
            ASSERT_TRUE(state.velocity.vector().allFinite());
            ASSERT_TRUE(state.orientation && state.orientation->turn_rate.allFinite());
            ASSERT_NEAR(state.orientation->attitude.body_to_ned().norm(), 1, 1e-9);
        }
    }
}

}  // namespace
}  // namespace skyloop
