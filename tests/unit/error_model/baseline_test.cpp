#include "receiver/error_model/baseline.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "base/geo/local_frame.hpp"
#include "support/flat_geoid.hpp"
#include "support/model_sky.hpp"

namespace skyloop {
namespace {

using test::ModelRun;

const SkyView baseline_sky = test::sky_of(test::ten_spots());

TEST(Baseline, ReportsTimeSatellitesDopAndAccuracies) {
    ModelRun run({});
    const Trace trace = run.epoch(baseline_sky, 120);
    const Fix& fix = trace.epoch.fix;
    const UereScale scale = uere_scale(fix, trace.arrivals, {});
    EXPECT_EQ(fix.time, trace.truth.time);
    EXPECT_EQ(fix.leap_seconds, 18);
    EXPECT_EQ(fix.type, FixType::fix_3d);
    EXPECT_EQ(fix.satellites_used(), 10);
    EXPECT_NEAR(fix.horizontal_accuracy.value(), scale.position_error.value() * std::sqrt(2.0 / 3), 1e-12);
    EXPECT_NEAR(fix.vertical_accuracy.value(), scale.position_error.value() / std::sqrt(3.0), 1e-12);
    EXPECT_EQ(fix.geoid_undulation, Metres(0));
    ASSERT_TRUE(trace.error_scale);
    EXPECT_EQ(trace.error_scale->sigma_uere, scale.sigma_uere);
    EXPECT_EQ(trace.error_scale->position_error, scale.position_error);
    ASSERT_EQ(fix.satellites.size(), baseline_sky.satellites.size());
    for (std::size_t i = 0; i < fix.satellites.size(); ++i) {
        EXPECT_EQ(fix.satellites[i].id, baseline_sky.satellites[i].id);
        EXPECT_EQ(fix.satellites[i].cn0, trace.arrivals.satellites[i].cn0);
    }
}

TEST(Baseline, ReportsTheUndulationOfItsGeoid) {
    const auto geoid = test::flat_geoid(-12.25);
    ASSERT_TRUE(geoid) << geoid.error().message;
    ErrorModelSettings settings;
    settings.sensor.geoid = &*geoid;
    ModelRun run(settings);
    EXPECT_NEAR(run.epoch(baseline_sky, 0).epoch.fix.geoid_undulation.value(), -12.25, 1e-9);
}

TEST(Baseline, LeapSecondsComeFromTheTable) {
    ErrorModelSettings settings;
    settings.sensor.leap_seconds = LeapSeconds::constant(17);
    ModelRun run(settings);
    EXPECT_EQ(run.epoch(baseline_sky, 0).epoch.fix.leap_seconds, 17);
}

// Strict 6.5 … 12 m, calibrated 1.8 … 2.6 m for an open sky and 20 TECU (MODELS.md D-09).
TEST(Baseline, ErrorScaleOfThePresets) {
    EffectSettings effects;
    effects.atmosphere.total_electron_content = Tecu(20);
    ModelRun run({}, effects);
    const Trace trace = run.epoch(baseline_sky, 0);
    const double strict =
        uere_scale(trace.epoch.fix, trace.arrivals, BaselineParameters::strict()).position_error.value();
    EXPECT_GT(strict, 6.5);
    EXPECT_LT(strict, 12);
    const double calibrated =
        uere_scale(trace.epoch.fix, trace.arrivals, BaselineParameters::calibrated()).position_error.value();
    EXPECT_GT(calibrated, 1.8);
    EXPECT_LT(calibrated, 2.6);
}

TEST(Baseline, FewerThanFourSatellitesGiveNoFix) {
    auto spots = test::ten_spots();
    spots.resize(4);
    ModelRun run({});
    EXPECT_EQ(run.epoch(test::sky_of(spots), 0).epoch.fix.type, FixType::fix_3d);
    spots.resize(3);
    const Fix fix = run.epoch(test::sky_of(spots), 1).epoch.fix;
    EXPECT_EQ(fix.type, FixType::none);
    EXPECT_FALSE(fix.has_position());
    EXPECT_EQ(fix.satellites_used(), 0);
    ASSERT_EQ(fix.satellites.size(), 3u);
    EXPECT_TRUE(fix.satellites.front().cn0);
    EXPECT_FALSE(run.epoch(test::sky_of(spots), 1.5).error_scale);
    EXPECT_EQ(run.epoch(test::sky_of({}), 2).epoch.fix.type, FixType::none);
}

TEST(Baseline, NumberOfSatellitesDoesNotShiftTheNoise) {
    ModelRun open({});
    ModelRun interrupted({});
    for (int second = 0; second < 20; ++second) {
        const bool blocked = second >= 5 && second < 12;
        const Trace a = open.epoch(baseline_sky, second);
        const Trace b = interrupted.epoch(blocked ? SkyView{} : baseline_sky, second);
        if (blocked) {
            EXPECT_EQ(b.epoch.fix.type, FixType::none);
            continue;
        }
        EXPECT_EQ(a.epoch.fix.position.latitude, b.epoch.fix.position.latitude) << second;
        const bool first_of_a_run = second == 0 || second == 12;
        EXPECT_EQ(b.epoch.fix.speed, first_of_a_run ? MetresPerSecond(0) : a.epoch.fix.speed) << second;
    }
}

TEST(Baseline, SeedDecidesTheNoise) {
    ErrorModelSettings one, other;
    other.sensor.seed = 2;
    ModelRun a(one), b(one), c(other);
    const Eigen::Vector3d first = test::position_error(a.epoch(baseline_sky, 0));
    EXPECT_EQ(first, test::position_error(b.epoch(baseline_sky, 0)));
    EXPECT_GT((first - test::position_error(c.epoch(baseline_sky, 0))).norm(), 0.1);
}

TEST(Baseline, VelocityAndCourseFollowFromTheReportedPositions) {
    ModelRun run({});
    const Fix before = run.epoch(baseline_sky, 10).epoch.fix;
    const Fix after = run.epoch(baseline_sky, 10.5).epoch.fix;
    const GroundMotion motion = motion_between({before.time, before.position}, {after.time, after.position});
    EXPECT_EQ(after.speed, motion.speed);
    EXPECT_EQ(after.course, motion.course);
    EXPECT_EQ(after.velocity.down, motion.velocity.down);
    EXPECT_GT(after.speed.value(), 0);
}

TEST(Baseline, CovarianceAxesFollowTheGeometryWithTheSameTrace) {
    ErrorModelSettings settings;
    settings.baseline.axes = NoiseAxes::covariance;
    ModelRun run(settings);
    Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
    const int n = 20000;
    Trace trace;
    for (int i = 0; i < n; ++i) {
        trace = run.epoch(baseline_sky, i);
        const LocalFrame frame(trace.truth.geodetic);
        const Eigen::Vector3d error = frame.to_enu(Displacement<Ecef>(test::position_error(trace))).vector();
        sum += error * error.transpose();
    }
    const UereScale scale = uere_scale(trace.epoch.fix, trace.arrivals, settings.baseline);
    const double variance = scale.sigma_uere.value() * scale.sigma_uere.value();
    const auto q = cofactor_matrix(used_directions(trace.epoch.fix.satellites));
    ASSERT_TRUE(q);
    const Eigen::Matrix3d expected = variance * q->topLeftCorner<3, 3>();
    EXPECT_LT((sum / n - expected).norm(), 0.03 * expected.norm());
    EXPECT_NEAR(expected.trace(), std::pow(scale.position_error.value(), 2), 1e-6);
    const Fix& fix = trace.epoch.fix;
    EXPECT_NEAR(fix.horizontal_accuracy.value(), std::sqrt(expected(0, 0) + expected(1, 1)), 1e-9);
    EXPECT_NEAR(fix.vertical_accuracy.value(), std::sqrt(expected(2, 2)), 1e-9);
}

}  // namespace
}  // namespace skyloop
