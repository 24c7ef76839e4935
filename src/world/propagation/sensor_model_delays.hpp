/// The article's ionospheric delay: electron content times a fitted obliquity.
/// The article's tropospheric delay: a zenith delay that falls with height, mapped to the slant by Niell's functions.
/// The bent ray through an atmosphere of exponential refractivity, and what it costs in path.
#pragma once

#include <utility>
#include <variant>

#include "base/geo/geoid.hpp"
#include "base/time/utc_time.hpp"
#include "world/gnss/atmosphere.hpp"
#include "world/gnss/ephemeris.hpp"
#include "world/gnss/shell_ionosphere.hpp"
#include "world/propagation/propagation_effect.hpp"
#include "world/propagation/propagation_parameters.hpp"

namespace skyloop::inline world {

/// Slant over vertical delay, 1 + 2.74·10⁻⁶ (96° − e)³ (MODELS.md 3.7, F_p).
double ionosphere_obliquity(Angle elevation);
/// 0.162 F_p(e) TEC, at L1 (MODELS.md 3.7). @param vertical electron content
Metres tec_delay(Tecu vertical, Angle elevation);
/// The electron content that gives a vertical delay at L1, c T_v / 0.162 (MODELS.md D-15).
Tecu tec_of_vertical_delay(Metres vertical_delay);

/// Writes the ionospheric delay of each arrival, at its first carrier: that at L1 by (f_L1/f)². An antenna at or above
/// the shell has none: 350 km, that of the broadcast model, whose obliquity F_p is, too; of maps their own.
class TecIonosphereDelay : public PropagationEffect {
public:
    /// The same electron content everywhere.
    explicit TecIonosphereDelay(Tecu vertical) : content_(vertical) {}
    /// The electron content of the broadcast model above each satellite's pierce point.
    explicit TecIonosphereDelay(const KlobucharCoefficients& broadcast) : content_(broadcast) {}
    /// That of the maps there, with the obliquity of the article, not the maps' own mapping. After the last
    /// of them that one holds. Where and when they have none there is none: check_coverage() looks for that before.
    explicit TecIonosphereDelay(IonosphereMaps maps) : content_(std::move(maps)) {}

    void apply(Arrivals& arrivals, const SkyView& sky, const TruthState& truth) override;
    /// The vertical electron content that `satellite` is seen through.
    [[nodiscard]] Tecu vertical_content(const SatelliteInView& satellite, const TruthState& truth) const;

private:
    [[nodiscard]] Metres shell_height() const;

    std::variant<Tecu, KlobucharCoefficients, IonosphereMaps> content_;
};

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

/// N(h) = N₀ exp(−h/H), in parts per million over the vacuum.
struct ExponentialRefractivity {
    double surface = 315;       ///< N₀, at sea level
    Metres scale_height{7350};  ///< H
};

/// A ray traced from an antenna to the top of the air, 100 km.
struct RefractedRay {
    Angle chord_elevation;         ///< of the straight line between its ends
    Metres excess_optical;         ///< ∫(n − 1) ds along the ray
    Metres geometric_lengthening;  ///< ray less chord
    [[nodiscard]] Metres excess() const { return excess_optical + geometric_lengthening; }
};

/// Follows a ray through spherical shells by Bouguer's law, n r cos e = constant.
/// @param apparent elevation at the antenna, above the horizon
RefractedRay trace_ray(const ExponentialRefractivity& air, Angle apparent, MslHeight antenna);

/// What refraction adds to the elevation of the straight line to a satellite (ITU-R P.834, fit for the average
/// atmosphere; MODELS.md 7.6). Fitted up to 10°; above, it fades to nothing, as it should, a hundredth of a degree too
/// soon.
Angle refraction_bending(Angle free_space_elevation, MslHeight antenna);

/// Writes the excess path of each arrival as its tropospheric delay (MODELS.md section 6, refraction).
class RefractionDelay : public PropagationEffect {
public:
    /// @param geoid must outlive this; without one, the ellipsoidal height stands in
    RefractionDelay(const ExponentialRefractivity& air, const Geoid* geoid) : air_(air), geoid_(geoid) {}
    void apply(Arrivals& arrivals, const SkyView& sky, const TruthState& truth) override;

private:
    ExponentialRefractivity air_;
    const Geoid* geoid_;
};

}  // namespace skyloop::inline world
