/// From powers, antennas and losses to the C/N0 of the modern profile.
#pragma once

#include <cstdint>

#include "base/time/knotted_process.hpp"
#include "world/propagation/modern_parameters.hpp"
#include "world/propagation/per_satellite.hpp"
#include "world/propagation/propagation_effect.hpp"

namespace skyloop::inline world {

/// Power of a signal over the satellite's first one, by the minimum powers of the interface documents.
/// @param range tells BeiDou's satellites in geosynchronous orbits from the others
Decibels relative_signal_power(Constellation constellation, Signal signal, Metres range);

/// C/N0 = P_iso + G − L_impl − N0 less all losses, and what a jammer leaves of it (MODELS.md 7.7). Writes antenna gain,
/// power offset, interference loss, the signals' relative power and C/N0; a hidden satellite gets none. It comes last:
/// it takes the losses that the other effects have written.
///
/// P_iso is the power received from the system's nominal orbit at this elevation, corrected for the real distance; the
/// satellite's own antenna makes up for the slant. With a satellite pattern it is EIRP less free-space loss.
///
/// State: spread and ripple of each satellite that has been in view.
class ModernLinkBudget : public PropagationEffect {
public:
    ModernLinkBudget(const ModernPropagationParameters& parameters, std::uint64_t seed);
    void apply(Arrivals& arrivals, const SkyView& sky, const TruthState& truth) override;
    /// In an isotropic antenna, before all losses but that of distance.
    [[nodiscard]] DecibelWatts isotropic_power(const Arrival& arrival, const TruthState& truth) const;
    /// N0, thermal and man-made, with the platform's noise.
    [[nodiscard]] DecibelWattsPerHertz noise(Hertz carrier) const;

private:
    struct Power {
        double spread;  // dB
        KnottedProcess ripple;
    };
    void set_cn0(Arrival& arrival, const TruthState& truth) const;

    ModernLinkParameters link_;
    ErrorTerm power_term_;
    double antenna_factor_, interference_factor_;
    Decibels film_;
    std::uint64_t seed_;
    PerSatellite<Power> powers_;
};

}  // namespace skyloop::inline world
