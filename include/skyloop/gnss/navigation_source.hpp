/// Where broadcast orbits come from: recorded files or a nominal constellation.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "skyloop/gnss/ephemeris.hpp"

namespace skyloop {

/// Which record of a satellite serves an instant.
enum class EphemerisRule {
    forward,  ///< the newest healthy record with 0 ≤ t − toe ≤ validity (MODELS.md 3.3, baseline)
    nearest,  ///< the record with the smallest |t − toe| ≤ validity
};

/// The eight coefficients of the single-frequency ionosphere model (IS-GPS-200, 20.3.3.5.1.7), semicircle powers.
struct KlobucharCoefficients {
    std::array<double, 4> alpha{};  ///< s, s/semicircle, …
    std::array<double, 4> beta{};   ///< s, s/semicircle, …
};

/// The instants for which a source can give orbits.
struct TimeSpan {
    GpsTime first;
    GpsTime last;
};

/// Orbits and broadcast parameters over time.
class NavigationSource {
public:
    virtual ~NavigationSource() = default;
    /// Every satellite that the source knows, ascending.
    [[nodiscard]] virtual std::vector<SatelliteId> satellites() const = 0;
    /// The record that serves `satellite` at `time`, or nothing.
    [[nodiscard]] virtual std::optional<KeplerEphemeris> ephemeris(SatelliteId satellite, GpsTime time) const = 0;
    [[nodiscard]] virtual std::optional<KlobucharCoefficients> klobuchar() const = 0;
    /// The instants for which there are orbits; nothing when there is no limit.
    [[nodiscard]] virtual std::optional<TimeSpan> span() const = 0;
    /// For people: "brdc1820.10n" or "nominal GPS constellation".
    [[nodiscard]] virtual std::string description() const = 0;
};

}  // namespace skyloop
