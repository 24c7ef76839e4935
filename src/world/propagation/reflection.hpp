/// What smooth walls and grounds give back of a wave.
/// A satellite's circular wave on its way over walls, with both hands of its polarisation.
#pragma once

#include <Eigen/Core>

#include <complex>
#include <optional>
#include <span>
#include <string_view>

#include "base/core/units.hpp"

namespace skyloop::inline world {

/// Permittivity a f^b and conductivity c f^d S/m, f in GHz (ITU-R P.2040, table of material properties).
struct SurfaceMaterial {
    std::string_view name;
    double a = 1, b = 0, c = 0, d = 0;
};

/// concrete, brick, glass, wood, marble, metal, dry-ground, medium-ground, wet-ground (ITU-R P.2040; MODELS.md A.8).
std::span<const SurfaceMaterial> surface_materials();
std::optional<SurfaceMaterial> surface_material(std::string_view name);

/// Relative permittivity of a material without its losses.
double permittivity_p2040(const SurfaceMaterial& material, Hertz carrier);
/// Conductivity, S/m.
double conductivity_p2040(const SurfaceMaterial& material, Hertz carrier);
/// ε_r − jσ/(2π f ε0).
std::complex<double> complex_permittivity_p2040(const SurfaceMaterial& material, Hertz carrier);

/// Amplitude reflection coefficients of a half-space.
struct FresnelReflection {
    std::complex<double> te;  ///< field across the plane of incidence
    std::complex<double> tm;  ///< field in the plane of incidence
    /// Of a circular wave, into the same hand.
    [[nodiscard]] std::complex<double> same_hand() const { return (te + tm) / 2.0; }
    /// Of a circular wave, into the opposite hand: most of it, from steep incidence.
    [[nodiscard]] std::complex<double> opposite_hand() const { return (tm - te) / 2.0; }
    /// What a circular wave loses of its power, both hands counted.
    [[nodiscard]] Decibels power_loss() const;
};

/// ITU-R P.2040, single interface from air; MODELS.md 7.10.
/// @param permittivity of the half-space, complex  @param incidence from the normal, 0 … 90°
FresnelReflection fresnel_reflection(std::complex<double> permittivity, Angle incidence);

/// What roughness leaves of the mirrored amplitude, exp(−2 (2π s cos θ/λ)²) (MODELS.md 7.10).
/// @param rms_height s of the surface
double roughness_factor(Metres rms_height, Angle incidence, Hertz carrier);

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

}  // namespace skyloop::inline world
