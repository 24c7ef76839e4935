/// What a layered atmosphere takes from a signal: gases, clouds, rain and the ionosphere's absorption.
/// One gaseous attenuation for the whole path: the simplest model of the air.
/// From powers and losses to the C/N0 at the antenna.
#pragma once

#include <map>
#include <vector>

#include "world/gnss/constants.hpp"
#include "world/propagation/propagation_effect.hpp"
#include "world/propagation/propagation_parameters.hpp"
#include "world/propagation/specific_attenuation.hpp"

namespace skyloop::inline world {

/// A value for each carrier, made when it is asked for first.
template <class Value>
class PerCarrier {
public:
    /// @param make makes it, from the carrier
    template <class Make>
    const Value& of(Hertz carrier, Make&& make) {
        const auto [place, is_new] = values_.try_emplace(carrier.value());
        if (is_new) place->second = make(carrier);
        return place->second;
    }

private:
    std::map<double, Value> values_;
};

/// Losses over straight paths through uniform spherical shells (MODELS.md 3.6), at each satellite's first carrier.
/// Writes gas, cloud, rain and ionospheric loss. Layers are heights above the sphere; the antenna's is its ellipsoidal
/// height, as h is in MODELS.md, which asks for heights above the sea in the troposphere's delay alone (D-03). Of a
/// layer that the antenna stands in, only the part above it counts: for the path and for the mean concentration.
class LayeredAtmosphereLoss : public PropagationEffect {
public:
    explicit LayeredAtmosphereLoss(AtmosphereParameters atmosphere);
    void apply(Arrivals& arrivals, const SkyView& sky, const TruthState& truth) override;

private:
    // A shell and what a kilometre of it takes.
    struct Shell {
        Metres base, top;
        DecibelsPerKilometre attenuation;
    };
    // Those above the antenna.
    struct Shells {
        std::vector<Shell> air, clouds;
    };
    [[nodiscard]] std::vector<Shell> air_above(Metres antenna_height, Hertz carrier) const;
    [[nodiscard]] std::vector<Shell> clouds_above(Metres antenna_height, Hertz carrier) const;

    AtmosphereParameters atmosphere_;
};

/// Absorption in the ionosphere: the constant part and the riometer's, scaled by the square of the frequency and the
/// slant at the ionosphere's lower edge (MODELS.md D-06).
/// @param elevation_there of the ray at the lower edge
Decibels ionosphere_absorption(const AtmosphereParameters& atmosphere, Hertz carrier, Angle elevation_there);

/// (γ_o h_o + γ_w h_w)/sin e (MODELS.md section 6, whole-path). The parameters are those of L1; at another carrier both
/// γ are as much larger as those of P.676-13.
Decibels whole_path_loss(const WholePathParameters& parameters, Angle elevation,
                         Hertz carrier = Hertz(carrier_frequency_l1));

/// Writes the gas loss of each arrival, at its first carrier; clouds and rain have no part in this model.
class WholePathLoss : public PropagationEffect {
public:
    explicit WholePathLoss(const WholePathParameters& parameters) : parameters_(parameters) {}
    void apply(Arrivals& arrivals, const SkyView& sky, const TruthState& truth) override;

private:
    WholePathParameters parameters_;
    PerCarrier<Decibels> zenith_;
};

/// P_sat − L_s less all losses of the arrival, or the specified minimum less the losses without L_s
/// (MODELS.md 3.6 and D-05).
DecibelWatts received_power(const Arrival& arrival, const LinkBudgetParameters& link);

/// Hides satellites whose path has too many reflections, and writes the reflection loss, n times that of one wall, the
/// received power and C/N0. A hidden satellite gets neither. It comes last: it takes the losses that the other effects
/// have written.
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
