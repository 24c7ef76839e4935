/// How much a receiving antenna hears from each direction, and how much a satellite sends.
#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

#include "base/core/result.hpp"
#include "base/core/units.hpp"
#include "world/gnss/dop.hpp"

namespace skyloop {

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

}  // namespace skyloop
