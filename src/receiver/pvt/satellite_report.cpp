#include "receiver/pvt/satellite_report.hpp"

#include <algorithm>

#include "base/geo/local_frame.hpp"
#include "world/gnss/earth_turn.hpp"
#include "world/gnss/orbit.hpp"

namespace skyloop {
namespace {

constexpr std::chrono::seconds look_up_period(30);
// What a satellite may rise, and a receiver fly, until the next look.
constexpr Angle look_up_margin = Angle::degrees(1.5);
constexpr Seconds roughest_travel_time(0.075);

SkyDirection direction_of(const Ephemeris& record, GpsTime time, const LocalFrame& frame) {
    const Position<Ecef> then = satellite_state(record, time, -roughest_travel_time).position;
    const LookAngles look = frame.look_angles(Position<Ecef>(turned_by(then.vector(), roughest_travel_time.value())));
    return {look.azimuth, look.elevation};
}

bool lists(const std::vector<SatelliteStatus>& list, SatelliteId id) {
    return std::any_of(list.begin(), list.end(), [id](const SatelliteStatus& s) { return s.id == id; });
}

}  // namespace

void SatelliteReport::look_up(GpsTime time, const Position<Ecef>& position) {
    const GpsTime grid = std::chrono::floor<std::chrono::seconds>(time) -
                         std::chrono::floor<std::chrono::seconds>(time).time_since_epoch() % look_up_period;
    if (looked_up_ == grid) return;
    looked_up_ = grid;
    candidates_.clear();
    const LocalFrame frame(to_geodetic(position));
    for (const SatelliteId id : sent_.satellites()) {
        const std::optional<Ephemeris> record = sent_.ephemeris(id, grid);
        if (!record) continue;
        Candidate candidate{id, carried_to(*record, grid)};
        if (direction_of(candidate.record, grid, frame).elevation > -look_up_margin)
            candidates_.push_back(std::move(candidate));
    }
}

void SatelliteReport::add_tracked(const ReportInput& input, std::vector<SatelliteStatus>& list) const {
    for (const Observation& o : input.observations.signals) {
        const bool first_of_it = list.empty() || list.back().id != o.satellite;
        if (!first_of_it) {
            if (o.signal == first_signal(o.satellite.constellation)) list.back().cn0 = o.cn0;
            continue;
        }
        SatelliteStatus status;
        status.id = o.satellite;
        status.cn0 = o.cn0;
        const Ephemeris* record = received_.record(o.satellite, input.time);
        status.has_ephemeris = record != nullptr;
        status.healthy = !o.called_unhealthy && (record == nullptr || is_healthy(*record));
        list.push_back(status);
    }
    std::vector<char> solved(list.size());
    for (std::size_t i = 0; input.ranges != nullptr && i < input.equations.size(); ++i) {
        const auto found =
            std::find_if(list.begin(), list.end(), [&](const auto& s) { return s.id == input.equations[i].satellite; });
        if (found == list.end()) continue;
        const RangeOutcome& range = (*input.ranges)[i];
        found->azimuth = range.direction.azimuth;
        found->elevation = range.direction.elevation;
        found->used = range.used;
        found->residual = range.residual;
        solved[static_cast<std::size_t>(found - list.begin())] = 1;
    }
    if (!input.position) return;
    const LocalFrame frame(to_geodetic(*input.position));
    for (std::size_t i = 0; i < list.size(); ++i) {
        if (solved[i]) continue;
        const Ephemeris* record = received_.record(list[i].id, input.time);
        std::optional<Ephemeris> coarse;
        if (record == nullptr && received_.almanac_known(input.time)) coarse = sent_.ephemeris(list[i].id, input.time);
        if (record == nullptr && coarse) record = &*coarse;
        if (record == nullptr) continue;
        const SkyDirection direction = direction_of(*record, input.time, frame);
        list[i].azimuth = direction.azimuth;
        list[i].elevation = direction.elevation;
    }
}

void SatelliteReport::add_untracked(const ReportInput& input, std::vector<SatelliteStatus>& list) const {
    const LocalFrame frame(to_geodetic(*input.position));
    const bool almanac = received_.almanac_known(input.time);
    const std::size_t tracked = list.size();
    for (const Candidate& c : candidates_) {
        const Ephemeris* record = received_.record(c.id, input.time);
        if ((record == nullptr && !almanac) || lists(list, c.id)) continue;
        const SkyDirection direction = direction_of(c.record, input.time, frame);
        if (direction.elevation <= Angle()) continue;
        SatelliteStatus status;
        status.id = c.id;
        status.azimuth = direction.azimuth;
        status.elevation = direction.elevation;
        status.has_ephemeris = record != nullptr;
        status.healthy = is_healthy(record != nullptr ? *record : c.record);
        list.push_back(status);
    }
    if (list.size() > tracked)
        std::sort(list.begin(), list.end(), [](const auto& a, const auto& b) { return a.id < b.id; });
}

std::vector<SatelliteStatus> SatelliteReport::list(const ReportInput& input) {
    std::vector<SatelliteStatus> list;
    add_tracked(input, list);
    if (input.position) {
        look_up(input.time, *input.position);
        add_untracked(input, list);
    }
    return list;
}

}  // namespace skyloop
