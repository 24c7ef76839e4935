/// What a layered atmosphere takes from a signal: gases, clouds, rain and the ionosphere's absorption.
#pragma once

#include <vector>

#include "world/gnss/constants.hpp"
#include "world/propagation/atmosphere_parameters.hpp"
#include "world/propagation/effect.hpp"
#include "world/propagation/specific_attenuation.hpp"

namespace skyloop {

/// Losses over straight paths through uniform spherical shells (MODELS.md 3.6). Writes gas, cloud, rain and ionospheric
/// loss. Layers are heights above the sphere; the antenna's is its ellipsoidal height, as h is in MODELS.md, which asks
/// for heights above the sea in the troposphere's delay alone (D-03). Of a layer that the antenna stands in, only the
/// part above it counts: for the path and for the mean concentration.
class LayeredAtmosphereLoss : public PropagationEffect {
public:
    explicit LayeredAtmosphereLoss(AtmosphereParameters atmosphere, Hertz carrier = Hertz(carrier_frequency_l1));
    void apply(Arrivals& arrivals, const SkyView& sky, const TruthState& truth) override;

private:
    // A shell and what a kilometre of it takes.
    struct Shell {
        Metres base, top;
        DecibelsPerKilometre attenuation;
    };
    [[nodiscard]] std::vector<Shell> air_above(Metres antenna_height) const;
    [[nodiscard]] std::vector<Shell> clouds_above(Metres antenna_height) const;

    AtmosphereParameters atmosphere_;
    Hertz carrier_;
};

/// Absorption in the ionosphere: the constant part and the riometer's, scaled by the square of the frequency and the
/// slant at the ionosphere's lower edge (MODELS.md D-06).
/// @param elevation_there of the ray at the lower edge
Decibels ionosphere_absorption(const AtmosphereParameters& atmosphere, Hertz carrier, Angle elevation_there);

}  // namespace skyloop
