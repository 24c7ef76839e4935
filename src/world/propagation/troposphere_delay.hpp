/// The delay of the true troposphere: weather, mapping, and vapour that wanders.
#pragma once

#include <cstdint>

#include "base/geo/geoid.hpp"
#include "base/time/knotted_process.hpp"
#include "base/time/utc_time.hpp"
#include "world/gnss/atmosphere.hpp"
#include "world/propagation/modern_parameters.hpp"
#include "world/propagation/propagation_effect.hpp"
#include "world/propagation/propagation_parameters.hpp"

namespace skyloop::inline world {

/// Random walk of the zenith wet delay, m/√h: more in rain, and most in a thunderstorm (MODELS.md 7.3).
Metres wet_delay_walk(const TroposphereParameters& parameters, const AtmosphereParameters& atmosphere);

/// The air at the antenna that the parameters name. @param place for the climate
SurfaceWeather troposphere_weather(const TroposphereParameters& parameters, const Geodetic& place, MslHeight height,
                                   AnnualPhase phase);

/// Writes the tropospheric delay of each arrival: zenith delays of Saastamoinen from the weather, mapped to the slant,
/// gradients, and a wet part that wanders by a random walk and a Gauss-Markov process (MODELS.md 7.3).
///
/// State: the two processes.
class TroposphereDelay : public PropagationEffect {
public:
    /// @param geoid must outlive this; without one, the ellipsoidal height stands in for that above the sea
    struct Site {
        const Geoid* geoid = nullptr;
        LeapSeconds leap_seconds = LeapSeconds::announced();
    };
    TroposphereDelay(const ModernPropagationParameters& parameters, const AtmosphereParameters& atmosphere, Site site,
                     std::uint64_t seed);
    void apply(Arrivals& arrivals, const SkyView& sky, const TruthState& truth) override;

private:
    TroposphereParameters parameters_;
    Site site_;
    double factor_, residual_factor_;
    KnottedProcess wander_, walk_;
};

}  // namespace skyloop::inline world
