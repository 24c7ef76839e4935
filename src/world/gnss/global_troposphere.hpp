/// The climate of the troposphere all over the globe: GPT's pressure and temperature, GMF's and VMF1's mapping
/// functions.
#pragma once

#include "base/time/utc_time.hpp"
#include "world/gnss/atmosphere.hpp"

namespace skyloop {

/// Days, with fraction, since 28 January 1980: the phase of the annual wave in GPT, GMF and VMF1 (IERS Conventions
/// 2010, section 9.2). It runs on over the years.
struct AnnualPhase {
    double days = 0;
    /// @param mjd modified Julian date, UTC, with fraction
    static AnnualPhase of_modified_julian_date(double mjd) { return {mjd - 44266}; }
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

/// a_h and a_w of the global mapping function, at sea level: what of it depends on place and season alone.
Vmf1Coefficients gmf_coefficients(const Geodetic& place, AnnualPhase phase);

/// Global mapping function (Boehm, Niell, Tregoning and Schuh 2006; IERS Conventions 2010, GMF.F), Niell's height
/// correction included.
TroposphereMapping gmf_mapping(const Geodetic& place, AnnualPhase phase, Angle elevation);

/// Hydrostatic coefficients of VMF1 with a given a (Boehm, Werl and Schuh 2006; MODELS.md 7.3).
MappingCoefficients vmf1_hydrostatic(double a_hydrostatic, Angle latitude, AnnualPhase phase);
/// Wet coefficients of VMF1 with a given a.
MappingCoefficients vmf1_wet(double a_wet);

/// Vienna mapping function 1 with coefficients given at the height of the place (VMF1.F). For coefficients on a grid at
/// sea level, add niell_height_correction() to the hydrostatic part (VMF1_HT.F).
TroposphereMapping vmf1_mapping(const Vmf1Coefficients& a, Angle latitude, AnnualPhase phase, Angle elevation);

}  // namespace skyloop
