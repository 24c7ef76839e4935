/// What satellites broadcast while some of them say that they are not to be used.
#pragma once

#include <set>

#include "world/flow/observations.hpp"
#include "world/gnss/navigation_source.hpp"

namespace skyloop {

/// A source whose records are unhealthy for the satellites that are observed as called unhealthy, in the bits of their
/// own system: data and all signals bad (IS-GPS-200, 20.3.3.3.1.4, of QZSS likewise), all signals out of service
/// (Galileo OS SIS ICD, as RINEX 3.05, table A8, keeps it), SatH1 of BeiDou, the first bit of B_n of GLONASS.
class WarnedBroadcast : public NavigationSource {
public:
    /// @param sent must outlive this
    WarnedBroadcast(const NavigationSource& sent, const Observations& observations);

    [[nodiscard]] std::vector<SatelliteId> satellites() const override { return sent_.satellites(); }
    [[nodiscard]] std::optional<Ephemeris> ephemeris(SatelliteId satellite, GpsTime time) const override;
    [[nodiscard]] const BroadcastIonosphere& ionosphere() const override { return sent_.ionosphere(); }
    [[nodiscard]] std::optional<TimeSpan> span() const override { return sent_.span(); }
    [[nodiscard]] std::string description() const override { return sent_.description(); }

private:
    const NavigationSource& sent_;
    std::set<SatelliteId> called_unhealthy_;
};

}  // namespace skyloop
