/// What a receiver expects its solution to be wrong by.
/// Velocities and covariances as seen from a place on the ground.
#pragma once

#include <Eigen/Core>

#include <cmath>
#include <numbers>

#include "base/geo/local_frame.hpp"
#include "receiver/pvt/integrity.hpp"
#include "receiver/pvt/navigation_parameters.hpp"
#include "receiver/pvt/single_point.hpp"
#include "world/flow/fix.hpp"

namespace skyloop::inline receiver {

/// 0 … 360°.
inline Angle course_of(const VelocityNed& v) {
    double course = std::atan2(v.east, v.north);
    if (course < 0) course += 2 * std::numbers::pi;
    return Angle::radians(course < 2 * std::numbers::pi ? course : 0);
}

/// A covariance of ECEF turned to east, north and up.
inline Eigen::Matrix3d in_enu(const LocalFrame& frame, const Eigen::Matrix3d& covariance) {
    Eigen::Matrix3d rotation;
    for (int axis = 0; axis < 3; ++axis)
        rotation.col(axis) = frame.to_enu(Displacement<Ecef>(Eigen::Vector3d::Unit(axis))).vector();
    return rotation * covariance * rotation.transpose();
}

/// Covariance of a solution.
struct ExpectedError {
    Eigen::Matrix3d position = Eigen::Matrix3d::Zero();        ///< ECEF, m²
    double clock = 0;                                          ///< of the reference clock, m²
    Eigen::Vector3d position_clock = Eigen::Vector3d::Zero();  ///< of the one with the other, ECEF, m²
};

/// The formal covariance, which is that of noise by the weights and independent between satellites, and beside it that
/// of errors which the satellites share: corrections of the ionosphere that are too small everywhere, or on one side of
/// the sky, and too dry a troposphere (MODELS.md 7.2, 7.3 for their kinds). Shared errors do not average out however
/// many satellites there are.
ExpectedError expected_error(const SinglePoint& solution, const AccuracyParameters& parameters);

/// Whether delays are in the pseudoranges that no model of the receiver's own has taken off.
bool leaves_delays(const NavigationParameters& parameters);

/// The same with those delays, which are of one sign, so that all satellites share them. Of the ionosphere 1 σ is what
/// `air` tells, or of it `differential.sbas_left` where a service of corrections has taken most of it before it was
/// measured; the noise of the position is scaled by `differential.sbas_scale` there. Of the troposphere it is what
/// `air` tells.
ExpectedError expected_error_left(SinglePoint solution, const NavigationParameters& parameters,
                                  const SiteCorrections& air);

/// By how much the noise of a solution is larger than its weights expect, as its residuals say, over some seconds: with
/// those of satellites that were excluded, since a place with some of them has more that pass unseen. A
/// receiver with a filter believes itself less than half as much at first, until the filter has averaged: ours, after a
/// u-blox that reported 6.5 m, 2.9 m after 10 s and 1.7 m after 30 s (receivers/besancon_20250425_ublox).
///
/// State: since when there are solutions, and the average.
class NoiseScale {
public:
    explicit NoiseScale(FilterKind filter) : filter_(filter) {}
    /// @param test where it was not passed, the residuals count at once
    double of(const SinglePoint& solution, const ResidualTest& test, GpsTime time);
    /// By the residuals of the last seconds alone, of the satellites that were used.
    [[nodiscard]] double average() const { return average_; }
    void reset() { *this = NoiseScale(filter_); }

private:
    FilterKind filter_;
    std::optional<GpsTime> since_;
    GpsTime last_;
    double average_ = 1, of_all_ = 1;
};

/// The same solution with so much more noise.
SinglePoint with_noise(SinglePoint solution, double scale);

/// How these errors go together at the place of the solution, and those of its velocity, if it has one.
ErrorCorrelation error_correlation(const ExpectedError& expected, const std::optional<SinglePointVelocity>& velocity,
                                   const Geodetic& place);

/// What a receiver tells of its velocity, 1 σ; 20 m/s where the epoch has none.
MetresPerSecond told_speed_accuracy(const std::optional<SinglePointVelocity>& velocity,
                                    const AccuracyParameters& parameters);

/// What it tells of its course, 1 σ: the angle that such an error is of the speed, at most half a turn.
Angle told_course_accuracy(MetresPerSecond speed, MetresPerSecond speed_accuracy);

/// What a receiver tells of its position, 1 σ.
struct ToldAccuracy {
    Metres horizontal, vertical;
};
/// How far a reference station's data are from what they correct.
struct ReferenceSpacing {
    Metres length;
    Seconds age;
};
/// Of a solution against a reference station: its noise, a floor of the ranges' errors and what they grow by with
/// distance, both times the DOP, and what grows with age.
/// @param covariance of the position, east, north, up, m²
ToldAccuracy told_accuracy(const Eigen::Matrix3d& covariance, const Dop& dop, Metres floor,
                           const ReferenceSpacing& reference, const CarrierParameters& parameters);
/// Of solutions by carrier phases the accuracy of a good sky, the more in a poor one.
/// @param covariance of the position, east, north, up, m²
ToldAccuracy told_accuracy(const Eigen::Matrix3d& covariance, const Dop& dop, DifferentialKind kind,
                           const DifferentialParameters& parameters);

}  // namespace skyloop::inline receiver
