/// The noise against which signals are received.
#pragma once

#include "base/core/units.hpp"

namespace skyloop {

/// Noise power density, dBW/Hz.
using DecibelWattsPerHertz = Quantity<struct DecibelWattsPerHertzUnit>;

/// Where man-made noise is heard (ITU-R P.372, table of c and d).
enum class NoiseEnvironment { city, residential, rural, quiet_rural };

/// Median man-made noise F_am = c − d log10(f/MHz), dB over k·290 K (ITU-R P.372; MODELS.md 7.8). Stated for
/// 0.3 … 250 MHz (quiet rural: 0.3 … 30 MHz); what lies above is an extrapolation.
Decibels man_made_noise_p372(NoiseEnvironment environment, Hertz carrier);

/// What makes the noise of a receiver; the line lies before the amplifier at 290 K.
struct ReceiverNoise {
    Kelvin antenna_temperature{130};
    Decibels line_loss{0};
    Decibels noise_figure{1.5};
};

/// Noise temperature at the amplifier's input, T_ant/l + 290 (1 − 1/l) + 290 (F − 1) (MODELS.md 7.7).
Kelvin system_temperature(const ReceiverNoise& noise);

/// N0 = 10 log10(k T) (MODELS.md 7.7).
DecibelWattsPerHertz noise_density(Kelvin temperature);

}  // namespace skyloop
