/// The three equations that are left of a least-squares problem once its clocks are out.
#pragma once

#include <Eigen/Dense>
#include <optional>

namespace skyloop::inline receiver {

struct NormalEquations {
    Eigen::Matrix3d matrix = Eigen::Matrix3d::Zero();
    Eigen::Vector3d right = Eigen::Vector3d::Zero();
};

/// Nothing for a matrix that is singular as far as rounding lets one see.
inline std::optional<Eigen::Matrix3d> inverse_of(const Eigen::Matrix3d& m) {
    constexpr double singular = 1e-13;  // determinant against the mean eigenvalue cubed
    const double scale = m.trace() / 3;
    if (!(scale > 0)) return std::nullopt;
    const double determinant = m.determinant();
    if (!(determinant > singular * scale * scale * scale)) return std::nullopt;
    return Eigen::Matrix3d(m.inverse());
}

/// The same of the plane across a unit vector, along which nothing is unknown: the inverse has nothing of it either.
inline std::optional<Eigen::Matrix3d> inverse_across(const Eigen::Matrix3d& m, const Eigen::Vector3d& known) {
    const Eigen::Matrix3d along = known * known.transpose();
    const Eigen::Matrix3d across = Eigen::Matrix3d::Identity() - along;
    const Eigen::Matrix3d flat = across * m * across;
    const double filling = flat.trace() / 2;
    const std::optional<Eigen::Matrix3d> inverse = inverse_of(flat + filling * along);
    if (!inverse) return std::nullopt;
    return Eigen::Matrix3d(*inverse - along / filling);
}

}  // namespace skyloop::inline receiver
