/// The Earth's rotation while a signal travels.
#pragma once

#include <Eigen/Core>

#include "world/gnss/constants.hpp"

namespace skyloop {

/// Rz(ω_e τ): a vector in the ECEF frame of τ seconds ago as today's frame has it (MODELS.md 3.4). The series are exact
/// to double precision for |τ| < 1 s.
inline Eigen::Vector3d turned_by(const Eigen::Vector3d& v, double travel_time_s) {
    const double angle = earth_rotation_rate * travel_time_s;
    const double s = angle * (1 - angle * angle / 6);
    const double c = 1 - angle * angle / 2;
    return {v.x() * c + v.y() * s, -v.x() * s + v.y() * c, v.z()};
}

}  // namespace skyloop
