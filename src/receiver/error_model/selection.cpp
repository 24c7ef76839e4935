#include "receiver/error_model/selection.hpp"

#include <cassert>

namespace skyloop {
namespace {

bool visible(const Arrival& arrival, const SelectionRule& rule) {
    return arrival.paths > 0 && !arrival.cut_off &&
           (!rule.max_reflections || arrival.reflections <= *rule.max_reflections);
}

bool usable(const SatelliteInView& satellite, const Arrival& arrival, const SelectionRule& rule) {
    if (!satellite.healthy || arrival.called_unhealthy || arrival.cut_off || satellite.elevation < rule.elevation_mask)
        return false;
    if (!rule.hidden_too && !visible(arrival, rule)) return false;
    return !rule.snr_cutoff || (arrival.cn0 && *arrival.cn0 >= *rule.snr_cutoff);
}

}  // namespace

std::vector<SatelliteStatus> select_satellites(const SkyView& sky, const Arrivals& arrivals,
                                               const SelectionRule& rule) {
    assert(arrivals.satellites.size() == sky.satellites.size());
    std::vector<SatelliteStatus> statuses;
    statuses.reserve(sky.satellites.size());
    for (std::size_t i = 0; i < sky.satellites.size(); ++i) {
        const SatelliteInView& satellite = sky.satellites[i];
        const Arrival& arrival = arrivals.satellites[i];
        SatelliteStatus status;
        status.id = satellite.id;
        status.azimuth = satellite.azimuth;
        status.elevation = satellite.elevation;
        status.healthy = satellite.healthy && !arrival.called_unhealthy;
        if (visible(arrival, rule)) status.cn0 = arrival.cn0;
        status.used = usable(satellite, arrival, rule);
        statuses.push_back(status);
    }
    return statuses;
}

std::vector<SkyDirection> used_directions(const std::vector<SatelliteStatus>& satellites) {
    std::vector<SkyDirection> directions;
    for (const SatelliteStatus& satellite : satellites)
        if (satellite.used) directions.push_back({satellite.azimuth, satellite.elevation});
    return directions;
}

}  // namespace skyloop
