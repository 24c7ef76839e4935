#include "study/analysis/standing_log.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "base/core/random.hpp"
#include "base/geo/local_frame.hpp"

namespace skyloop {
namespace {

using ::testing::HasSubstr;

const Geodetic roof = Geodetic::degrees(36.970631, -121.904695, 10);
const GpsTime noon = to_gps_time(1727, 43200.0);

// A fix a second, `enu` metres from the roof.
FixSample fix_at(int second, const Eigen::Vector3d& enu) {
    FixSample sample;
    sample.time = noon + std::chrono::seconds(second);
    sample.has_fix = true;
    sample.position = to_geodetic(LocalFrame(roof).to_ecef(Position<Enu>(enu)));
    return sample;
}

FixSeries series_of(std::vector<FixSample> samples) { return {"roof.csv", std::move(samples), true, Seconds(1), {}}; }

// Where the vehicle is at a second; the receiver adds two metres of noise.
template <class Path>
FixSeries noisy(int seconds, Path path) {
    RandomStream random(1, "noise");
    std::vector<FixSample> samples;
    for (int i = 0; i < seconds; ++i) {
        const Eigen::Vector3d noise(2 * random.normal(), 2 * random.normal(), 3 * random.normal());
        samples.push_back(fix_at(i, path(i) + noise));
    }
    return series_of(std::move(samples));
}

FixSeries at_rest(int seconds) {
    return noisy(seconds, [](int) { return Eigen::Vector3d(0, 0, 0); });
}

std::string refusal(FixSeries series) {
    const auto standing = standing_log(std::move(series));
    return standing ? "taken" : standing.error().message;
}

TEST(StandingLog, tells_place_time_length_and_error) {
    const auto standing = standing_log(at_rest(700), roof);
    ASSERT_TRUE(standing) << standing.error().message;
    EXPECT_EQ(standing->place.latitude.deg(), roof.latitude.deg());
    EXPECT_EQ(standing->start, noon);
    EXPECT_EQ(standing->length.value(), 700);
    EXPECT_EQ(standing->errors.reference, ReferenceKind::given_point);
    EXPECT_NEAR(standing->horizontal.mean, 2 * std::sqrt(std::numbers::pi / 2), 0.15);
    EXPECT_EQ(standing->horizontal.n, 700u);
}

TEST(StandingLog, takes_the_mean_where_nobody_knows_the_place) {
    const auto standing = standing_log(at_rest(700));
    ASSERT_TRUE(standing) << standing.error().message;
    EXPECT_EQ(standing->errors.reference, ReferenceKind::own_mean);
    EXPECT_LT((to_ecef(standing->place) - to_ecef(roof)).vector().norm(), 0.5);
}

TEST(StandingLog, takes_the_place_of_a_file_that_knows_it) {
    FixSeries series = at_rest(700);
    for (FixSample& sample : series.samples)
        sample.truth = roof;
    const auto standing = standing_log(std::move(series), Geodetic::degrees(0, 0, 0));
    ASSERT_TRUE(standing) << standing.error().message;
    EXPECT_EQ(standing->errors.reference, ReferenceKind::truth);
    EXPECT_EQ(standing->place.longitude.deg(), roof.longitude.deg());
}

TEST(StandingLog, refuses_what_is_too_short) {
    EXPECT_THAT(refusal(at_rest(599)), HasSubstr("roof.csv: is 599 s long, of 599 fixes; expected 600 s or more"));
    EXPECT_EQ(refusal(at_rest(600)), "taken");
}

TEST(StandingLog, refuses_a_gap_and_says_when) {
    FixSeries series = at_rest(900);
    series.samples.erase(series.samples.begin() + 301, series.samples.begin() + 310);
    EXPECT_EQ(refusal(series), "taken");  // 10 s
    series.samples.erase(series.samples.begin() + 301);
    EXPECT_THAT(refusal(series), HasSubstr("roof.csv: has no fix for 11.0 s after 2013-02-10T12:04:44Z; expected gaps "
                                           "of at most 10 s"));
}

TEST(StandingLog, counts_rows_without_a_fix_as_a_gap) {
    FixSeries series = at_rest(900);
    for (FixSample& sample : series.samples)
        sample.time.reset();
    series.dated = false;
    for (std::size_t i = 300; i < 320; ++i)
        series.samples[i].has_fix = false;
    EXPECT_THAT(refusal(series), HasSubstr("has no fix for 21.0 s after fix 300;"));
}

// A fix a minute is no gap.
TEST(StandingLog, takes_slow_logs) {
    FixSeries series = at_rest(60);
    for (std::size_t i = 0; i < series.samples.size(); ++i)
        series.samples[i].time = noon + std::chrono::seconds(60 * i);
    series.interval = Seconds(60);
    EXPECT_EQ(refusal(series), "taken");
}

TEST(StandingLog, refuses_time_that_goes_back) {
    FixSeries series = at_rest(900);
    series.samples[500].time = noon;
    EXPECT_THAT(refusal(series), HasSubstr("roof.csv: time goes back by 499.0 s after 2013-02-10T12:08:03Z"));
}

TEST(StandingLog, refuses_who_goes_away) {
    EXPECT_THAT(refusal(noisy(900, [](int s) { return Eigen::Vector3d(s > 800 ? 2.0 * (s - 800) : 0.0, 0, 0); })),
                HasSubstr("roof.csv: moves: in minute 15 it is "));
    // A slow one, which hardly moves in ten seconds.
    EXPECT_THAT(refusal(noisy(900, [](int s) { return Eigen::Vector3d(0, 0.2 * s, 0); })),
                HasSubstr("moves: in minute"));
}

TEST(StandingLog, refuses_who_goes_round_in_a_small_circle) {
    EXPECT_THAT(
        refusal(noisy(900, [](int s) { return Eigen::Vector3d(20 * std::cos(s / 8.0), 20 * std::sin(s / 8.0), 0); })),
        HasSubstr("of its time it goes more than 10 m in 10 s"));
}

// Of minutes and metres, as errors of real receivers among trees do.
TEST(StandingLog, takes_errors_that_wander) {
    EXPECT_EQ(refusal(noisy(
                  1800, [](int s) { return Eigen::Vector3d(15 * std::sin(s / 100.0), 8 * std::sin(s / 70.0), 0); })),
              "taken");
}

TEST(StandingLog, refuses_a_position_that_is_held) {
    std::vector<FixSample> samples;
    for (int i = 0; i < 900; ++i)
        samples.push_back(fix_at(i, {1, 2, 3}));
    EXPECT_THAT(refusal(series_of(std::move(samples))), HasSubstr("roof.csv: all fixes are at one place"));
}

TEST(StandingLog, refuses_a_log_without_times) {
    FixSeries series = at_rest(900);
    series.interval.reset();
    EXPECT_THAT(refusal(series), HasSubstr("roof.csv: has no times; expected a log that has some, or --interval"));
    EXPECT_THAT(refusal(series_of({})), HasSubstr("is 0 s long, of 0 fixes"));
}

TEST(StandingLog, is_dated_from_its_first_fix) {
    FixSeries counted = at_rest(10);
    for (FixSample& sample : counted.samples)
        sample.time.reset();
    counted.dated = false;
    counted.interval = Seconds(0.5);
    counted.samples[0].has_fix = false;
    const FixSeries dated = dated_from(counted, noon);
    EXPECT_TRUE(dated.dated);
    EXPECT_FALSE(dated.samples[0].time);
    EXPECT_EQ(dated.samples[1].time, noon);
    EXPECT_EQ(dated.samples[9].time, noon + std::chrono::seconds(4));
    // Of a log that tells the time of day alone, its own steps.
    FixSeries timed = at_rest(3);
    timed.dated = false;
    timed.samples[2].time = noon + std::chrono::seconds(7);
    EXPECT_EQ(dated_from(timed, noon + std::chrono::hours(1)).samples[2].time, noon + std::chrono::seconds(3607));
    // One that has dates keeps them.
    EXPECT_EQ(dated_from(at_rest(3), GpsTime{}).samples[2].time, noon + std::chrono::seconds(2));
}

}  // namespace
}  // namespace skyloop
