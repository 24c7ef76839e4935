/// Orbits and clocks that were computed afterwards, as tables of positions.
#pragma once

#include <map>
#include <optional>
#include <vector>

#include "base/geo/frames.hpp"
#include "base/time/gps_time.hpp"
#include "world/gnss/satellite.hpp"

namespace skyloop::inline world {

/// One row of a table.
struct PreciseSample {
    GpsTime time;
    Position<Ecef> position;      ///< centre of mass
    std::optional<double> clock;  ///< satellite clock − GPST, s, without the eccentricity term
};

/// What a table says of an instant.
struct PreciseState {
    Position<Ecef> position;
    Velocity<Ecef> velocity;
    std::optional<double> clock_bias;  ///< s, without the eccentricity term; nothing where the table has gaps
};

/// Tables of positions and clocks of many satellites, interpolated.
///
/// Positions: the polynomial through the eleven nearest rows (Schenewerk 2003), taken in the frame that does not turn
/// with the Earth. Clocks: a straight line between the two rows around the instant.
class PreciseOrbits {
public:
    /// Rows of one satellite must come in ascending order of time.
    /// @param spacing between rows; a wider gap is not interpolated over
    PreciseOrbits(std::map<SatelliteId, std::vector<PreciseSample>> samples, Nanoseconds spacing)
        : samples_(std::move(samples)), spacing_(spacing) {}

    [[nodiscard]] const std::map<SatelliteId, std::vector<PreciseSample>>& samples() const { return samples_; }
    [[nodiscard]] Nanoseconds spacing() const { return spacing_; }
    /// Nothing outside the first and last row of the satellite, or where eleven rows without a gap are not at hand.
    [[nodiscard]] std::optional<PreciseState> state(SatelliteId satellite, GpsTime time) const;

private:
    std::map<SatelliteId, std::vector<PreciseSample>> samples_;
    Nanoseconds spacing_;
};

}  // namespace skyloop::inline world
