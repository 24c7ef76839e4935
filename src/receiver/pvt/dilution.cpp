#include <Eigen/Dense>
#include <array>
#include <cmath>
#include <limits>

#include "base/geo/local_frame.hpp"
#include "detail/dilution.hpp"
#include "detail/normal_equations.hpp"
#include "receiver/pvt/expected_error.hpp"

namespace skyloop::inline receiver {

std::optional<Dop> dilution_of(std::span<const RangeEquation> equations, const SinglePoint& solution) {
    using Eigen::Matrix3d, Eigen::Vector3d;
    std::array<Vector3d, clock_count> rows;
    std::array<int, clock_count> counts{};
    rows.fill(Vector3d::Zero());
    for (std::size_t i = 0; i < equations.size(); ++i) {
        if (!solution.ranges[i].used) continue;
        const std::size_t clock = clock_of(equations[i].satellite.constellation);
        rows[clock] -= solution.ranges[i].line;
        ++counts[clock];
    }
    Matrix3d normal = Matrix3d::Zero();
    for (std::size_t c = 0; c < clock_count; ++c)
        if (counts[c] > 0) rows[c] /= counts[c];
    for (std::size_t i = 0; i < equations.size(); ++i) {
        if (!solution.ranges[i].used) continue;
        const Vector3d row = -solution.ranges[i].line - rows[clock_of(equations[i].satellite.constellation)];
        normal.noalias() += row * row.transpose();
    }
    const LocalFrame frame(to_geodetic(solution.position));
    const Vector3d up = frame.to_ecef(Displacement<Enu>(0, 0, 1)).vector();
    const std::optional<Matrix3d> inverse = solution.height_held ? inverse_across(normal, up) : inverse_of(normal);
    if (!inverse) return std::nullopt;
    const Matrix3d q = in_enu(frame, *inverse);
    const Vector3d& clock_row = rows[solution.reference];
    const double clock = 1.0 / counts[solution.reference] + clock_row.dot(*inverse * clock_row);
    Dop dop;
    dop.gdop = std::sqrt(q.trace() + clock);
    dop.pdop = std::sqrt(q.trace());
    dop.hdop = std::sqrt(q(0, 0) + q(1, 1));
    dop.vdop = std::sqrt(q(2, 2));
    dop.tdop = std::sqrt(clock);
    dop.edop = std::sqrt(q(0, 0));
    dop.ndop = std::sqrt(q(1, 1));
    // The satellites say nothing of a height that was held.
    if (solution.height_held) dop.gdop = dop.pdop = dop.vdop = std::numeric_limits<double>::quiet_NaN();
    return dop;
}

}  // namespace skyloop::inline receiver
