// Which places of a route matter, and which times of a track do.
#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "detail/waypoint_parts.hpp"
#include "motion/trajectory/route.hpp"

namespace skyloop {
namespace {

constexpr std::size_t places_of_a_block = 1024;

// Of one block, both ends of which are kept.
void keep_what_matters(std::span<const Eigen::Vector3d> places, std::size_t first, double tolerance,
                       std::vector<bool>& kept) {
    struct Stretch {
        std::size_t from, to;
    };
    std::vector<Stretch> open{{first, std::min(first + places_of_a_block, places.size() - 1)}};
    while (!open.empty()) {
        const Stretch stretch = open.back();
        open.pop_back();
        double farthest = tolerance;
        std::size_t at = stretch.from;
        for (std::size_t i = stretch.from + 1; i < stretch.to; ++i) {
            const double distance = distance_from_leg(places[i], places[stretch.from], places[stretch.to]);
            if (distance > farthest) farthest = distance, at = i;
        }
        if (at == stretch.from) continue;
        kept[at] = true;
        open.push_back({stretch.from, at});
        open.push_back({at, stretch.to});
    }
}

}  // namespace

std::vector<std::size_t> places_that_matter(std::span<const Eigen::Vector3d> places, double tolerance) {
    std::vector<std::size_t> indices;
    if (places.empty()) return indices;
    std::vector<bool> kept(places.size(), false);
    kept.back() = true;
    for (std::size_t first = 0; first + 1 < places.size(); first += places_of_a_block) {
        kept[first] = true;
        keep_what_matters(places, first, tolerance, kept);
    }
    for (std::size_t i = 0; i < kept.size(); ++i)
        if (kept[i]) indices.push_back(i);
    return indices;
}

void find_useless_times(Track& track) {
    if (track.route || track.points.empty()) return;
    std::map<Nanoseconds, std::size_t> counts;
    for (const TrackRow& row : track.points)
        ++counts[row.time];
    std::size_t most = 0;
    for (const auto& [time, count] : counts)
        most = std::max(most, count);
    const std::size_t rows = track.points.size();
    const bool apart = std::any_of(track.points.begin(), track.points.end(), [&](const TrackRow& row) {
        return (row.position - track.points.front().position).length().value() > 0;
    });
    if (counts.size() > 1 && !(apart && rows - most < rows / 10)) return;
    track.route.emplace();
    track.origin.reset();
    track.route->why = rows == 1 ? "one place alone"
                                 : fmt::format("{} of {} times are equal: the file's times are not used", most, rows);
}

}  // namespace skyloop
