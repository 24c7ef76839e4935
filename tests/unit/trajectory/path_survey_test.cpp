// What a survey finds of paths that are known by formula.
#include "motion/trajectory/path_survey.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "law_track.hpp"
#include "motion/trajectory/geometric_paths.hpp"
#include "motion/trajectory/recorded_path.hpp"
#include "motion/trajectory/track_csv.hpp"

namespace skyloop {
namespace {

const Geodetic surveyed_place = Geodetic::degrees(47, 8, 500);

TEST(PathSurvey, FindsTheNumbersOfACircle) {
    const Circle circle(recorded_start, {surveyed_place, Metres(200), MetresPerSecond(20), Angle()});
    const PathSurvey survey = survey_path(circle, {recorded_start, Seconds(20 * std::numbers::pi)});
    EXPECT_NEAR(survey.fastest.value, 20, 5e-3);
    EXPECT_NEAR(survey.acceleration.value, 2, 1e-3);
    EXPECT_NEAR(survey.jerk.value, 0.2, 1e-3);
    EXPECT_NEAR(survey.length_m, 400 * std::numbers::pi, 0.1);
    EXPECT_NEAR(survey.east_west_m, 400, 0.2);
    EXPECT_NEAR(survey.north_south_m, 400, 0.2);
    EXPECT_EQ(survey.velocity_steps, 0u);
    EXPECT_EQ(survey.jumps, 0u);
    EXPECT_FALSE(survey.has_orientation);
    EXPECT_TRUE(exceeded_limits(survey, std::nullopt).empty());
}

TEST(PathSurvey, TellsCornersFromAccelerations) {
    const Waypoints corner(recorded_start, {{surveyed_place, MetresPerSecond(10), {}},
                                            {Geodetic::degrees(47.001, 8, 500), MetresPerSecond(10), {}},
                                            {Geodetic::degrees(47.001, 8.002, 520), {}, {}}});
    const PathSurvey survey = survey_path(corner, {recorded_start, corner.duration()});
    EXPECT_EQ(survey.velocity_steps, 1u);
    EXPECT_NEAR(survey.largest_step.value, 10 * std::numbers::sqrt2, 0.2);
    EXPECT_NEAR(survey.largest_step.at_s, 11.1, 0.1);
    EXPECT_LT(survey.acceleration.value, 0.1);
    EXPECT_NEAR(survey.highest.value, 520, 0.01);
    const auto exceeded = exceeded_limits(survey, VehicleClass::car);
    ASSERT_EQ(exceeded.size(), 1u);
    EXPECT_EQ(exceeded[0].what, "step of the velocity");
}

TEST(PathSurvey, CountsJumpsAndWhatReceiversCannotFollow) {
    // Up at 6 g, then elsewhere.
    const PathLaw law = [](double t) { return Eigen::Vector3d(t < 60 ? 0 : 5e4, 0, 29.42 * t * t); };
    Track track = track_of(law, evenly(0, 80, 0.5), true);
    for (TrackRow& row : track.points)
        if (row.time == std::chrono::seconds(60)) row.jump = true;
    for (std::size_t i = 119; i <= 121; ++i)
        track.points[i].velocity =
            recorded_frame.to_ecef(Velocity<Enu>(0, 0, 58.84 * to_seconds(track.points[i].time).value()));
    const auto gaps = clean_track(track, Seconds(10));
    const RecordedPath path(track, *gaps, recorded_start);
    const PathSurvey survey = survey_path(path, {recorded_start, path.duration()});
    EXPECT_EQ(survey.jumps, 1u);
    EXPECT_GT(survey.largest_jump.value, 5e4);
    EXPECT_NEAR(survey.acceleration.value, 58.84, 0.5);
    std::vector<std::string> whats;
    for (const ExceededLimit& limit : exceeded_limits(survey, std::nullopt))
        whats.push_back(limit.of + " " + limit.what);
    EXPECT_THAT(whats, testing::ElementsAre("receiver acceleration", "receiver height", "receiver speed",
                                            "COCOM height", "COCOM speed"));
}

TEST(PathSurvey, TheBoxCrossesTheDateLine) {
    const Waypoints way(recorded_start, {{Geodetic::degrees(10, 179.99, 0), MetresPerSecond(100), {}},
                                         {Geodetic::degrees(10, -179.99, 0), {}, {}}});
    const PathSurvey survey = survey_path(way, {recorded_start, way.duration()});
    EXPECT_NEAR(survey.south_west.longitude.deg(), 179.99, 1e-6);
    EXPECT_NEAR(survey.north_east.longitude.deg(), 180.01, 1e-6);
    EXPECT_NEAR(longitude_span(survey).west_deg, 179.99, 1e-6);
    EXPECT_NEAR(longitude_span(survey).east_deg, -179.99, 1e-6);
    PathSurvey round;
    round.south_west = Geodetic::degrees(89, 180, 0), round.north_east = Geodetic::degrees(90, 180, 0);
    round.north_east.longitude = Angle::degrees(540);
    EXPECT_EQ(longitude_span(round).west_deg, -180);
    EXPECT_EQ(longitude_span(round).east_deg, 180);
    EXPECT_NEAR(survey.east_west_m, 0.02 / 180 * std::numbers::pi * 6378137 * std::cos(10 / 57.29577951), 10);
}

// Meridians run together there: a box of degrees would be long and thin, and leave out the pole itself.
TEST(PathSurvey, TheBoxOfAPoleIsAsWideAsTheWay) {
    for (const double pole : {90., -90.})
        for (const double off_deg : {0., 0.005}) {
            const Geodetic centre = Geodetic::degrees(pole - std::copysign(off_deg, pole), 0, 0);
            const Circle circle(recorded_start, {centre, Metres(1000), MetresPerSecond(100), Angle()});
            const PathSurvey survey = survey_path(circle, {recorded_start, Seconds(20 * std::numbers::pi)});
            EXPECT_NEAR(survey.east_west_m, 2000, 1) << pole << " " << off_deg;
            EXPECT_NEAR(survey.north_south_m, 2000, 1) << pole << " " << off_deg;
            const auto [west, east] = longitude_span(survey);
            EXPECT_EQ(west, -180);
            EXPECT_EQ(east, 180);
            const Geodetic& near = pole > 0 ? survey.north_east : survey.south_west;
            EXPECT_NEAR(near.latitude.deg(), pole, 1e-12);
        }
    const Waypoints across(recorded_start, {{Geodetic::degrees(89.999, 0, 0), MetresPerSecond(10), {}},
                                            {Geodetic::degrees(89.999, 180, 0), {}, {}}});
    const PathSurvey survey = survey_path(across, {recorded_start, across.duration()});
    EXPECT_NEAR(survey.east_west_m, 0, 0.5);
    EXPECT_NEAR(survey.north_south_m, 223.4, 0.5);
}

// All plans end so; whether a sample fell on the end or before it was a matter of rounding.
TEST(PathSurvey, StoppingAtTheEndIsNoStep) {
    for (const double east_deg : {0.01, 0.013, 0.0131, 0.02}) {
        const Waypoints plan(recorded_start, {{Geodetic::degrees(46, 7, 0), MetresPerSecond(20), {}},
                                              {Geodetic::degrees(46, 7 + east_deg, 0), {}, {}}});
        for (const double beyond_s : {0., 1e-9}) {
            const PathSurvey survey = survey_path(plan, {recorded_start, Seconds(plan.duration().value() + beyond_s)});
            EXPECT_EQ(survey.velocity_steps, 0U) << east_deg;
            EXPECT_NEAR(survey.fastest.value, 20, 0.01);
        }
    }
}

TEST(PathSurvey, ItsTableIsATrackAgain) {
    Track track = track_of(circle_of(60, 20), evenly(0, 30, 0.5), true);
    const auto gaps = clean_track(track, Seconds(10));
    const RecordedPath path(track, *gaps, recorded_start, {VehicleClass::plane, {}, {}});
    const auto samples = sample_path(path, {recorded_start, path.duration()}, Hertz(10));
    ASSERT_TRUE(samples.has_value());
    ASSERT_EQ(samples->size(), 301u);
    EXPECT_NEAR((*samples)[150].acceleration_ned.norm(), 400.0 / 60, 0.02);
    auto again = read_track_csv(path_csv(*samples), "again.csv", nullptr);
    ASSERT_TRUE(again.has_value()) << again.error().message;
    ASSERT_EQ(again->points.size(), 301u);
    for (std::size_t i = 0; i < 301; ++i) {
        EXPECT_LT((again->points[i].position - (*samples)[i].state.position).length().value(), 1e-4);
        ASSERT_TRUE(again->points[i].attitude.has_value());
        EXPECT_LT(again->points[i].attitude->body_to_ned().angularDistance(
                      (*samples)[i].state.orientation->attitude.body_to_ned()),
                  1e-5);
    }
    EXPECT_FALSE(sample_path(path, {recorded_start, Seconds(1e7)}, Hertz(100)).has_value());
}

TEST(PathSurvey, SamplesEndWhereThePathEnds) {
    Track track = track_of(circle_of(60, 20), evenly(0, 30, 0.5), true);
    const auto gaps = clean_track(track, Seconds(10));
    const RecordedPath path(track, *gaps, recorded_start, {VehicleClass::plane, {}, {}});
    const auto samples = sample_path(path, {recorded_start, Seconds(29.4)}, Hertz(1));
    ASSERT_TRUE(samples.has_value());
    ASSERT_EQ(samples->size(), 31u);
    EXPECT_EQ((*samples)[29].time_s, 29);
    EXPECT_EQ(samples->back().time_s, 29.4);
}

TEST(PathSurvey, SamplesOfAJumpHaveNoAccelerationOfItAndAReset) {
    const PathLaw law = [](double t) { return Eigen::Vector3d(t < 5 ? 10 * t : 10 * t + 1000, 0, 0); };
    Track track = track_of(law, evenly(0, 10, 1), false);
    track.points[5].jump = true;
    const auto gaps = clean_track(track, Seconds(10));
    const RecordedPath path(track, *gaps, recorded_start);
    const auto samples = sample_path(path, {recorded_start, path.duration()}, Hertz(1));
    ASSERT_TRUE(samples.has_value());
    for (const PathSample& sample : *samples) {
        EXPECT_LT(sample.acceleration_ned.norm(), 0.5) << sample.time_s;
        EXPECT_EQ(sample.jumped, sample.time_s == 5) << sample.time_s;
    }
    const std::string table = path_csv(*samples);
    EXPECT_THAT(table, testing::HasSubstr("ad_mps2,reset\n"));
    const auto again = read_track_csv(table, "again.csv", nullptr);
    ASSERT_TRUE(again.has_value()) << again.error().message;
    for (std::size_t i = 0; i < again->points.size(); ++i)
        EXPECT_EQ(again->points[i].jump, i == 5);
}

}  // namespace
}  // namespace skyloop
