/// Vapour as a turbulent field over the globe.
/// The delay of the true troposphere: weather, mapping, and vapour that drifts by.
#pragma once

#include <cstdint>

#include "base/geo/geoid.hpp"
#include "base/time/utc_time.hpp"
#include "world/gnss/atmosphere.hpp"
#include "world/propagation/drifting_field.hpp"
#include "world/propagation/modern_parameters.hpp"
#include "world/propagation/per_satellite.hpp"
#include "world/propagation/propagation_effect.hpp"
#include "world/propagation/propagation_parameters.hpp"

namespace skyloop::inline world {

/// 1 σ of the zenith wet delay: more in rain, and most in a thunderstorm (docs/models.md).
Metres wet_delay_deviation(const TroposphereParameters& parameters, const AtmosphereParameters& atmosphere);

/// How the wet delay at the zenith departs from its model, over its σ: a field over the globe that the wind carries,
/// the same for all antennas and from any start. Its structure function is that of a layer of turbulence of 2 km, whose
/// refractivity has C_n² R^(2/3)/(1 + (R/L)^(2/3)) with L = 3000 km (Treuhaft and Lanyi 1987, Radio Science 22, 251):
/// it grows by the power 5/3 of the distance below the layer's height and by 2/3 above, here within 15 % from 70 m to
/// 3000 km. σ is the root of 0.54 C_n² h² L^(2/3)/2, as the largest octave has its end. A ray takes the field where it
/// passes 1 km of height, in the middle of the layer.
///
/// State: what the field was around each satellite's ray.
class WetField {
public:
    WetField(std::uint64_t key, MetresPerSecond wind);
    double at(const SatelliteInView& satellite, const TruthState& truth);

private:
    DriftingField field_;
    PerSatellite<FieldMemory> memories_;
};

/// The air at the antenna that the parameters name. @param place for the climate
SurfaceWeather troposphere_weather(const TroposphereParameters& parameters, const Geodetic& place, MslHeight height,
                                   AnnualPhase phase);

/// Writes the tropospheric delay of each arrival: zenith delays of Saastamoinen from the weather, mapped to the slant,
/// gradients, and what the vapour's field adds to the wet part.
///
/// State: the field's.
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
    double factor_;
    Metres deviation_;  // of the field, with the residual's factor
    WetField field_;
};

}  // namespace skyloop::inline world
