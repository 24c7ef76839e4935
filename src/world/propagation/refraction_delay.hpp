/// The bent ray through an atmosphere of exponential refractivity, and what it costs in path.
#pragma once

#include "base/geo/geoid.hpp"
#include "world/propagation/effect.hpp"

namespace skyloop {

/// N(h) = N₀ exp(−h/H), in parts per million over the vacuum.
struct ExponentialRefractivity {
    double surface = 315;       ///< N₀, at sea level
    Metres scale_height{7350};  ///< H
};

/// A ray traced from an antenna to the top of the air, 100 km.
struct RefractedRay {
    Angle chord_elevation;         ///< of the straight line between its ends
    Metres excess_optical;         ///< ∫(n − 1) ds along the ray
    Metres geometric_lengthening;  ///< ray less chord
    [[nodiscard]] Metres excess() const { return excess_optical + geometric_lengthening; }
};

/// Follows a ray through spherical shells by Bouguer's law, n r cos e = constant.
/// @param apparent elevation at the antenna, above the horizon
RefractedRay trace_ray(const ExponentialRefractivity& air, Angle apparent, MslHeight antenna);

/// What refraction adds to the elevation of the straight line to a satellite (ITU-R P.834, fit for the average
/// atmosphere; MODELS.md 7.6). Fitted up to 10°; above, it fades to nothing, as it should, a hundredth of a degree too
/// soon.
Angle refraction_bending(Angle free_space_elevation, MslHeight antenna);
/// The same, seen from the ray's end: what to take from an apparent elevation to find the straight line.
Angle refraction_bending_of_apparent(Angle apparent, MslHeight antenna);

/// Writes the excess path of each arrival as its tropospheric delay (MODELS.md section 6, refraction).
class RefractionDelay : public PropagationEffect {
public:
    /// @param geoid must outlive this; without one, the ellipsoidal height stands in
    RefractionDelay(const ExponentialRefractivity& air, const Geoid* geoid) : air_(air), geoid_(geoid) {}
    void apply(Arrivals& arrivals, const SkyView& sky, const TruthState& truth) override;

private:
    ExponentialRefractivity air_;
    const Geoid* geoid_;
};

}  // namespace skyloop
