#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "base/geo/local_frame.hpp"
#include "receiver/error_model/baseline.hpp"
#include "receiver/error_model/simple_models.hpp"
#include "support/model_sky.hpp"

namespace skyloop {
namespace {

using test::ModelRun;

const SkyView simple_sky = test::sky_of(test::ten_spots());

ErrorModelSettings settings_of(ErrorModelKind kind) {
    ErrorModelSettings settings;
    settings.kind = kind;
    return settings;
}

// Standard deviations east, north, up over many epochs of one sky.
Eigen::Vector3d spread_of(ModelRun& run, const SkyView& sky, int epochs) {
    Eigen::Vector3d squares = Eigen::Vector3d::Zero();
    for (int i = 0; i < epochs; ++i) {
        const Trace trace = run.epoch(sky, i);
        const LocalFrame frame(trace.truth.geodetic);
        squares += frame.to_enu(Displacement<Ecef>(test::position_error(trace))).vector().cwiseAbs2();
    }
    return (squares / epochs).cwiseSqrt();
}

TEST(Ideal, IsTheTruthWithItsVelocity) {
    const auto model = make_error_model(settings_of(ErrorModelKind::ideal));
    TruthState truth = test::truth_at(Geodetic::degrees(46.4774, 30.7326, 50), to_gps_time(2111, 0.0));
    truth.velocity = LocalFrame(truth.geodetic).to_ecef(Velocity<Enu>(3, 4, 1));
    const Fix fix = model->fix(truth, simple_sky, free_space(simple_sky));
    EXPECT_EQ(fix.type, FixType::fix_3d);
    EXPECT_EQ(fix.position.latitude, truth.geodetic.latitude);
    EXPECT_EQ(fix.position.longitude, truth.geodetic.longitude);
    EXPECT_EQ(fix.position.height, truth.geodetic.height);
    EXPECT_NEAR(fix.velocity.north, 4, 1e-12);
    EXPECT_NEAR(fix.velocity.east, 3, 1e-12);
    EXPECT_NEAR(fix.velocity.down, -1, 1e-12);
    EXPECT_NEAR(fix.speed.value(), 5, 1e-12);
    EXPECT_NEAR(fix.course.deg(), 36.8698976, 1e-6);
    EXPECT_EQ(fix.horizontal_accuracy, Metres(0));
    EXPECT_EQ(fix.speed_accuracy, MetresPerSecond(0));
    EXPECT_EQ(fix.satellites_used(), 10);
}

TEST(Ideal, KeepsItsCourseAtRest) {
    const auto model = make_error_model(settings_of(ErrorModelKind::ideal));
    const auto course_deg = [&](double since_start, const Velocity<Enu>& velocity) {
        TruthState truth = test::truth_at(Geodetic::degrees(46.4774, 30.7326, 50), to_gps_time(2111, since_start));
        truth.velocity = LocalFrame(truth.geodetic).to_ecef(velocity);
        return model->fix(truth, simple_sky, free_space(simple_sky)).course.deg();
    };
    EXPECT_EQ(course_deg(0, {0, 0, 0}), 0) << "it has never had one";
    EXPECT_NEAR(course_deg(1, {-2, 0, 0}), 270, 1e-9);
    EXPECT_NEAR(course_deg(2, {0, 0, 0}), 270, 1e-9);
    EXPECT_NEAR(course_deg(3, {0, 0, 5}), 270, 1e-9) << "it climbs on the spot";
    EXPECT_NEAR(course_deg(4, {0, -1e-3, 0}), 180, 1e-9);
}

TEST(Ideal, UsesEverythingAboveTheMaskHiddenOrNot) {
    ErrorModelSettings settings = settings_of(ErrorModelKind::ideal);
    settings.sensor.selection.elevation_mask = Angle::degrees(15);
    ModelRun run(settings);
    const Fix fix = run.epoch(simple_sky, 0,
                              [](Arrivals& arrivals) {
                                  for (Arrival& arrival : arrivals.satellites)
                                      arrival.paths = 0;
                              })
                        .epoch.fix;
    EXPECT_EQ(fix.satellites_used(), 8);
    for (const SatelliteStatus& satellite : fix.satellites)
        EXPECT_FALSE(satellite.cn0);
}

TEST(ConstantSigma, SpreadsByItsTwoNumbers) {
    ModelRun run(settings_of(ErrorModelKind::constant_sigma));
    const Eigen::Vector3d spread = spread_of(run, simple_sky, 20000);
    EXPECT_NEAR(spread.x(), 3 / std::sqrt(2.0), 0.04);
    EXPECT_NEAR(spread.y(), 3 / std::sqrt(2.0), 0.04);
    EXPECT_NEAR(spread.z(), 5, 0.1);
    const Fix fix = run.epoch(simple_sky, 30000).epoch.fix;
    EXPECT_EQ(fix.horizontal_accuracy, Metres(3));
    EXPECT_EQ(fix.vertical_accuracy, Metres(5));
}

TEST(SatelliteCount, TakesItsSpreadFromTheTable) {
    const SatelliteCountParameters table;
    EXPECT_EQ(sigma_for_count(table, 4), Metres(12));
    EXPECT_EQ(sigma_for_count(table, 8), Metres(3));
    EXPECT_EQ(sigma_for_count(table, 9), Metres(2.5));
    EXPECT_EQ(sigma_for_count(table, 31), Metres(2.5));

    ModelRun run(settings_of(ErrorModelKind::satellite_count));
    EXPECT_NEAR(spread_of(run, simple_sky, 20000).norm() / std::sqrt(3.0), 2.5, 0.04);
    auto spots = test::ten_spots();
    spots.resize(5);
    EXPECT_NEAR(spread_of(run, test::sky_of(spots), 20000).norm() / std::sqrt(3.0), 8, 0.1);
}

TEST(Refraction, ErrorIsDopTimesTheResidualOfTheExcessPaths) {
    const ErrorModelSettings settings = settings_of(ErrorModelKind::refraction);
    ModelRun run(settings);
    const Trace trace = run.epoch(simple_sky, 0);
    double squares = 0;
    for (const Arrival& arrival : trace.arrivals.satellites) {
        EXPECT_GT(arrival.tropo_delay.value(), 2.2);
        EXPECT_EQ(arrival.iono_delay, Metres(0));
        squares += std::pow(0.05 * arrival.tropo_delay.value(), 2);
    }
    const double sigma = std::sqrt(squares / 10);
    const double expected = trace.epoch.fix.dop.pdop * sigma;
    EXPECT_NEAR(trace.epoch.fix.horizontal_accuracy.value(), expected * std::sqrt(2.0 / 3), 1e-9);
    EXPECT_NEAR(trace.epoch.fix.vertical_accuracy.value(), expected / std::sqrt(3.0), 1e-9);
    EXPECT_NEAR(spread_of(run, simple_sky, 10000).norm(), expected, 0.03 * expected);
}

TEST(WholePath, HasTheDelaysOfTheBaselineAndItsOwnLossAndNoise) {
    ModelRun baseline(settings_of(ErrorModelKind::baseline));
    ModelRun whole(settings_of(ErrorModelKind::whole_path));
    const Trace a = baseline.epoch(simple_sky, 0);
    const Trace b = whole.epoch(simple_sky, 0);
    for (std::size_t i = 0; i < 10; ++i) {
        const Arrival& one = a.arrivals.satellites[i];
        const Arrival& other = b.arrivals.satellites[i];
        EXPECT_EQ(one.iono_delay, other.iono_delay);
        EXPECT_EQ(one.tropo_delay, other.tropo_delay);
        EXPECT_NE(one.gas_loss, other.gas_loss);
        EXPECT_GT(other.gas_loss, Decibels(0.03));
    }
    EXPECT_EQ(a.epoch.fix.horizontal_accuracy, b.epoch.fix.horizontal_accuracy);
    EXPECT_GT((test::position_error(a) - test::position_error(b)).norm(), 0.01);
}

// At rest, where every velocity is an error.
TEST(EveryModel, TellsHowWrongPositionsAndVelocitiesAre) {
    for (const ErrorModelKind kind : error_model_kinds()) {
        if (kind == ErrorModelKind::ideal) continue;
        SCOPED_TRACE(std::string(error_model_name(kind)));
        ModelRun run(settings_of(kind));
        EXPECT_GT(run.epoch(simple_sky, 0).epoch.fix.speed_accuracy.value(), 10) << "nothing is known of the motion";
        double speed = 0, horizontal = 0, vertical = 0;
        constexpr int epochs = 4000;
        for (int i = 1; i <= epochs; ++i) {
            const Trace trace = run.epoch(simple_sky, 0.5 * i);
            const Fix& fix = trace.epoch.fix;
            const VelocityNed& v = fix.velocity;
            const Eigen::Vector3d error =
                LocalFrame(trace.truth.geodetic).to_enu(Displacement<Ecef>(test::position_error(trace))).vector();
            speed += Eigen::Vector3d(v.north, v.east, v.down).squaredNorm() / std::pow(fix.speed_accuracy.value(), 2);
            horizontal += error.head<2>().squaredNorm() / std::pow(fix.horizontal_accuracy.value(), 2);
            vertical += error.z() * error.z() / std::pow(fix.vertical_accuracy.value(), 2);
            EXPECT_LE(fix.course_accuracy.deg(), 180.0001);
        }
        EXPECT_NEAR(std::sqrt(speed / epochs), 1, 0.04);
        EXPECT_NEAR(std::sqrt(horizontal / epochs), 1, 0.04);
        EXPECT_NEAR(std::sqrt(vertical / epochs), 1, 0.04);
    }
}

TEST(EveryModel, ReportsSignalStrengthsAndLosesTheFixWithTheSatellites) {
    for (const ErrorModelKind kind : error_model_kinds()) {
        SCOPED_TRACE(std::string(error_model_name(kind)));
        ModelRun run(settings_of(kind));
        const Fix fix = run.epoch(simple_sky, 0).epoch.fix;
        EXPECT_EQ(fix.type, FixType::fix_3d);
        EXPECT_EQ(fix.satellites_used(), 10);
        for (const SatelliteStatus& satellite : fix.satellites) {
            ASSERT_TRUE(satellite.cn0);
            EXPECT_NEAR(satellite.cn0->value(), 46, 2);
        }
        EXPECT_EQ(run.epoch(test::sky_of({{0, 10}, {90, 20}, {180, 30}}), 1).epoch.fix.type, FixType::none);
    }
}

}  // namespace
}  // namespace skyloop
