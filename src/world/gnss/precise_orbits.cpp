#include "world/gnss/precise_orbits.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "world/gnss/constants.hpp"

namespace skyloop::inline world {
namespace {

constexpr std::size_t lagrange_points = 11;

// The rows to interpolate from, those around `time`; fewer where the table has a gap.
std::span<const PreciseSample> rows_around(const std::vector<PreciseSample>& rows, GpsTime time, Nanoseconds spacing) {
    const auto next = std::upper_bound(rows.begin(), rows.end(), time,
                                       [](GpsTime t, const PreciseSample& row) { return t < row.time; });
    // Centred on the row before the instant, moved inwards at the ends of the table.
    const auto at = static_cast<std::size_t>(next - rows.begin());
    const std::size_t half = lagrange_points / 2 + 1;
    const std::size_t last_first = rows.size() - lagrange_points;
    const std::size_t first = std::min(at > half ? at - half : 0, last_first);
    const std::span<const PreciseSample> chosen(rows.data() + first, lagrange_points);
    for (std::size_t i = 1; i < chosen.size(); ++i)
        if (chosen[i].time - chosen[i - 1].time > spacing || chosen[i].time <= chosen[i - 1].time) return {};
    return chosen;
}

// The weights of the rows in the value and in the derivative of the polynomial at t = 0; `t` are the rows' times, s.
struct LagrangeWeights {
    std::array<double, lagrange_points> value{}, rate{};
};

LagrangeWeights lagrange_weights(const std::array<double, lagrange_points>& t) {
    LagrangeWeights weights;
    for (std::size_t i = 0; i < t.size(); ++i) {
        double value = 1;
        double rate = 0;
        for (std::size_t j = 0; j < t.size(); ++j) {
            if (j == i) continue;
            // The product rule, factor by factor: (−t_j)/(t_i − t_j) with derivative 1/(t_i − t_j).
            const double span = t[i] - t[j];
            rate = (rate * -t[j] + value) / span;
            value *= -t[j] / span;
        }
        weights.value[i] = value;
        weights.rate[i] = rate;
    }
    return weights;
}

// The clock between the rows around `time`; a row hit exactly needs no other.
std::optional<double> clock_at(std::span<const PreciseSample> rows, GpsTime time) {
    const auto next = std::lower_bound(rows.begin(), rows.end(), time,
                                       [](const PreciseSample& row, GpsTime t) { return row.time < t; });
    if (next == rows.end()) return std::nullopt;
    if (next->time == time || next == rows.begin()) return next->time == time ? next->clock : std::nullopt;
    const PreciseSample& before = *(next - 1);
    if (!before.clock || !next->clock) return std::nullopt;
    const double part = difference(time, before.time).value() / difference(next->time, before.time).value();
    return *before.clock + part * (*next->clock - *before.clock);
}

}  // namespace

std::optional<PreciseState> PreciseOrbits::state(SatelliteId satellite, GpsTime time) const {
    const auto own = samples_.find(satellite);
    if (own == samples_.end() || own->second.size() < lagrange_points) return std::nullopt;
    const std::vector<PreciseSample>& all = own->second;
    if (time < all.front().time || time > all.back().time) return std::nullopt;
    const std::span<const PreciseSample> rows = rows_around(all, time, spacing_);
    if (rows.empty()) return std::nullopt;

    std::array<double, lagrange_points> t{};
    for (std::size_t i = 0; i < rows.size(); ++i)
        t[i] = difference(rows[i].time, time).value();
    const LagrangeWeights weights = lagrange_weights(t);
    Eigen::Vector3d position = Eigen::Vector3d::Zero();
    Eigen::Vector3d velocity = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < rows.size(); ++i) {
        // The row's place in the frame that coincides with the Earth-fixed one at `time` and does not turn.
        const Eigen::Vector3d& p = rows[i].position.vector();
        const double s = std::sin(earth_rotation_rate * t[i]);
        const double c = std::cos(earth_rotation_rate * t[i]);
        const Eigen::Vector3d fixed(p.x() * c - p.y() * s, p.x() * s + p.y() * c, p.z());
        position += weights.value[i] * fixed;
        velocity += weights.rate[i] * fixed;
    }
    velocity += earth_rotation_rate * Eigen::Vector3d(position.y(), -position.x(), 0);
    return PreciseState{Position<Ecef>(position), Velocity<Ecef>(velocity), clock_at(rows, time)};
}

}  // namespace skyloop::inline world
