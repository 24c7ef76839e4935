/// The thermal noise of the loops that track a signal.
/// What a scintillating ionosphere does to the loops that track a signal.
#pragma once

#include "base/core/units.hpp"

namespace skyloop::inline receiver {

/// C/N0 as a ratio, taken out of its logarithm once for all the formulas that need it.
class CarrierToNoise {
public:
    /// Not explicit: whoever has a DbHz passes it as it is.
    CarrierToNoise(DbHz cn0);
    /// Hz
    [[nodiscard]] double ratio() const { return ratio_; }

private:
    double ratio_;
};

/// A non-coherent early-late power code loop.
struct CodeLoop {
    Hertz bandwidth{0.5};            ///< B_n, one-sided
    double spacing_chips = 0.25;     ///< D, early to late
    Seconds integration{0.02};       ///< T, before detection
    Hertz front_end_bandwidth{8e6};  ///< B_fe, two-sided
    Hertz chip_rate{1.023e6};
    /// Length of a chip along the ray.
    [[nodiscard]] Metres chip_length() const;
};

/// Standard deviation of the code phase, chips, for BPSK-R: three regimes of the spacing D against the chips that the
/// front end resolves (Kaplan and Hegarty, section on DLL errors, after Betz and Kolodziejski; MODELS.md 7.9).
double code_jitter_chips(const CodeLoop& loop, CarrierToNoise cn0);
/// The same in metres.
Metres code_jitter(const CodeLoop& loop, CarrierToNoise cn0);

/// A carrier loop: phase (Costas, arctangent) or frequency.
struct CarrierLoop {
    Hertz bandwidth{15};        ///< B_n, one-sided
    Seconds integration{0.02};  ///< T, before detection
};

/// Standard deviation of the carrier phase (Kaplan and Hegarty, PLL thermal noise; MODELS.md 7.9).
Angle phase_jitter(const CarrierLoop& loop, CarrierToNoise cn0);

/// Standard deviation of the carrier frequency (Kaplan and Hegarty, FLL thermal noise; MODELS.md 7.9).
/// @param threshold_factor F: 1 at high C/N0, 2 near the threshold
Hertz frequency_jitter(const CarrierLoop& loop, CarrierToNoise cn0, double threshold_factor = 1);

/// Amplitude scintillation index S4 from which the formulas below, and tracking with them, break down.
inline constexpr double strongest_scintillation = 0.707;

/// Parameter m = 1/S4² of the Nakagami distribution of the amplitude. @param s4 above 0
double nakagami_m(double s4);

/// Power of a signal over its mean, of which a strong part arrives as it is and the rest scattered: Rice's distribution
/// with the moments that Nakagami's has for this S4, K = √(m² − m)/(m − √(m² − m)) (MODELS.md 7.11; Rice 1948).
/// @param s4 0 … 1; above as at 1 @param in_phase of the scattered part, as quadrature of a normal distribution of unit
/// deviation
double scintillating_power(double s4, double in_phase, double quadrature);

/// Standard deviation of the code phase, chips (Conker, El-Arini, Hegarty and Hsiao 2003; MODELS.md 7.11).
/// @param s4 0 … 0.707 (exclusive)
double scintillating_code_jitter_chips(const CodeLoop& loop, CarrierToNoise cn0, double s4);

/// Standard deviation of the carrier phase by thermal noise; the scintillation of the phase itself comes on top (Conker
/// et al. 2003; MODELS.md 7.11).
Angle scintillating_phase_jitter(const CarrierLoop& loop, CarrierToNoise cn0, double s4);

}  // namespace skyloop::inline receiver
