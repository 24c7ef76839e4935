#include "firmware/core/solution_covariance.hpp"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <vector>

namespace skyloop::firmware {
namespace {

// Correlation of the east and north errors: q_en / √(q_ee q_nn) of Q = (HᵀH)⁻¹.
double horizontal_correlation(std::span<const SatelliteStatus> used) {
    if (used.size() < 4) return 0;
    Eigen::Matrix4d normal = Eigen::Matrix4d::Zero();
    for (const SatelliteStatus& s : used) {
        const double az = s.azimuth.rad(), el = s.elevation.rad();
        const Eigen::Vector4d row(std::cos(el) * std::sin(az), std::cos(el) * std::cos(az), std::sin(el), 1.0);
        normal += row * row.transpose();
    }
    const Eigen::FullPivLU<Eigen::Matrix4d> decomposed(normal);
    if (!decomposed.isInvertible()) return 0;
    const Eigen::Matrix4d cofactors = decomposed.inverse();
    const double correlation = cofactors(0, 1) / std::sqrt(cofactors(0, 0) * cofactors(1, 1));
    return std::isfinite(correlation) ? std::clamp(correlation, -1.0, 1.0) : 0;
}

}  // namespace

std::optional<ErrorEllipse> error_ellipse(const Fix& fix, std::span<const SatelliteStatus> used) {
    const double hdop = std::hypot(fix.dop.edop, fix.dop.ndop);
    if (!(hdop > 0) || !std::isfinite(hdop)) return std::nullopt;
    const double north = fix.horizontal_accuracy.value() * fix.dop.ndop / hdop;
    const double east = fix.horizontal_accuracy.value() * fix.dop.edop / hdop;
    const double covariance = horizontal_correlation(used) * north * east;
    // Eigenvalues and direction of the 2 × 2 covariance matrix.
    const double mean = (north * north + east * east) / 2;
    const double half_difference = (north * north - east * east) / 2;
    const double spread = std::hypot(half_difference, covariance);
    double orientation = std::atan2(covariance, half_difference) / 2;
    if (orientation < 0) orientation += std::numbers::pi;
    return ErrorEllipse{Metres(std::sqrt(mean + spread)), Metres(std::sqrt(std::max(0.0, mean - spread))),
                        Angle::radians(orientation), Metres(north), Metres(east)};
}

std::optional<ErrorEllipse> error_ellipse(const Fix& fix) {
    std::vector<SatelliteStatus> used;
    std::ranges::copy_if(fix.satellites, std::back_inserter(used), &SatelliteStatus::used);
    return error_ellipse(fix, used);
}

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
