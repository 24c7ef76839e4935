/// Disturbances that travel through the ionosphere.
#pragma once

#include <Eigen/Core>

#include <array>
#include <cstdint>

#include "base/core/units.hpp"
#include "world/propagation/drifting_field.hpp"
#include "world/propagation/modern_parameters.hpp"
#include "world/propagation/per_satellite.hpp"

namespace skyloop::inline world {

/// Departures of the vertical electron content from its model, as a field over the globe: the same for all antennas, a
/// function of seed, place and GPS time alone. A quarter of the variance are two trains of waves as medium-scale
/// travelling disturbances are (wavelengths of 120 to 250 km, which the seed draws, of the 50 to 300 km of
/// Hernandez-Pajares, Juan and Sanz 2006, JGR 111 A07S11): they run from two opposite places beside the poles, each
/// strongest near its own, so that they go equatorwards as by winter days there. The rest are irregularities whose
/// structure function grows by the power 1.89 of the distance (Mevius et al. 2016, Radio Science 51, 927) up to some
/// 200 km.
///
/// State: what the field was around each satellite's ray.
class IonosphereWaves {
public:
    IonosphereWaves(const IonosphereWaveParameters& parameters, std::uint64_t key);
    /// Where the ray to a satellite pierces a shell at 450 km, beside what a model has there.
    Tecu vertical(const SatelliteInView& satellite, const TruthState& truth);
    /// The same along the ray.
    Tecu slant(const SatelliteInView& satellite, const TruthState& truth);

private:
    struct Train {
        double length = 0, phase = 0;  // m, turns
        DriftingField amplitude;
    };
    struct Memory {
        FieldMemory irregularities;
        std::array<FieldMemory, 2> amplitudes;
    };
    [[nodiscard]] static Train train(std::uint64_t key, MetresPerSecond speed);

    IonosphereWaveParameters parameters_;
    Eigen::Vector3d source_;  // of the first train, as a direction from the centre of the Earth
    DriftingField irregularities_;
    std::array<Train, 2> trains_;
    PerSatellite<Memory> memories_;
};

}  // namespace skyloop::inline world
