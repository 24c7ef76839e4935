/// Orbits and clocks that were computed afterwards, as tables of positions.
/// Tables of clocks beside them.
#pragma once

#include <map>
#include <optional>
#include <vector>

#include "base/geo/frames.hpp"
#include "base/time/gps_time.hpp"
#include "world/gnss/ephemeris.hpp"
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
    double clock_drift = 0;            ///< s/s, of the line that the clock follows
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
    /// @param beyond how far outside the first and the last row is still told
    [[nodiscard]] std::optional<PreciseState> state(SatelliteId satellite, GpsTime time,
                                                    Nanoseconds beyond = Nanoseconds(0)) const;
    /// From the first row of any satellite to the last; nothing without rows.
    [[nodiscard]] std::optional<TimeSpan> span() const;
    /// Adds the rows of another table. Of rows of one instant the former one stays; the spacing becomes the wider one.
    void add(const PreciseOrbits& other);

private:
    std::map<SatelliteId, std::vector<PreciseSample>> samples_;
    Nanoseconds spacing_;
};

/// One row of a table of clocks.
struct ClockSample {
    GpsTime time;
    std::optional<double> clock;  ///< satellite clock − GPST, s, without the eccentricity term
};

/// What a table of clocks says of an instant.
struct ClockReading {
    double bias = 0;   ///< s
    double drift = 0;  ///< s/s
};

/// Tables of clocks alone, which are denser than those of orbits; read along a straight line between two rows.
class PreciseClocks {
public:
    /// Rows of one satellite must come in ascending order of time. @param spacing a wider gap is not interpolated over
    PreciseClocks(std::map<SatelliteId, std::vector<ClockSample>> samples, Nanoseconds spacing)
        : samples_(std::move(samples)), spacing_(spacing) {}

    [[nodiscard]] const std::map<SatelliteId, std::vector<ClockSample>>& samples() const { return samples_; }
    [[nodiscard]] Nanoseconds spacing() const { return spacing_; }
    /// @param beyond how far outside the first and the last row is still told
    [[nodiscard]] std::optional<ClockReading> at(SatelliteId satellite, GpsTime time,
                                                 Nanoseconds beyond = Nanoseconds(0)) const;
    [[nodiscard]] std::optional<TimeSpan> span() const;
    /// As that of PreciseOrbits.
    void add(const PreciseClocks& other);

private:
    std::map<SatelliteId, std::vector<ClockSample>> samples_;
    Nanoseconds spacing_;
};

}  // namespace skyloop::inline world
