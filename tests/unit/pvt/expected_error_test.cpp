#include "receiver/pvt/expected_error.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>

#include "synthetic_sky.hpp"

namespace skyloop {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

// One epoch of a perfect receiver, solved with corrections that its ranges never needed.
class CorrectedEpoch {
public:
    CorrectedEpoch() : sky_(test::synthetic_sky(test::sample_time, test::four_systems)) {
        const Geodetic place = Geodetic::degrees(48, 11, 500);
        const Observations observations = test::measure(sky_, test::receiver_at(place, test::sample_time));
        BroadcastTransmitters transmitters(sky_);
        for (const Observation& o : observations.signals) {
            const auto t = transmitters.at(o.satellite, o.signal, observations.receive_time, *o.pseudorange);
            if (t) equations.push_back({o.satellite, *t, *o.pseudorange, o.carrier, Metres(0.5), false});
        }
        setup_.time = test::sample_time;
        setup_.start = to_ecef(place);
        setup_.elevation_mask = Angle::degrees(10);
        setup_.corrections = &corrections_;
    }
    [[nodiscard]] SinglePoint solved() const { return solve_single_point(equations, setup_).value(); }
    [[nodiscard]] SinglePoint timed() const { return solve_clocks(equations, setup_).value(); }
    void leave_uncorrected() { setup_.corrections = nullptr; }

    std::vector<RangeEquation> equations;

private:
    test::SyntheticSky sky_;
    RangeCorrections corrections_{{.default_ionosphere = true}, {}};
    SinglePointSetup setup_;
};

constexpr AccuracyParameters nothing_shared{.ionosphere_share = 0, .ionosphere_tilt = 0, .troposphere_share = 0};

AccuracyParameters sharing(double AccuracyParameters::*which, double share) {
    AccuracyParameters parameters = nothing_shared;
    parameters.*which = share;
    return parameters;
}

Vector3d moved(const SinglePoint& from, const SinglePoint& to) { return to.position.vector() - from.position.vector(); }

TEST(ExpectedError, GainsAreWhatALongerPseudorangeDoes) {
    const CorrectedEpoch epoch;
    const SinglePoint before = epoch.solved();
    ASSERT_GT(before.used, 15);
    for (std::size_t i = 0; i < epoch.equations.size(); ++i) {
        CorrectedEpoch longer;
        longer.equations[i].pseudorange += Metres(1);
        const SinglePoint after = longer.solved();
        EXPECT_LT((moved(before, after) - before.ranges[i].position_gain).norm(), 2e-3) << i;
        EXPECT_NEAR((after.clock() - before.clock()).value(), before.ranges[i].clock_gain, 2e-3) << i;
    }
}

TEST(ExpectedError, HoldsWhatAWrongIonosphereDoesToPositionAndClock) {
    const SinglePoint before = CorrectedEpoch().solved();
    CorrectedEpoch thicker;
    double most = 0;
    for (std::size_t i = 0; i < thicker.equations.size(); ++i) {
        thicker.equations[i].pseudorange += 0.25 * before.ranges[i].ionosphere;
        most = std::max(most, before.ranges[i].ionosphere.value());
    }
    EXPECT_GT(most, 2) << "there is one to be wrong about";
    const SinglePoint after = thicker.solved();
    const ExpectedError expected = expected_error(before, sharing(&AccuracyParameters::ionosphere_share, 0.25));
    const Vector3d d = moved(before, after);
    EXPECT_GT(d.norm(), 0.3);
    const Matrix3d shared = expected.position - before.covariance;
    EXPECT_LT((shared - d * d.transpose()).norm(), 0.02 * d.squaredNorm());
    const double clock = (after.clock() - before.clock()).value();
    EXPECT_NEAR(std::sqrt(expected.clock - before.clock_variance), std::abs(clock), 0.01);
    EXPECT_LT((expected.position_clock - before.position_clock - clock * d).norm(), 0.05 * std::abs(clock) * d.norm());
}

TEST(ExpectedError, HoldsWhatNoiseDoesToPositionAndClockTogether) {
    const SinglePoint point = CorrectedEpoch().solved();
    Vector3d together = Vector3d::Zero();
    for (const RangeOutcome& r : point.ranges)
        together += r.variance * r.clock_gain * r.position_gain;
    EXPECT_GT(together.norm(), 0.01);
    EXPECT_LT((point.position_clock - together).norm(), 1e-9);
}

// Satellites are above: a height that is wrong one way makes every range longer, as a clock does.
TEST(ExpectedError, HeightAndClockGoTogether) {
    const SinglePoint point = CorrectedEpoch().solved();
    const SinglePointVelocity velocity{{}, {}, Vector3d(1, 4, 9).asDiagonal()};
    const ErrorCorrelation correlation =
        error_correlation(expected_error(point, AccuracyParameters()), velocity, to_geodetic(point.position));
    const Eigen::Matrix4d& position = correlation.position_clock;
    EXPECT_EQ(position.diagonal(), Eigen::Vector4d::Ones());
    EXPECT_EQ(position, position.transpose().eval());
    EXPECT_GT(position(2, 3), 0.7);
    EXPECT_GT(Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d>(position).eigenvalues().minCoeff(), 0);
    EXPECT_EQ(correlation.velocity.diagonal(), Vector3d::Ones());
    EXPECT_GT(Eigen::SelfAdjointEigenSolver<Matrix3d>(correlation.velocity).eigenvalues().minCoeff(), 0);
    EXPECT_EQ(error_correlation({}, std::nullopt, to_geodetic(point.position)).velocity, Matrix3d::Identity());
}

// What corrections have made smaller keeps its sign, and the whole stays a covariance.
TEST(ExpectedError, OfAnAugmentationIsACovariance) {
    const SinglePoint point = CorrectedEpoch().solved();
    NavigationParameters parameters;
    parameters.accuracy = nothing_shared;
    parameters.differential.kind = DifferentialKind::sbas;
    parameters.differential.sbas_left = 0;
    const RangeCorrections air({.default_ionosphere = true}, {});
    const ExpectedError expected =
        expected_error_left(point, parameters, air.at(to_geodetic(point.position), test::sample_time));
    Eigen::Matrix4d all;
    all << expected.position, expected.position_clock, expected.position_clock.transpose(), expected.clock;
    EXPECT_GT(Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d>(all).eigenvalues().minCoeff(), 0);
    EXPECT_LT((expected.position_clock - 0.5 * point.position_clock).norm(), 1e-9);
}

TEST(ExpectedError, ATiltMovesThePositionSideways) {
    const SinglePoint before = CorrectedEpoch().solved();
    const ExpectedError expected = expected_error(before, sharing(&AccuracyParameters::ionosphere_tilt, 0.1));
    const LocalFrame frame(to_geodetic(before.position));
    const auto along = [&](const Matrix3d& q, const Displacement<Enu>& axis) {
        const Vector3d u = frame.to_ecef(axis).vector();
        return u.dot(q * u);
    };
    const Matrix3d tilt = expected.position - before.covariance;
    EXPECT_GT(along(tilt, {1, 0, 0}), 0.01);
    EXPECT_GT(along(tilt, {0, 1, 0}), 0.01);
    EXPECT_LT(along(tilt, {0, 0, 1}), along(tilt, {1, 0, 0}) + along(tilt, {0, 1, 0}));
}

TEST(ExpectedError, ATroposphereIsMostlyAHeight) {
    const SinglePoint before = CorrectedEpoch().solved();
    const ExpectedError expected = expected_error(before, sharing(&AccuracyParameters::troposphere_share, 0.02));
    const Matrix3d shared = expected.position - before.covariance;
    const Vector3d up = LocalFrame(to_geodetic(before.position)).to_ecef(Displacement<Enu>(0, 0, 1)).vector();
    EXPECT_GT(up.dot(shared * up), 0.9 * shared.trace());
    EXPECT_GT(shared.trace(), 0.05 * 0.05);
}

TEST(ExpectedError, WithoutCorrectionsNoneIsWrong) {
    CorrectedEpoch epoch;
    epoch.leave_uncorrected();
    const SinglePoint point = epoch.solved();
    const ExpectedError expected = expected_error(point, AccuracyParameters());
    EXPECT_EQ(expected.position, point.covariance);
    EXPECT_EQ(expected.clock, point.clock_variance);
}

// What an augmentation leaves is of one sign, and of the size that the receiver's own model of the air makes of it.
TEST(ExpectedError, HoldsWhatAnAugmentationLeaves) {
    CorrectedEpoch epoch;
    const RangeCorrections air({.troposphere = TroposphereCorrection::none, .default_ionosphere = true}, {});
    epoch.leave_uncorrected();
    const SinglePoint before = epoch.solved();
    const SiteCorrections site = air.at(to_geodetic(before.position), test::sample_time);
    for (std::size_t i = 0; i < epoch.equations.size(); ++i)
        epoch.equations[i].pseudorange +=
            0.1 * site.ionosphere(Constellation::gps, before.ranges[i].direction, epoch.equations[i].carrier);
    const SinglePoint after = epoch.solved();
    NavigationParameters parameters;
    parameters.accuracy = nothing_shared;
    parameters.differential.kind = DifferentialKind::sbas;
    EXPECT_TRUE(leaves_delays(parameters));
    const ExpectedError expected = expected_error_left(before, parameters, site);
    const Vector3d d = moved(before, after);
    EXPECT_GT(d.norm(), 0.1);
    EXPECT_LT((expected.position - 0.25 * before.covariance - d * d.transpose()).norm(), 0.02 * d.squaredNorm());
    EXPECT_NEAR(std::sqrt(expected.clock - before.clock_variance), std::abs((after.clock() - before.clock()).value()),
                0.01);
}

// A receiver that is told to correct nothing expects the delays as its models tell them.
TEST(ExpectedError, HoldsTheWholeOfWhatIsNotCorrected) {
    CorrectedEpoch epoch;
    const RangeCorrections air({.default_ionosphere = true}, {});
    epoch.leave_uncorrected();
    const SinglePoint before = epoch.solved();
    const SiteCorrections site = air.at(to_geodetic(before.position), test::sample_time);
    const auto moved_by = [&](const auto& delay_of) {
        CorrectedEpoch delayed;
        delayed.leave_uncorrected();
        for (std::size_t i = 0; i < delayed.equations.size(); ++i)
            delayed.equations[i].pseudorange += delay_of(before.ranges[i], delayed.equations[i].carrier);
        return moved(before, delayed.solved());
    };
    NavigationParameters parameters;
    EXPECT_FALSE(leaves_delays(parameters));
    const auto shared = [&](bool ionosphere, bool troposphere) {
        parameters.accuracy = nothing_shared;
        parameters.accuracy.whole_ionosphere = ionosphere;
        parameters.accuracy.whole_troposphere = troposphere;
        EXPECT_TRUE(leaves_delays(parameters));
        return Matrix3d(expected_error_left(before, parameters, site).position - before.covariance);
    };
    const Vector3d by_ionosphere = moved_by([&](const RangeOutcome& r, Hertz carrier) {
        return site.ionosphere(Constellation::gps, r.direction, carrier);
    });
    const Vector3d by_troposphere =
        moved_by([&](const RangeOutcome& r, Hertz) { return site.troposphere(r.direction.elevation); });
    EXPECT_GT(by_ionosphere.norm(), 1);
    EXPECT_GT(by_troposphere.norm(), 3);
    EXPECT_LT((shared(true, false) - by_ionosphere * by_ionosphere.transpose()).norm(),
              0.02 * by_ionosphere.squaredNorm());
    EXPECT_LT((shared(false, true) - by_troposphere * by_troposphere.transpose()).norm(),
              0.02 * by_troposphere.squaredNorm());
}

TEST(ExpectedError, ACombinationWithoutIonosphereIsNotDelayedByIt) {
    CorrectedEpoch epoch;
    const RangeCorrections air({.default_ionosphere = true}, {});
    epoch.leave_uncorrected();
    for (RangeEquation& e : epoch.equations)
        e.carrier = Hertz(0);
    const SinglePoint point = epoch.solved();
    NavigationParameters parameters;
    parameters.accuracy = nothing_shared;
    parameters.accuracy.whole_ionosphere = true;
    const SiteCorrections site = air.at(to_geodetic(point.position), test::sample_time);
    EXPECT_EQ(expected_error_left(point, parameters, site).position, point.covariance);
}

TEST(ToldAccuracy, GrowsWithThePoorGeometryOfCarrierPhases) {
    const DifferentialParameters parameters;
    Dop good, poor;
    good.hdop = 0.7, good.vdop = 1.1;
    poor.hdop = 2, poor.vdop = 3.5;
    const Matrix3d covariance = Matrix3d::Identity();
    const auto told = [&](const Dop& dop, DifferentialKind kind) {
        return told_accuracy(covariance, dop, kind, parameters);
    };
    EXPECT_EQ(told(good, DifferentialKind::rtk_fixed).horizontal, Metres(0.014));
    EXPECT_NEAR(told(good, DifferentialKind::rtk_fixed).vertical.value(), 0.021, 1e-12);
    EXPECT_NEAR(told(poor, DifferentialKind::rtk_fixed).horizontal.value(), 0.028, 1e-12);
    EXPECT_NEAR(told(poor, DifferentialKind::rtk_fixed).vertical.value(), 0.049, 1e-12);
    EXPECT_NEAR(told(poor, DifferentialKind::rtk_float).horizontal.value(), 0.6, 1e-12);
    EXPECT_NEAR(told(poor, DifferentialKind::none).horizontal.value(), std::sqrt(2.0), 1e-12);
}

// Errors of ranges reach the place by the DOP, at a distance from the reference as at none.
TEST(ToldAccuracy, GrowsWithTheDopAndTheDistance) {
    const CarrierParameters parameters;
    Dop good, poor;
    good.hdop = 0.5, good.vdop = 0.9;
    poor.hdop = 2, poor.vdop = 3.6;
    const auto told = [&](const Dop& dop, double km) {
        const ReferenceSpacing spacing{Metres(1000 * km), Seconds(0)};
        return told_accuracy(Matrix3d::Zero(), dop, parameters.told_floor, spacing, parameters);
    };
    for (const double km : {0.0, 10.0, 100.0}) {
        EXPECT_NEAR(told(poor, km).horizontal.value(), 4 * told(good, km).horizontal.value(), 1e-12);
        EXPECT_NEAR(told(poor, km).vertical.value(), 4 * told(good, km).vertical.value(), 1e-12);
    }
    EXPECT_NEAR(
        told(good, 100).horizontal.value() / told(good, 0).horizontal.value(),
        std::hypot(1e5 * parameters.told_per_length, parameters.told_floor.value()) / parameters.told_floor.value(),
        1e-9);
}

TEST(ExpectedError, OfTimeAloneIsInTheClock) {
    const SinglePoint point = CorrectedEpoch().timed();
    const ExpectedError expected = expected_error(point, AccuracyParameters());
    EXPECT_EQ(expected.position, Matrix3d::Zero());
    EXPECT_GT(std::sqrt(expected.clock), 0.5);
    EXPECT_GT(expected.clock, 2 * point.clock_variance);
}

}  // namespace
}  // namespace skyloop
