/// How restless the ionosphere is towards each satellite.
#pragma once

#include "base/time/utc_time.hpp"
#include "world/propagation/effect.hpp"
#include "world/propagation/modern_parameters.hpp"

namespace skyloop {

/// S4 beyond which no loop's variance is defined is 1/√2 (MODELS.md 7.11); what is written stays below it.
inline constexpr double strongest_s4 = 0.7;

/// Modified dip latitude where the Earth's field is that of a dipole with its pole at 79.74° N, 71.78° W:
/// tan μ = I/√cos φ with tan I = 2 tan φ_m (Rawer 1963).
Angle dipole_modified_dip(const Geodetic& place);

/// What hour and place leave of the worst hour's scintillation, 0 … 1. @param hours UT
double evening_share(const ScintillationParameters& parameters, const Geodetic& place, double hours);

/// Writes S4 and the phase's deviation of each arrival, at its first signal. Both grow towards the horizon with the
/// slant through a shell at 350 km, S4 by its power 0.9 and the phase by its root, and fall with the carrier, by its
/// powers 1.5 and 1 (Priyadarshi 2015, on the weak-scatter theory of Rino 1979).
class ScintillationIndices : public PropagationEffect {
public:
    ScintillationIndices(const ScintillationParameters& parameters, const ErrorTerm& term, LeapSeconds leap_seconds);
    void apply(Arrivals& arrivals, const SkyView& sky, const TruthState& truth) override;

private:
    ScintillationParameters parameters_;
    double factor_;
    LeapSeconds leap_seconds_;
};

}  // namespace skyloop
