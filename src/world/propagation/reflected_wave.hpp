/// A satellite's circular wave on its way over walls, with both hands of its polarisation.
#pragma once

#include <Eigen/Core>
#include <complex>
#include <span>

#include "base/core/units.hpp"

namespace skyloop {

/// One reflection.
struct ReflectingSurface {
    Eigen::Vector3d normal;             ///< unit, either side
    std::complex<double> permittivity;  ///< ε_r − jσ/(2π f ε0)
};

/// What arrives, over a right-hand wave of amplitude 1 that left the satellite. Arguments are those of e^{jωt}: a lag
/// is negative.
struct CircularWave {
    std::complex<double> right, left;
};

/// Fresnel reflection at each surface with the electric field as a vector in space, so that planes of incidence may lie
/// as they will (MODELS.md 7.10). The antenna points up (z); phases are those of its ports against the direct wave's.
/// @param surfaces from the antenna outwards  @param arrival unit, from the antenna to where the wave comes from
CircularWave reflected_wave(std::span<const ReflectingSurface> surfaces, const Eigen::Vector3d& arrival, Hertz carrier,
                            Metres roughness);

/// What an antenna of right hand makes of it: it hears the left hand weaker by `rejection`. The phase between the two
/// ports is the antenna's own and unknown: powers add, the stronger one tells the phase.
std::complex<double> heard_by_right_hand(const CircularWave& wave, Decibels rejection);

}  // namespace skyloop
