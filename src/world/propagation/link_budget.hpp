/// From powers and losses to the C/N0 at the antenna.
#pragma once

#include "world/propagation/effect.hpp"
#include "world/propagation/link_budget_parameters.hpp"

namespace skyloop {

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

}  // namespace skyloop
