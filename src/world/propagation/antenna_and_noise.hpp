/// How much a receiving antenna hears from each direction, and how much a satellite sends.
/// The noise against which signals are received.
#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

#include "base/core/result.hpp"
#include "base/core/units.hpp"
#include "world/gnss/dop.hpp"

namespace skyloop::inline world {

/// The gain of a patch or survey antenna, G0 − d (1 − sin e)^p dBic (MODELS.md 7.7), or that of a table.
class AntennaPattern {
public:
    /// The formula with its defaults: G0 = 3.4 dBic, d = 16.5 dB, p = 1.3.
    AntennaPattern() = default;
    AntennaPattern(Decibels peak, Decibels drop, double exponent) : peak_(peak), drop_(drop), exponent_(exponent) {}

    /// Reads a table: a header line `elevation_deg,gain_dbic` or `azimuth_deg,elevation_deg,gain_dbic`, then numbers.
    /// Azimuths may come in any order; each has the same elevations. Lines that start with # are comments. Fails with
    /// `input` and FILE:LINE.
    static Result<AntennaPattern> parse(std::string_view text, std::string_view name);
    /// Reads a table from a file. Fails as read_text_file and parse() do.
    static Result<AntennaPattern> read(const std::filesystem::path& path);

    /// Linear between the rows of a table, around the compass too; constant beyond its elevations.
    [[nodiscard]] Decibels gain(const SkyDirection& direction) const;

    /// The same antenna with all gains, dB, times a factor: 0 is isotropic.
    [[nodiscard]] AntennaPattern scaled(double factor) const;

    /// G0, d and p of the formula.
    [[nodiscard]] Decibels peak() const { return peak_; }
    [[nodiscard]] Decibels drop() const { return drop_; }
    [[nodiscard]] double exponent() const { return exponent_; }

private:
    Decibels peak_{3.4}, drop_{16.5};
    double exponent_ = 1.3;
    // A table: gains by azimuth, then elevation, both ascending; degrees. Without azimuths it is the formula.
    std::vector<double> azimuths_, elevations_, gains_;
};

/// EIRP of a satellite by the angle between the centre of the Earth and the antenna.
struct SatellitePowerPoint {
    Angle off_boresight;
    DecibelWatts eirp;
};

/// Reads a table: a header line `off_boresight_deg,eirp_dbw`, then numbers with ascending angles. Lines that start with
/// # are comments. Fails with `input` and FILE:LINE.
Result<std::vector<SatellitePowerPoint>> read_satellite_pattern(std::string_view text, std::string_view name);
/// The same from a file. Fails as read_text_file and the above do.
Result<std::vector<SatellitePowerPoint>> read_satellite_pattern_file(const std::filesystem::path& path);

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

}  // namespace skyloop::inline world
