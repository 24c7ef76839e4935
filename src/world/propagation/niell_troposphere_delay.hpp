/// The article's tropospheric delay: a zenith delay that falls with height, mapped to the slant by Niell's functions.
#pragma once

#include "base/geo/geoid.hpp"
#include "base/time/utc_time.hpp"
#include "world/gnss/atmosphere.hpp"
#include "world/propagation/atmosphere_parameters.hpp"
#include "world/propagation/effect.hpp"

namespace skyloop {

/// Delay at the zenith, dry air and vapour (MODELS.md 3.8, E_z).
struct DryAndWetDelay {
    Metres dry;
    Metres wet;
};
/// Dry: a exp(−b H); wet: as given.
DryAndWetDelay zenith_delay(const AtmosphereParameters& atmosphere, MslHeight height);
/// Dry delay times hydrostatic mapping plus wet delay times wet mapping.
Metres slant_delay(const DryAndWetDelay& zenith, const MappingSite& site, Angle elevation);

/// Writes the tropospheric delay of each arrival (MODELS.md 3.8).
class NiellTroposphereDelay : public PropagationEffect {
public:
    /// @param geoid makes sea-level heights (MODELS.md D-03) and must outlive this; without one, the ellipsoidal height
    ///              stands in
    /// @param leap_seconds for the day of year in UTC
    NiellTroposphereDelay(const AtmosphereParameters& atmosphere, const Geoid* geoid, LeapSeconds leap_seconds);
    void apply(Arrivals& arrivals, const SkyView& sky, const TruthState& truth) override;

private:
    AtmosphereParameters atmosphere_;
    const Geoid* geoid_;
    LeapSeconds leap_seconds_;
};

}  // namespace skyloop
