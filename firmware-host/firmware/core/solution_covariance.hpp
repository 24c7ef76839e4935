/// The covariances that a receiver reports: the accuracies that it tells, and how its solution's errors go together.
/// The horizontal error ellipse that a receiver reports.
#pragma once

#include <Eigen/Core>

#include <optional>
#include <span>

#include "base/core/units.hpp"
#include "world/flow/fix.hpp"

namespace skyloop::firmware {

/// One standard deviation of the horizontal position: its axes, and its parts along north and east.
struct ErrorEllipse {
    Metres semi_major;
    Metres semi_minor;
    Angle orientation;  ///< of the major axis from true north, 0 … 180°
    Metres north;
    Metres east;
};

/// Splits the fix's horizontal accuracy along north and east as its DOPs are, with the correlation that the directions
/// of the used satellites give (unit weights, position and one clock); without four of them, none. Nothing when the fix
/// has no horizontal DOP.
std::optional<ErrorEllipse> error_ellipse(const Fix& fix, std::span<const SatelliteStatus> used);
/// The same with all satellites that the solution uses.
std::optional<ErrorEllipse> error_ellipse(const Fix& fix);

/// Of the position and the receiver's clock: east, north, up, clock, m². Along north and east the accuracy is split as
/// the ellipse has it; where the solution does not tell what goes together, the ellipse tells it of those two.
Eigen::Matrix4d position_covariance(const Fix& fix, const ErrorEllipse& ellipse);

/// Of the velocity: east, north, up, m²/s².
/// @param variances east, north, up
/// @param east_north covariance of these two where the solution does not tell what goes together
Eigen::Matrix3d velocity_covariance(const Fix& fix, const Eigen::Vector3d& variances, double east_north);

}  // namespace skyloop::firmware
