/// Delays of the ionosphere and the troposphere by the closed models that broadcasts and receivers share.
#pragma once

#include "base/core/units.hpp"
#include "base/geo/geodetic.hpp"
#include "base/time/gps_time.hpp"
#include "world/gnss/dop.hpp"
#include "world/gnss/navigation_source.hpp"

namespace skyloop {

/// What the single-frequency ionosphere model says of one direction, with the values on the way.
struct KlobucharDelay {
    double slant_factor = 1;  ///< slant over vertical delay, F
    Angle pierce_latitude;    ///< where the ray crosses the model's shell
    Angle pierce_longitude;   ///< −180 … 180°
    Seconds local_time;       ///< at the pierce point, 0 … 86 400 s
    Metres vertical;          ///< at L1, above the pierce point
    Metres slant;             ///< at L1, along the ray
};

/// The user algorithm of the broadcast ionosphere (IS-GPS-200, 20.3.3.5.2.5; Klobuchar 1987).
/// @param place the antenna  @param direction of the satellite  @param time of reception
KlobucharDelay klobuchar_delay(const KlobucharCoefficients& coefficients, const Geodetic& place,
                               const SkyDirection& direction, GpsTime time);

/// An ionospheric delay at L1 as it is at another carrier: it falls with the square of the frequency.
Metres ionosphere_delay_at(Metres delay_l1, Hertz carrier);

/// a, b, c of a continued fraction in sin e.
struct MappingCoefficients {
    double a = 0, b = 0, c = 0;
};

/// Slant over zenith delay by Marini's continued fraction, normalised to 1 at the zenith
/// (Marini 1972; Herring 1992; MODELS.md 3.8).
double marini(const MappingCoefficients& coefficients, Angle elevation);

/// Hydrostatic coefficients of Niell's mapping function, at sea level (Niell 1996, table 3).
/// @param day_of_year 1.0 at 1 January 00:00 UTC, with fraction
MappingCoefficients niell_hydrostatic(Angle latitude, double day_of_year);
/// Wet coefficients of Niell's mapping function (Niell 1996, table 4).
MappingCoefficients niell_wet(Angle latitude);
/// What a height adds to the hydrostatic mapping: [1/sin e − m(e; a_ht, b_ht, c_ht)]·H with H in kilometres
/// (Niell 1996, equations 6 and 7).
double niell_height_correction(MslHeight height, Angle elevation);
/// The same from 3° on. Below, where nothing was fitted and 1/sin e grows without bound, it goes on along its tangent
/// over sin e, up to 0.16 for each kilometre at the horizon (our decision).
/// @param elevation from 0° on
double height_correction_to_horizon(MslHeight height, Angle elevation);

/// Where and when a mapping function is taken.
struct MappingSite {
    Angle latitude;
    MslHeight height;
    double day_of_year = 1;  ///< 1.0 at 1 January 00:00 UTC, with fraction
};

/// Niell's hydrostatic mapping function, height correction included. Fitted for elevations from 3°.
double niell_hydrostatic_mapping(const MappingSite& site, Angle elevation);
/// Niell's wet mapping function.
double niell_wet_mapping(Angle latitude, Angle elevation);

}  // namespace skyloop
