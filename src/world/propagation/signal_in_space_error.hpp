/// Orbits and clocks that are not quite as they are broadcast.
#pragma once

#include <cstdint>

#include "base/time/knotted_process.hpp"
#include "world/propagation/modern_parameters.hpp"
#include "world/propagation/per_satellite.hpp"
#include "world/propagation/propagation_effect.hpp"

namespace skyloop::inline world {

/// 1 σ of the parts of a satellite's error, m.
struct OrbitClockSigmas {
    double radial = 0, along = 0, cross = 0, clock = 0;
};

/// How much of the parts users see, averaged over the Earth: SISRE² = (w1 R − c dt)² + w2 (A² + C²).
struct SisreWeights {
    double radial = 0.98;         ///< w1
    double tangential = 1. / 49;  ///< w2
};
/// By the height of the orbit (MODELS.md 7.1; Montenbruck, Steigenberger and Hauschild 2015).
SisreWeights sisre_weights(SatelliteId satellite);
/// 1 σ of the range of a user with independent parts.
Metres sisre(const OrbitClockSigmas& sigmas, const SisreWeights& weights);
/// Parts in the proportion that is typical of GPS, R 0.15, c dt 0.3, A 0.9, C 0.5, so large that their sisre() is that
/// of the satellite's system.
OrbitClockSigmas orbit_clock_sigmas(SatelliteId satellite, const SignalInSpaceParameters& parameters);

/// Writes the signal-in-space error and its rate: radial, along-track, cross-track and clock error of each satellite,
/// four smooth Gauss-Markov processes, seen along the line of sight (MODELS.md 7.1). The true orbit is the broadcast
/// one plus the error, and goes on where the broadcast one steps. Of satellites that precise products tell of, the
/// error is what their record really gets wrong (SatelliteInView::record_error).
///
/// State: the processes of each satellite that has been in view.
class SignalInSpaceError : public PropagationEffect {
public:
    SignalInSpaceError(const SignalInSpaceParameters& parameters, const ErrorTerm& term, std::uint64_t seed)
        : parameters_(parameters), term_(term), seed_(seed) {}
    void apply(Arrivals& arrivals, const SkyView& sky, const TruthState& truth) override;

private:
    struct Parts {
        KnottedProcess radial, along, cross, clock;
    };
    [[nodiscard]] Parts parts_of(SatelliteId satellite) const;

    SignalInSpaceParameters parameters_;
    ErrorTerm term_;
    std::uint64_t seed_;
    PerSatellite<Parts> parts_;
};

}  // namespace skyloop::inline world
