#include "detail/warned_broadcast.hpp"

namespace skyloop {
namespace {

int unhealthy_bits(Constellation constellation) {
    switch (constellation) {
        case Constellation::gps:
        case Constellation::qzss:
            return 0b111111;
        case Constellation::galileo:
            return 0b010'010'010;
        case Constellation::glonass:
            return 0b100;
        default:
            return 1;
    }
}

}  // namespace

WarnedBroadcast::WarnedBroadcast(const NavigationSource& sent, const Observations& observations) : sent_(sent) {
    for (const Observation& o : observations.signals)
        if (o.called_unhealthy) called_unhealthy_.insert(o.satellite);
}

std::optional<Ephemeris> WarnedBroadcast::ephemeris(SatelliteId satellite, GpsTime time) const {
    std::optional<Ephemeris> record = sent_.ephemeris(satellite, time);
    if (record && called_unhealthy_.contains(satellite))
        std::visit([&](auto& r) { r.health = unhealthy_bits(satellite.constellation); }, *record);
    return record;
}

}  // namespace skyloop
