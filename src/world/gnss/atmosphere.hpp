/// Delays of the ionosphere and the troposphere by the closed models that broadcasts and receivers share.
/// The delay of the neutral air by Saastamoinen's formulas, and the weather that they need.
///
/// The climate of the troposphere all over the globe: GPT's pressure and temperature, GMF's and VMF1's mapping
/// functions.
#pragma once

#include "base/core/units.hpp"
#include "base/geo/geodetic.hpp"
#include "base/time/gps_time.hpp"
#include "base/time/utc_time.hpp"
#include "world/gnss/dop.hpp"
#include "world/gnss/ephemeris.hpp"

namespace skyloop::inline world {

/// What the single-frequency ionosphere model says of one direction.
struct KlobucharDelay {
    Metres vertical;  ///< at L1, above the pierce point
    Metres slant;     ///< at L1, along the ray
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

/// The air at an antenna.
struct SurfaceWeather {
    double pressure_hpa = 1013.25;  ///< total
    Kelvin temperature{288.16};
    double vapour_pressure_hpa = 0;
};

/// The standard atmosphere that receivers assume: 1013.25 hPa and 15 °C at sea level, 6.5 K less per kilometre, vapour
/// from the relative humidity; constant below sea level (Saastamoinen 1972; MODELS.md 7.3; RTKLIB's constants).
/// @param relative_humidity 0 … 1
SurfaceWeather standard_weather(MslHeight height, double relative_humidity);

/// Zenith hydrostatic delay 0.0022768 P/(1 − 0.00266 cos 2φ − 0.00028 h_km) (Saastamoinen 1972; Davis et al. 1985).
Metres zenith_hydrostatic_delay(double pressure_hpa, Angle latitude, MslHeight height);
/// Zenith wet delay 0.002277 (1255/T + 0.05) e (Saastamoinen 1972).
Metres zenith_wet_delay(const SurfaceWeather& weather);

/// Zenith delays of both parts.
struct ZenithDelay {
    Metres hydrostatic;
    Metres wet;
    [[nodiscard]] Metres total() const { return hydrostatic + wet; }
};
ZenithDelay saastamoinen_zenith_delay(const SurfaceWeather& weather, Angle latitude, MslHeight height);

/// Slant delay in the standard atmosphere, mapped by 1/sin e as the simplest receivers do.
/// @param elevation above 0°
Metres saastamoinen_delay(Angle latitude, MslHeight height, Angle elevation, double relative_humidity);

/// Days, with fraction, since 28 January 1980: the phase of the annual wave in GPT, GMF and VMF1 (IERS Conventions
/// 2010, section 9.2). It runs on over the years.
struct AnnualPhase {
    double days = 0;
    static AnnualPhase of(const UtcTime& utc);
    /// cos(2π days/365.25): 1 in the northern winter.
    [[nodiscard]] double cosine() const;
};

/// What GPT says of a place.
struct GptWeather {
    double pressure_hpa = 0;
    double temperature_celsius = 0;
    Metres undulation;  ///< of the geoid, as the model has it
};

/// Global pressure and temperature (Boehm, Heinkelmann and Schuh 2007; IERS Conventions 2010, GPT.F).
GptWeather gpt_weather(const Geodetic& place, AnnualPhase phase);

/// A hydrostatic and a wet mapping, slant over zenith delay.
struct TroposphereMapping {
    double hydrostatic = 1;
    double wet = 1;
};

/// The two numbers that weather models give for VMF1.
struct Vmf1Coefficients {
    double a_hydrostatic = 0;
    double a_wet = 0;
};

/// a_h and a_w of the global mapping function, at sea level: what of it depends on place and season alone (Boehm,
/// Niell, Tregoning and Schuh 2006; IERS Conventions 2010, GMF.F). Else it is VMF1, and niell_height_correction() to
/// the hydrostatic part.
Vmf1Coefficients gmf_coefficients(const Geodetic& place, AnnualPhase phase);

/// Hydrostatic coefficients of VMF1 with a given a (Boehm, Werl and Schuh 2006; MODELS.md 7.3), at the height of the
/// place (VMF1.F). For those of a grid at sea level add niell_height_correction() to the mapping (VMF1_HT.F).
MappingCoefficients vmf1_hydrostatic(double a_hydrostatic, Angle latitude, AnnualPhase phase);
/// Wet coefficients of VMF1 with a given a.
MappingCoefficients vmf1_wet(double a_wet);

}  // namespace skyloop::inline world
