#include "firmware/solution_covariance.hpp"

#include <cmath>

namespace skyloop::firmware {

Eigen::Matrix4d position_covariance(const Fix& fix, const ErrorEllipse& ellipse) {
    const double east = ellipse.east.value(), north = ellipse.north.value();
    const double up = fix.vertical_accuracy.value(), clock = fix.time_accuracy.value();
    const Eigen::Vector4d variances(east * east, north * north, up * up, clock * clock);
    if (fix.correlation) return covariance_of(variances, fix.correlation->position_clock);
    const double major = ellipse.semi_major.value(), minor = ellipse.semi_minor.value();
    Eigen::Matrix4d covariance = variances.asDiagonal();
    covariance(0, 1) = covariance(1, 0) = (major * major - minor * minor) / 2 * std::sin(2 * ellipse.orientation.rad());
    return covariance;
}

Eigen::Matrix3d velocity_covariance(const Fix& fix, const Eigen::Vector3d& variances, double east_north) {
    if (fix.correlation) return covariance_of(variances, fix.correlation->velocity);
    Eigen::Matrix3d covariance = variances.asDiagonal();
    covariance(0, 1) = covariance(1, 0) = east_north;
    return covariance;
}

}  // namespace skyloop::firmware
