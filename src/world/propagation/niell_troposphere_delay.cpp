#include "world/propagation/niell_troposphere_delay.hpp"

#include <cassert>
#include <cmath>
#include <utility>

#include "detail/lowest_elevation.hpp"
#include "detail/sea_level.hpp"

namespace skyloop {

DryAndWetDelay zenith_delay(const AtmosphereParameters& atmosphere, MslHeight height) {
    const double thinning = std::exp(-atmosphere.zenith_dry_decay_per_m * height.above_sea_level.value());
    return {atmosphere.zenith_dry_delay * thinning, atmosphere.zenith_wet_delay};
}

Metres slant_delay(const DryAndWetDelay& zenith, const MappingSite& site, Angle elevation) {
    return zenith.dry * niell_hydrostatic_mapping(site, elevation) +
           zenith.wet * niell_wet_mapping(site.latitude, elevation);
}

NiellTroposphereDelay::NiellTroposphereDelay(const AtmosphereParameters& atmosphere, const Geoid* geoid,
                                             LeapSeconds leap_seconds)
    : atmosphere_(atmosphere), geoid_(geoid), leap_seconds_(std::move(leap_seconds)) {}

void NiellTroposphereDelay::apply(Arrivals& arrivals, const SkyView& sky, const TruthState& truth) {
    assert(arrivals.satellites.size() == sky.satellites.size());
    const MappingSite site{truth.geodetic.latitude, sea_level_height(truth.geodetic, geoid_),
                           day_of_year(to_utc(truth.time, leap_seconds_))};
    const DryAndWetDelay zenith = zenith_delay(atmosphere_, site.height);
    for (std::size_t i = 0; i < sky.satellites.size(); ++i)
        arrivals.satellites[i].tropo_delay = slant_delay(zenith, site, above_horizon(sky.satellites[i].elevation));
}

}  // namespace skyloop
