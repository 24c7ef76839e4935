/// One system: its monitors, its masks and its messages.
#pragma once

#include <map>
#include <memory>
#include <vector>

#include "world/gnss/sbas_message.hpp"
#include "world/gnss/sbas_service.hpp"
#include "world/sbas/ionosphere_monitor.hpp"
#include "world/sbas/satellite_monitor.hpp"
#include "world/sbas/sbas_schedule.hpp"

namespace skyloop::inline world {

class SbasSystemService {
public:
    struct World {
        SatelliteMonitor::Truth satellites;
        Geodetic place;
    };
    /// @param ionosphere of all systems; outlives this
    SbasSystemService(SbasSystem system, const World& world, IonosphereMonitor& ionosphere);

    /// @param own the satellite's record  @param start of the message's second; ascending
    SbasMessage message(int prn, const SbasEphemeris& own, GpsTime start);

private:
    struct Band {
        int number = 0;
        std::vector<int> points;            // of its mask
        std::vector<SbasGridPoint> places;  // of these points
    };
    [[nodiscard]] static std::vector<Band> bands_of(const SbasServiceArea& area);
    [[nodiscard]] SbasTraffic traffic(int prn) const;
    [[nodiscard]] SbasFastCorrection fast_of(std::size_t index, GpsTime time);
    template <class Message>
    void put_fast(Message& m, const SbasSlot& slot, GpsTime time);
    [[nodiscard]] SbasFastCorrections fast_block(const SbasSlot& slot, GpsTime time);
    [[nodiscard]] SbasMixedCorrections mixed(const SbasSlot& slot, GpsTime time);
    [[nodiscard]] SbasIntegrity integrity(GpsTime start, GpsTime time);
    [[nodiscard]] SbasLongTermHalf long_term(std::size_t first, GpsTime time, bool around);
    [[nodiscard]] SbasMessage made(const SbasSlot& slot, const SbasEphemeris& own, GpsTime time);
    [[nodiscard]] SbasIonosphere grid(const SbasSlot& slot, GpsTime time);
    [[nodiscard]] SbasAlmanacs almanacs(GpsTime time) const;
    [[nodiscard]] SbasServiceRegions regions() const;

    SbasSystem system_;
    std::shared_ptr<const NavigationSource> navigation_;
    IonosphereMonitor& ionosphere_;
    std::vector<SatelliteId> corrected_;  // in the order of the mask
    std::vector<Band> bands_;
    SatelliteMonitor monitor_;
    std::map<int, SbasSchedule> schedules_;  // by PRN
};

}  // namespace skyloop::inline world
