/// NTCM-G: the closed ionosphere model that is driven by the Galileo broadcast.
#pragma once

#include "base/time/utc_time.hpp"
#include "world/gnss/thin_shell.hpp"

namespace skyloop {

/// The coefficients of the effective ionisation level that Galileo broadcasts for its single-frequency ionosphere
/// (Galileo OS SIS ICD, 5.1.6): solar flux units, and those per degree and per degree squared of MODIP.
struct EffectiveIonisation {
    double a0 = 0, a1 = 0, a2 = 0;
    /// Satellites that have none send noughts (NeQuick-G document, 3.1).
    [[nodiscard]] constexpr bool given() const { return a0 != 0 || a1 != 0 || a2 != 0; }
};

/// The level that serves where none is given, solar flux units (NeQuick-G document, 3.1).
inline constexpr double default_ionisation_level = 63.7;

/// When an ionosphere model is taken, in UT.
struct IonosphereTime {
    double day_of_year = 1;  ///< 1 … 366
    double hours = 0;        ///< since midnight
    static IonosphereTime of(const UtcTime& utc);
};

/// The number that stands for the Sun's activity in NTCM-G, Azpar, solar flux units (MODELS.md A.5);
/// default_ionisation_level where none is given, as in NeQuick-G.
double ntcm_g_ionisation(const EffectiveIonisation& broadcast);

/// Vertical electron content above a pierce point (European Commission, NTCM G Ionospheric Model Description,
/// MODELS.md A.5).
Tecu ntcm_g_vertical_content(const EffectiveIonisation& broadcast, const PiercePoint& where,
                             const IonosphereTime& when);

/// What NTCM-G says of one direction, with the values on the way.
struct NtcmGContent {
    PiercePoint pierce;
    Tecu vertical;
    double slant_factor = 1;
    Tecu slant;
};

/// The slant electron content towards a satellite; delay by ionosphere_group_delay(). For elevations above 0°.
NtcmGContent ntcm_g_content(const EffectiveIonisation& broadcast, const Geodetic& place, const SkyDirection& direction,
                            const IonosphereTime& when);

}  // namespace skyloop
