#include "world/gnss/precise_truth.hpp"

#include <algorithm>
#include <chrono>

#include "world/gnss/constants.hpp"

namespace skyloop::inline world {
namespace {

constexpr std::chrono::seconds longest_travel{1};

// The eccentricity term and its derivative, of a two-body orbit: d(r·v)/dt = v² − μ/r in a frame that does not turn.
ClockReading eccentricity_term(const Eigen::Vector3d& position, const Eigen::Vector3d& velocity) {
    const Eigen::Vector3d inertial = velocity + earth_rotation_rate * Eigen::Vector3d(-position.y(), position.x(), 0);
    constexpr double factor = -2 / (speed_of_light * speed_of_light);
    return {factor * position.dot(velocity),
            factor * (inertial.squaredNorm() - gravitational_constant_gps / position.norm())};
}

}  // namespace

std::optional<SatelliteState> PreciseTruth::state(SatelliteId satellite, GpsTime time, Seconds offset) const {
    const GpsTime instant = advanced(time, offset);
    const std::optional<PreciseState> told = parts_.orbits.state(satellite, instant, longest_travel);
    if (!told) return std::nullopt;
    std::optional<ClockReading> clock;
    if (parts_.clocks)
        clock = parts_.clocks->at(satellite, instant, longest_travel);
    else if (told->clock_bias)
        clock = ClockReading{*told->clock_bias, told->clock_drift};
    if (!clock) return std::nullopt;
    const ClockReading relativity = eccentricity_term(told->position.vector(), told->velocity.vector());
    return SatelliteState{told->position, told->velocity, clock->bias + relativity.bias,
                          clock->drift + relativity.drift, relativity.bias};
}

std::optional<TimeSpan> PreciseTruth::span() const {
    std::optional<TimeSpan> span = parts_.orbits.span();
    if (!span || !parts_.clocks) return span;
    const std::optional<TimeSpan> clocks = parts_.clocks->span();
    if (!clocks) return std::nullopt;
    span->first = std::max(span->first, clocks->first);
    span->last = std::min(span->last, clocks->last);
    return span->first <= span->last ? span : std::nullopt;
}

}  // namespace skyloop::inline world
