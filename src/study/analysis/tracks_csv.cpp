#include "study/analysis/tracks_csv.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <utility>

#include "base/time/utc_time.hpp"

namespace skyloop {

std::string tracks_csv(std::span<const SatelliteTrack> tracks) {
    std::vector<std::pair<SatelliteId, const TrackPoint*>> rows;
    for (const SatelliteTrack& track : tracks)
        for (const TrackPoint& point : track.points)
            rows.emplace_back(track.satellite, &point);
    std::stable_sort(rows.begin(), rows.end(), [](const auto& a, const auto& b) {
        return std::pair(a.second->time, a.first) < std::pair(b.second->time, b.first);
    });
    std::string text = "time_utc,satellite,x_m,y_m,z_m\n";
    for (const auto& [satellite, point] : rows) {
        const Eigen::Vector3d& p = point->position.vector();
        fmt::format_to(std::back_inserter(text), "{},{},{:.3f},{:.3f},{:.3f}\n",
                       format_utc(to_utc(point->time, LeapSeconds::announced())), to_string(satellite), p.x(), p.y(),
                       p.z());
    }
    return text;
}

}  // namespace skyloop
