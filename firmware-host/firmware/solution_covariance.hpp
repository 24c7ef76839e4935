/// The covariances that a receiver reports: the accuracies that it tells, and how its solution's errors go together.
#pragma once

#include <Eigen/Core>

#include "firmware/error_ellipse.hpp"
#include "world/flow/fix.hpp"

namespace skyloop::firmware {

/// Of the position and the receiver's clock: east, north, up, clock, m². Along north and east the accuracy is split as
/// the ellipse has it; where the solution does not tell what goes together, the ellipse tells it of those two.
Eigen::Matrix4d position_covariance(const Fix& fix, const ErrorEllipse& ellipse);

/// Of the velocity: east, north, up, m²/s².
/// @param variances east, north, up
/// @param east_north covariance of these two where the solution does not tell what goes together
Eigen::Matrix3d velocity_covariance(const Fix& fix, const Eigen::Vector3d& variances, double east_north);

}  // namespace skyloop::firmware
