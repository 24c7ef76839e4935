#include "world/gnss/dop.hpp"

#include <Eigen/Dense>
#include <cmath>

namespace skyloop::inline world {

std::optional<Eigen::Matrix4d> cofactor_matrix(std::span<const SkyDirection> satellites) {
    if (satellites.size() < 4) return std::nullopt;
    Eigen::Matrix4d normal = Eigen::Matrix4d::Zero();
    for (const SkyDirection& s : satellites) {
        const double cos_el = std::cos(s.elevation.rad());
        const Eigen::Vector4d row(cos_el * std::sin(s.azimuth.rad()), cos_el * std::cos(s.azimuth.rad()),
                                  std::sin(s.elevation.rad()), 1);
        normal += row * row.transpose();
    }
    const Eigen::FullPivLU<Eigen::Matrix4d> decomposition(normal);
    if (!decomposition.isInvertible()) return std::nullopt;
    const Eigen::Matrix4d q = decomposition.inverse();
    if (!(q.diagonal().array() > 0).all()) return std::nullopt;
    return q;
}

std::optional<Dop> dilution_of_precision(std::span<const SkyDirection> satellites) {
    const auto cofactors = cofactor_matrix(satellites);
    if (!cofactors) return std::nullopt;
    const Eigen::Matrix4d& q = *cofactors;

    Dop dop;
    dop.gdop = std::sqrt(q.trace());
    dop.pdop = std::sqrt(q(0, 0) + q(1, 1) + q(2, 2));
    dop.hdop = std::sqrt(q(0, 0) + q(1, 1));
    dop.edop = std::sqrt(q(0, 0));
    dop.ndop = std::sqrt(q(1, 1));
    dop.vdop = std::sqrt(q(2, 2));
    dop.tdop = std::sqrt(q(3, 3));
    return dop;
}

}  // namespace skyloop::inline world
