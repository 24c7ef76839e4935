/// What a receiver expects its solution to be wrong by.
#pragma once

#include <Eigen/Core>

#include "skyloop/pvt/navigation_parameters.hpp"
#include "skyloop/pvt/single_point.hpp"

namespace skyloop {

/// Variances of a solution.
struct ExpectedError {
    Eigen::Matrix3d position = Eigen::Matrix3d::Zero();  ///< ECEF, m²
    double clock = 0;                                    ///< of the reference clock, m²
};

/// The formal covariance, which is that of noise by the weights and independent between satellites, and beside it that
/// of errors which the satellites share: corrections of the ionosphere that are too small everywhere, or on one side of
/// the sky, and too dry a troposphere (MODELS.md 7.2, 7.3 for their kinds). Shared errors do not average out however
/// many satellites there are.
ExpectedError expected_error(const SinglePoint& solution, const AccuracyParameters& parameters);

/// The same where a service of corrections has taken most of the ionosphere before it was measured: what it leaves is
/// of one sign, so that all satellites share it, and 1 σ of it is `differential.sbas_left` of what `air` tells. The
/// noise of the position is scaled by `differential.sbas_scale`.
ExpectedError expected_error_left(SinglePoint solution, const NavigationParameters& parameters,
                                  const SiteCorrections& air);

/// What a receiver tells of its velocity, 1 σ; 20 m/s where the epoch has none.
MetresPerSecond told_speed_accuracy(const std::optional<SinglePointVelocity>& velocity,
                                    const AccuracyParameters& parameters);

/// What a receiver tells of its position, 1 σ.
struct ToldAccuracy {
    Metres horizontal, vertical;
};
/// Of solutions by carrier phases the accuracy of a good sky, the more in a poor one.
/// @param covariance of the position, east, north, up, m²
ToldAccuracy told_accuracy(const Eigen::Matrix3d& covariance, const Dop& dop, DifferentialKind kind,
                           const DifferentialParameters& parameters);

}  // namespace skyloop
