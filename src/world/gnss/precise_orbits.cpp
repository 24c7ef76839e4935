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

// The clock between the rows around `time`, or along the line of the nearest two outside; a row hit exactly needs no
// other.
template <class Row>
std::optional<ClockReading> clock_at(std::span<const Row> rows, GpsTime time, Nanoseconds spacing) {
    if (rows.size() < 2) return std::nullopt;
    const auto next =
        std::lower_bound(rows.begin(), rows.end(), time, [](const Row& r, GpsTime t) { return r.time < t; });
    const auto at = std::clamp<std::ptrdiff_t>(next - rows.begin(), 1, static_cast<std::ptrdiff_t>(rows.size()) - 1);
    const Row& after = rows[static_cast<std::size_t>(at)];
    const Row& before = rows[static_cast<std::size_t>(at - 1)];
    if (before.clock && after.clock && after.time - before.time <= spacing) {
        const double drift = (*after.clock - *before.clock) / difference(after.time, before.time).value();
        if (time == after.time) return ClockReading{*after.clock, drift};
        return ClockReading{*before.clock + drift * difference(time, before.time).value(), drift};
    }
    for (const Row* row : {&before, &after})
        if (row->time == time && row->clock) return ClockReading{*row->clock, 0};
    return std::nullopt;
}

template <class Row>
bool reaches(const std::vector<Row>& rows, GpsTime time, Nanoseconds beyond) {
    return !rows.empty() && time >= rows.front().time - beyond && time <= rows.back().time + beyond;
}

template <class Row>
std::optional<TimeSpan> span_of_rows(const std::map<SatelliteId, std::vector<Row>>& samples) {
    std::optional<TimeSpan> span;
    for (const auto& [satellite, rows] : samples) {
        if (rows.empty()) continue;
        if (!span) span = TimeSpan{rows.front().time, rows.back().time};
        span->first = std::min(span->first, rows.front().time);
        span->last = std::max(span->last, rows.back().time);
    }
    return span;
}

template <class Row>
void add_rows(std::map<SatelliteId, std::vector<Row>>& samples, const std::map<SatelliteId, std::vector<Row>>& others) {
    for (const auto& [satellite, rows] : others) {
        std::vector<Row>& own = samples[satellite];
        own.insert(own.end(), rows.begin(), rows.end());
        std::stable_sort(own.begin(), own.end(), [](const Row& a, const Row& b) { return a.time < b.time; });
        own.erase(std::unique(own.begin(), own.end(), [](const Row& a, const Row& b) { return a.time == b.time; }),
                  own.end());
    }
}

}  // namespace

std::optional<TimeSpan> PreciseOrbits::span() const { return span_of_rows(samples_); }

void PreciseOrbits::add(const PreciseOrbits& other) {
    add_rows(samples_, other.samples_);
    spacing_ = std::max(spacing_, other.spacing_);
}

std::optional<TimeSpan> PreciseClocks::span() const { return span_of_rows(samples_); }

void PreciseClocks::add(const PreciseClocks& other) {
    add_rows(samples_, other.samples_);
    spacing_ = std::max(spacing_, other.spacing_);
}

std::optional<ClockReading> PreciseClocks::at(SatelliteId satellite, GpsTime time, Nanoseconds beyond) const {
    const auto own = samples_.find(satellite);
    if (own == samples_.end() || !reaches(own->second, time, beyond)) return std::nullopt;
    return clock_at<ClockSample>(own->second, time, spacing_);
}

std::optional<PreciseState> PreciseOrbits::state(SatelliteId satellite, GpsTime time, Nanoseconds beyond) const {
    const auto own = samples_.find(satellite);
    if (own == samples_.end() || own->second.size() < lagrange_points) return std::nullopt;
    const std::vector<PreciseSample>& all = own->second;
    if (!reaches(all, time, beyond)) return std::nullopt;
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
    const std::optional<ClockReading> clock = clock_at(rows, time, spacing_);
    PreciseState state{Position<Ecef>(position), Velocity<Ecef>(velocity), std::nullopt};
    if (!clock) return state;
    state.clock_bias = clock->bias;
    state.clock_drift = clock->drift;
    return state;
}

}  // namespace skyloop::inline world
