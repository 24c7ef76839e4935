/// The ionosphere as one thin shell: where a ray pierces it, and how much longer the slant way through it is.
/// Maps of the vertical electron content over the globe, and what lies between them.
/// NTCM-G: the closed ionosphere model that is driven by the Galileo broadcast.
#pragma once

#include <optional>
#include <vector>

#include "base/core/units.hpp"
#include "base/geo/geodetic.hpp"
#include "base/time/gps_time.hpp"
#include "base/time/utc_time.hpp"
#include "world/gnss/dop.hpp"

namespace skyloop::inline world {

/// A spherical Earth with the shell at one height over it (IONEX 1.0; MODELS.md 7.2).
struct ThinShell {
    Metres earth_radius{6371000};
    Metres height{450000};
};

/// Where a ray crosses the shell, geocentric.
struct PiercePoint {
    Angle latitude;
    Angle longitude;  ///< −180 … 180°
};

/// ψ, the angle at the centre of the Earth from an antenna at a height h over a sphere to where its ray pierces the
/// shell at H: π/2 − e − asin((R + h) cos e/(R + H)) (MODELS.md 7.2, where h is 0).
Angle pierce_angle(const ThinShell& shell, Angle elevation, Metres antenna_height = Metres(0));

/// ψ in units of 9°, at which gradients of the ionosphere have their full size: the 0.05 of MODELS.md 7.2 are
/// Klobuchar's semicircles. As radians they made a day three times as steep as the real one of
/// tools/scenarios/arequipa.toml.
double gradient_arm(Angle elevation, Metres antenna_height = Metres(0));

/// The pierce point of the ray from `place`, at its height over a sphere.
PiercePoint pierce_point(const ThinShell& shell, const Geodetic& place, const SkyDirection& direction);

/// The same as receivers compute it: longitude by an arcsine, which leaves a ray that passes over a pole within 90° of
/// the antenna's longitude (European Commission, NTCM-G Ionospheric Model Description 1.0, equation 26; BDS-SIS-ICD-B1I
/// 3.0, 5.2.4.7). It differs from pierce_point() beside the poles alone, above latitude 77° for elevations above 10°.
PiercePoint published_pierce_point(const ThinShell& shell, const Geodetic& place, const SkyDirection& direction);

/// Slant over vertical content of a single layer, 1/√(1 − ((R + h) cos e/(R + H))²), seen from a height h.
double single_layer_mapping(const ThinShell& shell, Angle elevation, Metres antenna_height = Metres(0));
/// The same of the modified single layer, which follows an extended profile more closely:
/// 1/√(1 − (R/(R + H) sin(0.9782 z))²) (Schaer 1999; MODELS.md 7.2, A.5).
double modified_single_layer_mapping(const ThinShell& shell, Angle elevation);

/// Group delay of a slant electron content, 40.3·TEC/f² (IONEX 1.0; Galileo ionospheric correction document).
Metres ionosphere_group_delay(Tecu slant_content, Hertz carrier);

/// Equally spaced values along a meridian or a parallel.
struct GridAxis {
    Angle first;
    Angle step;  ///< of either sign, not 0
    std::size_t count = 0;
};

/// The vertical electron content at one instant.
struct IonosphereMap {
    GpsTime time;
    /// TECU by latitude, then longitude; not a number where the map has no value.
    std::vector<double> content_tecu;
};

/// Maps on one grid, ascending in time (IONEX 1.0, Schaer, Gurtner and Feltens 1998).
struct IonosphereMaps {
    ThinShell shell;
    GridAxis latitude, longitude;
    std::vector<IonosphereMap> maps;
};

/// Vertical content of one map by bilinear interpolation. Beyond the last parallel, up to one step, its values hold; a
/// grid once around the globe closes on itself. Nothing where the grid does not reach or a value is missing.
std::optional<Tecu> map_content(const IonosphereMaps& maps, const IonosphereMap& map, const PiercePoint& where);

/// Vertical content of one map that is turned with the Sun, 360° a day, from its own instant to another, before or
/// after it. Nothing where map_content() has nothing.
std::optional<Tecu> turned_content(const IonosphereMaps& maps, const IonosphereMap& map, const PiercePoint& where,
                                   GpsTime time);

/// Vertical content between two maps: linear in time, each map turned with the Sun (IONEX 1.0, interpolation between
/// consecutive rotated maps). Nothing before the first map, after the last, or where a map has no
/// value.
std::optional<Tecu> vertical_content(const IonosphereMaps& maps, const PiercePoint& where, GpsTime time);

/// The same, but after the last map that one, turned with the Sun: for runs that outlast their maps.
std::optional<Tecu> held_content(const IonosphereMaps& maps, const PiercePoint& where, GpsTime time);

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

/// The slant electron content towards a satellite by NTCM-G (European Commission, NTCM G Ionospheric Model Description,
/// MODELS.md A.5); delay by ionosphere_group_delay(). For elevations above 0°.
/// @param pierce of the default shell, from an antenna at height 0: the model leaves heights out. By
///               published_pierce_point() it is what receivers compute, by pierce_point() what the ray meets.
Tecu ntcm_g_content(const EffectiveIonisation& broadcast, const PiercePoint& pierce, Angle elevation,
                    const IonosphereTime& when);

}  // namespace skyloop::inline world
