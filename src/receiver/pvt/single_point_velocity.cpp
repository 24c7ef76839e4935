#include <cmath>

#include "detail/normal_equations.hpp"
#include "receiver/pvt/single_point.hpp"
#include "world/gnss/constants.hpp"

namespace skyloop::inline receiver {

std::optional<SinglePointVelocity> solve_velocity(std::span<const DopplerEquation> equations,
                                                  std::optional<Eigen::Vector3d> held_up) {
    // Each equation: drift − g u·v = range rate + c·satellite drift − g u·v_s, with g the factor of light time.
    struct Row {
        Eigen::Vector3d row;
        double right, weight;
    };
    std::vector<Row> rows;
    rows.reserve(equations.size());
    Eigen::Vector3d mean_row = Eigen::Vector3d::Zero();
    double mean_right = 0;
    double weights = 0;
    for (const DopplerEquation& e : equations) {
        const Eigen::Vector3d& r = e.satellite.vector();
        const Eigen::Vector3d velocity = e.satellite_velocity.vector();
        const Eigen::Vector3d turn = earth_rotation_rate * Eigen::Vector3d(r.y(), -r.x(), 0);
        const double g = 1 / (1 + e.line.dot(velocity - turn) / speed_of_light);
        const double w = 1 / (e.deviation.value() * e.deviation.value());
        rows.push_back(
            {-g * e.line, e.range_rate.value() + speed_of_light * e.satellite_drift - g * e.line.dot(velocity), w});
        mean_row += w * rows.back().row;
        mean_right += w * rows.back().right;
        weights += w;
    }
    if (rows.size() < (held_up ? 3U : 4U)) return std::nullopt;
    mean_row /= weights;
    mean_right /= weights;
    NormalEquations n;
    for (const Row& r : rows) {
        n.matrix.noalias() += r.weight * (r.row - mean_row) * (r.row - mean_row).transpose();
        n.right += r.weight * (r.right - mean_right) * (r.row - mean_row);
    }
    if (held_up) n.matrix += n.matrix.trace() * *held_up * held_up->transpose();
    const std::optional<Eigen::Matrix3d> inverse = inverse_of(n.matrix);
    if (!inverse) return std::nullopt;
    const Eigen::Vector3d velocity = *inverse * n.right;
    return SinglePointVelocity{Velocity<Ecef>(velocity), MetresPerSecond(mean_right - mean_row.dot(velocity)),
                               *inverse};
}

}  // namespace skyloop::inline receiver
