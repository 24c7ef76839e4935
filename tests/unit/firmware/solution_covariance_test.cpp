#include "firmware/core/solution_covariance.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>

#include "base/geo/local_frame.hpp"
#include "firmware/core/state_tracker.hpp"
#include "firmware/output_only/other_protocols.hpp"
#include "firmware/septentrio/sbf_messages.hpp"
#include "firmware/ublox/config/config_keys.hpp"
#include "firmware/ublox/config/legacy_keys.hpp"
#include "receiver/protocol/ubx_nav.hpp"
#include "sample_correlation.hpp"
#include "ubx_reports.hpp"

namespace skyloop::firmware {
namespace {

UbxReport correlated_report() {
    UbxReport report(9);
    report.state.epoch.fix.time_accuracy = Metres(6);
    report.state.epoch.fix.correlation = sample_correlation();
    return report;
}

template <class Matrix>
double smallest_eigenvalue(const Matrix& matrix) {
    return Eigen::SelfAdjointEigenSolver<Matrix>(matrix).eigenvalues().minCoeff();
}

TEST(SolutionCovariance, IsTheAccuraciesAndHowTheErrorsGoTogether) {
    const Fix fix = correlated_report().state.epoch.fix;
    const ErrorEllipse ellipse = error_ellipse(fix, {}).value();
    const Eigen::Matrix4d position = position_covariance(fix, ellipse);
    EXPECT_EQ(position(0, 0), ellipse.east.value() * ellipse.east.value());
    EXPECT_EQ(position(1, 1), ellipse.north.value() * ellipse.north.value());
    EXPECT_EQ(position(2, 2), 5.04 * 5.04);
    EXPECT_EQ(position(3, 3), 36);
    EXPECT_NEAR(position(2, 3), 0.9 * 5.04 * 6, 1e-9);
    EXPECT_NEAR(position(0, 2), -0.4 * 5.04 * ellipse.east.value(), 1e-9);
    EXPECT_EQ(position, position.transpose().eval());
    EXPECT_GT(smallest_eigenvalue(position), 0);
    const Eigen::Matrix3d velocity = velocity_covariance(fix, {0.04, 0.01, 0.16}, 0.001);
    EXPECT_EQ(velocity.diagonal(), Eigen::Vector3d(0.04, 0.01, 0.16));
    EXPECT_NEAR(velocity(0, 2), -0.3 * 0.2 * 0.4, 1e-12);
    EXPECT_GT(smallest_eigenvalue(velocity), 0);
}

TEST(SolutionCovariance, IsTheEllipseAloneWhereTheSolutionTellsNoMore) {
    const Fix fix = UbxReport(9).state.epoch.fix;
    const ErrorEllipse ellipse = error_ellipse(fix, fix.satellites).value();
    const Eigen::Matrix4d position = position_covariance(fix, ellipse);
    EXPECT_NE(position(0, 1), 0);
    for (const Eigen::Index level : {0, 1, 3})
        EXPECT_EQ(position(level, 2), 0);
    EXPECT_EQ(velocity_covariance(fix, {0.04, 0.01, 0.16}, 0.001)(1, 0), 0.001);
}

TEST(SolutionCovariance, OfUbxCountsDown) {
    UbxReport report = correlated_report();
    const auto m = report.report<NavCov>();
    EXPECT_NEAR(m.pos_cov[1], 0.2 * std::sqrt(m.pos_cov[0] * m.pos_cov[3]), 1e-5);
    EXPECT_NEAR(m.pos_cov[2], -0.1 * std::sqrt(m.pos_cov[0] * m.pos_cov[5]), 1e-5);
    EXPECT_NEAR(m.pos_cov[4], 0.4 * std::sqrt(m.pos_cov[3] * m.pos_cov[5]), 1e-5);
    EXPECT_NEAR(m.vel_cov[1], 0.2 * std::sqrt(m.vel_cov[0] * m.vel_cov[3]), 1e-6);
    EXPECT_NEAR(m.vel_cov[2], -0.1 * std::sqrt(m.vel_cov[0] * m.vel_cov[5]), 1e-6);
    EXPECT_NEAR(m.vel_cov[4], 0.3 * std::sqrt(m.vel_cov[3] * m.vel_cov[5]), 1e-6);
    report.state.epoch.fix.correlation.reset();
    const auto parted = report.report<NavCov>();
    for (const std::size_t variance : {0u, 3u, 5u}) {
        EXPECT_EQ(parted.pos_cov[variance], m.pos_cov[variance]);
        EXPECT_EQ(parted.vel_cov[variance], m.vel_cov[variance]);
    }
    for (const std::size_t with_down : {2u, 4u})
        EXPECT_TRUE(parted.pos_cov[with_down] == 0 && !std::signbit(parted.pos_cov[with_down]));
}

TEST(SolutionCovariance, OfSbfHasTheClock) {
    NavigationState state = correlated_report().state;
    const SbfCovariance position = sbf_position_covariance(state).covariance;
    EXPECT_NEAR(position[9], 0.9 * 5.04 * 6, 1e-4);
    EXPECT_NEAR(position[6], 0.05 * 6 * std::sqrt(position[0]), 1e-4);
    EXPECT_NEAR(position[8], -0.3 * 6 * std::sqrt(position[1]), 1e-4);
    EXPECT_NEAR(position[5], 0.1 * 5.04 * std::sqrt(position[0]), 1e-4);
    EXPECT_NEAR(position[7], -0.4 * 5.04 * std::sqrt(position[1]), 1e-4);
    const SbfCovariance velocity = sbf_velocity_covariance(state).covariance;
    EXPECT_NEAR(velocity[4], 0.2 * std::sqrt(velocity[0] * velocity[1]), 1e-6);
    EXPECT_NEAR(velocity[7], -0.3 * std::sqrt(velocity[1] * velocity[2]), 1e-6);
    for (const std::size_t drift : {3u, 6u, 8u, 9u})
        EXPECT_EQ(velocity[drift], static_cast<float>(sbf_nothing));
    state.epoch.fix.type = FixType::fix_2d;
    const SbfCovariance flat = sbf_position_covariance(state).covariance;
    EXPECT_EQ(flat[9], static_cast<float>(sbf_nothing));
    EXPECT_EQ(flat[6], position[6]);
}

// What goes with the clock turns as a vector does.
TEST(SolutionCovariance, OfSbfTurnsWithTheAxes) {
    const NavigationState state = correlated_report().state;
    const SbfCovariance local = sbf_position_covariance(state).covariance;
    const SbfCovariance turned = sbf_position_covariance_cartesian(state).covariance;
    const Eigen::Vector3d up = LocalFrame(state.epoch.fix.position).to_ecef(Displacement<Enu>(0, 0, 1)).vector();
    const Eigen::Vector3d with_clock(turned[6], turned[8], turned[9]);
    EXPECT_NEAR(up.dot(with_clock), local[9], 1e-4);
    EXPECT_NEAR(with_clock.norm(), Eigen::Vector3d(local[6], local[8], local[9]).norm(), 1e-4);
    EXPECT_EQ(turned[3], local[3]);
}

// A receiver that has had solutions whose errors go together, one a second.
class CorrelatedSolutions {
public:
    CorrelatedSolutions() {
        fix.speed_accuracy = MetresPerSecond(0.25);
        fix.correlation = sample_correlation();
        add_satellites(fix, Constellation::gps, 1, 8);
        tracker_.start(fix.time, {}, true);
    }
    const Fix& step() {
        fix.time += std::chrono::seconds(1);
        return tracker_.update(Epoch{fix}, receiver_config(store, board), {}).epoch.fix;
    }

    BoardProfile board = sample_ublox();
    ConfigStore store{factory_config(board)};
    Fix fix = sample_fix("2024-03-05T12:00:00Z", 47, 8, 500);

private:
    StateTracker tracker_{board};
};

TEST(ErrorCorrelation, StaysWhileTheAccuraciesGrow) {
    CorrelatedSolutions run;
    const Metres before = run.step().vertical_accuracy;
    run.fix.type = FixType::none;
    run.fix.correlation.reset();
    const Fix& lost = run.step();
    EXPECT_GT(lost.vertical_accuracy, before);
    EXPECT_EQ(lost.correlation.value().position_clock, sample_correlation().position_clock);
}

TEST(ErrorCorrelation, IsNoneOfAHeightThatIsTold) {
    CorrelatedSolutions run;
    run.store.set(in_ram, key::navspg_fixmode, 1);
    const ErrorCorrelation told = run.step().correlation.value();
    EXPECT_EQ(told.position_clock.row(2), Eigen::RowVector4d(0, 0, 1, 0));
    EXPECT_EQ(told.position_clock.col(2), Eigen::Vector4d(0, 0, 1, 0));
    EXPECT_EQ(told.position_clock(0, 3), -0.3);
    EXPECT_EQ(told.velocity(0, 2), 0);
}

TEST(ErrorCorrelation, IsNoneOfAPlaceThatIsTold) {
    CorrelatedSolutions run;
    EXPECT_TRUE(run.step().correlation);
    run.store.set(in_ram, legacy_key::tmode_pos_type, 1);
    run.store.set(in_ram, key::tmode_mode, 2);
    EXPECT_EQ(run.step().type, FixType::time_only);
    EXPECT_FALSE(run.step().correlation);
}

TEST(ErrorCorrelation, OfWhatIsCertainIsNone) {
    Eigen::Matrix3d covariance = Eigen::Vector3d(4, 9, 0).asDiagonal();
    covariance(0, 1) = covariance(1, 0) = 3;
    const Eigen::Matrix3d correlation = correlation_of(covariance);
    EXPECT_NEAR(correlation(0, 1), 0.5, 1e-15);
    EXPECT_EQ(correlation(2, 0), 0);
    EXPECT_EQ(correlation.diagonal(), Eigen::Vector3d::Ones());
}

}  // namespace
}  // namespace skyloop::firmware
