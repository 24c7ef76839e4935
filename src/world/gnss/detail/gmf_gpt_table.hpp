/// The spherical harmonics of GMF and GPT, degree and order 0 … 9.
#pragma once

#include <array>

namespace skyloop::inline world {

/// What multiplies P_nm(sin φ) cos mλ and P_nm(sin φ) sin mλ, Legendre functions without normalisation.
struct HarmonicPair {
    double cosine = 0, sine = 0;
};

/// One degree and order of all fields. `mean` is the average over the years, `amplitude` that of the annual wave.
struct GmfGptTerm {
    int n = 0, m = 0;
    HarmonicPair hydrostatic_mean, hydrostatic_amplitude;  ///< a_h, 1e-5
    HarmonicPair wet_mean, wet_amplitude;                  ///< a_w, 1e-5
    HarmonicPair undulation;                               ///< m
    HarmonicPair pressure_mean, pressure_amplitude;        ///< at sea level, hPa
    HarmonicPair temperature_mean, temperature_amplitude;  ///< at sea level, °C
};

extern const std::array<GmfGptTerm, 55> gmf_gpt_terms;

}  // namespace skyloop::inline world
