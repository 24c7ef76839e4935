/// Where broadcast orbits come from: recorded files or a nominal constellation.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "world/gnss/ephemeris.hpp"

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
    bool operator==(const KlobucharCoefficients&) const = default;
};

/// What broadcasts say of the ionosphere, by system. Coefficients that are noughts throughout say nothing: so do
/// satellites that have none, and converters that have heard none (NeQuick-G document, 3.1; RTKLIB takes them so, too).
struct BroadcastIonosphere {
    BroadcastIonosphere() = default;
    /// Of GPS alone.
    BroadcastIonosphere(std::optional<KlobucharCoefficients> of_gps) : gps(of_gps) {}  // NOLINT: the usual case
    BroadcastIonosphere(std::nullopt_t) {}                                             // NOLINT: none

    std::optional<KlobucharCoefficients> gps, qzss, beidou, navic;
    /// a_i0, a_i1, a_i2: effective ionisation level of Galileo, sfu and by degree (OS SIS ICD 2.0, table 69).
    std::optional<std::array<double, 3>> galileo;
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
    [[nodiscard]] virtual std::optional<Ephemeris> ephemeris(SatelliteId satellite, GpsTime time) const = 0;
    /// What the satellites say of the ionosphere.
    [[nodiscard]] virtual const BroadcastIonosphere& ionosphere() const = 0;
    /// The coefficients of GPS.
    [[nodiscard]] const std::optional<KlobucharCoefficients>& klobuchar() const { return ionosphere().gps; }
    /// The instants for which there are orbits; nothing when there is no limit.
    [[nodiscard]] virtual std::optional<TimeSpan> span() const = 0;
    /// For people: "brdc1820.10n" or "nominal GPS constellation".
    [[nodiscard]] virtual std::string description() const = 0;
};

}  // namespace skyloop
