/// Where satellites really are and what their clocks really show.
#pragma once

#include <memory>
#include <optional>

#include "world/gnss/antenna_calibration.hpp"
#include "world/gnss/code_biases.hpp"
#include "world/gnss/orbit.hpp"
#include "world/gnss/precise_orbits.hpp"

namespace skyloop::inline world {

/// Precise products as the truth of a run.
class PreciseTruth {
public:
    struct Parts {
        PreciseOrbits orbits;
        std::optional<PreciseClocks> clocks{};               ///< nothing: those of the orbits' own tables
        std::shared_ptr<const AntennaCatalogue> antennas{};  ///< null: signals leave from the centre of mass
        std::optional<CodeBiases> biases{};                  ///< nothing: group delays are as they are broadcast
    };
    explicit PreciseTruth(Parts parts) : parts_(std::move(parts)) {}

    /// Whether the products know the satellite at all: who is in them is true by them alone.
    [[nodiscard]] bool knows(SatelliteId satellite) const { return parts_.orbits.samples().contains(satellite); }
    /// Centre of mass and clock. The clock is that of the pair of signals which table_group_delay() tells, with the
    /// eccentricity term −2 r·v/c² (IS-GPS-200, 20.3.3.3.3.1). Nothing where the tables have no position or no clock;
    /// up to a second before the first row, which a signal takes, and after the last one they are carried on.
    [[nodiscard]] std::optional<SatelliteState> state(SatelliteId satellite, GpsTime time, Seconds offset) const;
    /// The instants for which there are both orbits and clocks; nothing where there are none.
    [[nodiscard]] std::optional<TimeSpan> span() const;
    [[nodiscard]] const std::shared_ptr<const AntennaCatalogue>& antennas() const { return parts_.antennas; }

    /// CodeBiases::of(); nothing without biases.
    [[nodiscard]] std::optional<Seconds> code_bias(SatelliteId satellite, Signal signal, GpsTime time) const {
        return parts_.biases ? parts_.biases->of(satellite, signal, time) : std::nullopt;
    }

private:
    Parts parts_;
};

}  // namespace skyloop::inline world
