/// A GPS constellation that needs no file.
#pragma once

#include <span>
#include <string_view>

#include "world/gnss/navigation_source.hpp"

namespace skyloop {

/// One place in an orbital plane of the nominal constellation.
struct NominalSlot {
    std::string_view name;            ///< plane and place: "A1", "B1F"
    double argument_of_latitude_deg;  ///< at 1993-07-01T00:00:00
};

/// 31 healthy GPS satellites on circular orbits in six planes, at all times.
///
/// The 24 slots and the three expanded ones (27 satellites) are those of the GPS Standard Positioning Service
/// Performance Standard, 4th edition (2008), section 3.2, tables 3.2-1 and 3.2-2: inclination 55°, semi-major axis
/// 26 559.7 km. The 24 were held against a second print of the table; the six places of the expanded slots were not.
/// The other four satellites, named A5, B5, C5 and E5, are ours: each stands in the middle of the widest gap of its
/// plane. Satellites are numbered 1 … 31 in the order of slots(). Clocks are perfect. Motion is secular: the two-body
/// mean motion and the regression of the nodes, so that the sky keeps the true constellation's geometry, not its true
/// positions.
class NominalConstellation : public NavigationSource {
public:
    [[nodiscard]] std::vector<SatelliteId> satellites() const override;
    [[nodiscard]] std::optional<Ephemeris> ephemeris(SatelliteId satellite, GpsTime time) const override;
    /// A record with toe at the even hour of GPS time at or before `time`; positions run on smoothly from one record to
    /// the next. Nothing for a satellite without a slot.
    [[nodiscard]] std::optional<KeplerEphemeris> record(SatelliteId satellite, GpsTime time) const;
    [[nodiscard]] const BroadcastIonosphere& ionosphere() const override { return ionosphere_; }
    [[nodiscard]] std::optional<TimeSpan> span() const override { return std::nullopt; }
    [[nodiscard]] std::string description() const override { return "nominal GPS constellation"; }

    /// Satellite number n stands in slot n − 1.
    static std::span<const NominalSlot> slots();

private:
    BroadcastIonosphere ionosphere_;  // it says nothing of it
};

}  // namespace skyloop
