/// Where a ray crosses a sphere.
/// Gaussian fields over the whole globe that drift: functions of seed, place and GPS time alone.
#pragma once

#include <Eigen/Core>

#include <cstdint>
#include <span>
#include <vector>

#include "base/core/units.hpp"
#include "base/time/gps_time.hpp"
#include "world/flow/sky_view.hpp"
#include "world/flow/truth_state.hpp"
#include "world/propagation/smooth_noise.hpp"

namespace skyloop::inline world {

/// Where the ray to a satellite crosses a sphere about the centre of the Earth; from an antenna outside it, the point
/// below it. ECEF, m.
/// @param radius of the sphere
Eigen::Vector3d sphere_crossing(const TruthState& truth, const SatelliteInView& satellite, Metres radius);

/// Noise of one size.
struct NoiseOctave {
    Metres cell;           ///< of the lattice; the correlation is 1/e at 1.04 of it
    double deviation = 0;  ///< its share, 1 σ
};

/// What the field below was around the last place; one for each series of near places, as the rays to one satellite.
using FieldMemory = std::vector<NearbyNoise>;

/// A sum of octaves of smooth noise over ECEF, which moves through space as a whole (frozen flow, Taylor 1938), along a
/// direction that the key draws: there is no seam, every place has the same statistics, and what changes at one place
/// in a time t differs as what lies speed · t apart at one instant. The same key gives the same field to the bit, for
/// any antenna and from any start.
class DriftingField {
public:
    DriftingField(std::uint64_t key, std::span<const NoiseOctave> octaves, MetresPerSecond speed);
    /// @param place ECEF, m  @param memory empty at first
    double at(const Eigen::Vector3d& place, GpsTime time, FieldMemory& memory) const;

private:
    struct Octave {
        std::uint64_t key = 0;
        double per_cell = 0;  // 1/m
        double deviation = 0;
    };
    std::vector<Octave> octaves_;
    Eigen::Vector3d drift_;  // m/s
};

/// A unit vector, uniform over the sphere.
Eigen::Vector3d direction_of_bits(std::uint64_t bits);

}  // namespace skyloop::inline world
