/// How the errors of a solution go together.
#pragma once

#include <Eigen/Core>
#include <cmath>

namespace skyloop {

/// Correlations of a solution's errors, beside how large they are: −1 … 1, and 1 of each with itself. They stay what
/// they are while accuracies grow or are scaled.
struct ErrorCorrelation {
    Eigen::Matrix4d position_clock = Eigen::Matrix4d::Identity();  ///< east, north, up, receiver clock
    Eigen::Matrix3d velocity = Eigen::Matrix3d::Identity();        ///< east, north, up

    /// For a height that is told from elsewhere, and a receiver that does not move along it.
    void part_height() {
        constexpr Eigen::Index up = 2;
        const auto part = [](auto& correlation) {
            correlation.row(up).setZero();
            correlation.col(up).setZero();
            correlation(up, up) = 1;
        };
        part(position_clock);
        part(velocity);
    }
};

/// The correlations in a covariance. What has no variance goes with nothing.
template <int Size>
Eigen::Matrix<double, Size, Size> correlation_of(const Eigen::Matrix<double, Size, Size>& covariance) {
    Eigen::Matrix<double, Size, Size> correlation = Eigen::Matrix<double, Size, Size>::Identity();
    for (Eigen::Index row = 0; row < Size; ++row)
        for (Eigen::Index column = 0; column < row; ++column) {
            const double deviations = std::sqrt(covariance(row, row) * covariance(column, column));
            if (deviations > 0)
                correlation(row, column) = correlation(column, row) = covariance(row, column) / deviations;
        }
    return correlation;
}

/// The covariance of errors so large that go together so; its diagonal is `variances`.
template <int Size>
Eigen::Matrix<double, Size, Size> covariance_of(const Eigen::Matrix<double, Size, 1>& variances,
                                                const Eigen::Matrix<double, Size, Size>& correlation) {
    const Eigen::Matrix<double, Size, 1> deviations = variances.cwiseSqrt();
    Eigen::Matrix<double, Size, Size> covariance = correlation.cwiseProduct(deviations * deviations.transpose());
    covariance.diagonal() = variances;
    return covariance;
}

}  // namespace skyloop
