/// What a layered atmosphere takes from a signal: gases, clouds, rain and the ionosphere's absorption.
/// One gaseous attenuation for the whole path: the simplest model of the air.
/// From powers and losses to the C/N0 at the antenna.
#pragma once

#include <vector>

#include "world/gnss/constants.hpp"
#include "world/propagation/propagation_effect.hpp"
#include "world/propagation/propagation_parameters.hpp"
#include "world/propagation/specific_attenuation.hpp"

namespace skyloop::inline world {

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

/// (γ_o h_o + γ_w h_w)/sin e (MODELS.md section 6, whole-path).
Decibels whole_path_loss(const WholePathParameters& parameters, Angle elevation);

/// Writes the gas loss of each arrival, at L1; clouds and rain have no part in this model.
class WholePathLoss : public PropagationEffect {
public:
    explicit WholePathLoss(const WholePathParameters& parameters) : parameters_(parameters) {}
    void apply(Arrivals& arrivals, const SkyView& sky, const TruthState& truth) override;

private:
    WholePathParameters parameters_;
};

/// P_sat − L_s less all losses of the arrival, or the specified minimum less the losses without L_s
/// (MODELS.md 3.6 and D-05).
DecibelWatts received_power(const Arrival& arrival, const LinkBudgetParameters& link);

/// Writes the reflection loss, n times that of one wall, and C/N0. A hidden satellite gets none. It comes last: it
/// takes the losses that the other effects have written.
class LinkBudget : public PropagationEffect {
public:
    /// @param environment_noise over the thermal noise, 1 (countryside) … 40 dB (industrial area)
    LinkBudget(const LinkBudgetParameters& link, Decibels environment_noise);
    void apply(Arrivals& arrivals, const SkyView& sky, const TruthState& truth) override;
    /// Density of the noise, dBW/Hz (MODELS.md 3.6, P_amb).
    [[nodiscard]] double noise_density_dbw_hz() const;

private:
    LinkBudgetParameters link_;
    Decibels environment_noise_;
};

}  // namespace skyloop::inline world
