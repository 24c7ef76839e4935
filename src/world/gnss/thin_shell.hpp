/// The ionosphere as one thin shell: where a ray pierces it, and how much longer the slant way through it is.
#pragma once

#include "base/core/units.hpp"
#include "base/geo/geodetic.hpp"
#include "world/gnss/dop.hpp"

namespace skyloop {

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

}  // namespace skyloop
