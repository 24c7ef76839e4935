#include "receiver/pvt/satellite_report.hpp"

#include <algorithm>
#include <cmath>

#include "base/geo/local_frame.hpp"
#include "world/gnss/navigation_data.hpp"
#include "world/gnss/orbit.hpp"

namespace skyloop::inline receiver {
namespace {

bool is_same_issue(const Ephemeris& a, const Ephemeris& b) {
    return toe_of(a) == toe_of(b) && iode_of(a) == iode_of(b) && is_healthy(a) == is_healthy(b) &&
           message_of(a) == message_of(b);
}

// The satellites whose data can be read at this epoch, ascending, once each.
std::set<SatelliteId> satellites_heard(const Observations& observations, DbHz least) {
    std::set<SatelliteId> heard;
    for (const Observation& o : observations.signals)
        if (o.pseudorange && o.cn0 >= least) heard.insert(o.satellite);
    return heard;
}

}  // namespace

ReceivedRecords::ReceivedRecords(const NavigationSource& sent, const NavigationParameters& parameters)
    : sent_(sent), collection_(parameters.ephemeris_collection), data_(parameters.data) {}

void ReceivedRecords::restart(StartKind kind, GpsTime time) {
    for (auto& [id, memory] : satellites_) {
        memory.heard_since.reset();
        if (kind != StartKind::hot) memory.record.reset();
    }
    // What a receiver knew before its first start is not simulated: hot means all that is sent at that time. Of a later
    // start it means what has been received until then.
    if (kind != StartKind::hot) all_known_ = false;
    if (kind != StartKind::cold) return;
    time_known_ = false;
    almanac_kept_ = false;
    almanac_since_ = time;
}

void ReceivedRecords::listen(const Observations& observations, GpsTime time) {
    if (all_known_) {
        for (const SatelliteId id : sent_.satellites())
            satellites_[id].record = sent_.ephemeris(id, time);
        all_known_ = false;
    }
    const std::set<SatelliteId> heard = satellites_heard(observations, data_.decoding_cn0);
    for (auto& [id, memory] : satellites_)
        if (!heard.contains(id)) {
            memory.heard_since.reset();
            memory.is_current = false;
        }
    for (const SatelliteId id : heard) {
        Memory& memory = satellites_[id];
        const bool heard_before = memory.heard_since && *memory.heard_since < time;
        if (!memory.heard_since) memory.heard_since = time;
        const std::optional<Ephemeris> sent = sent_.ephemeris(id, time);
        if (!sent) {
            memory.is_current = false;
            continue;
        }
        const bool known = memory.record && is_same_issue(*memory.record, *sent);
        const bool collected = difference(time, *memory.heard_since) >= collection_;
        const bool followed = memory.is_current && heard_before;
        memory.is_current = known || collected || followed;
        if (!known && memory.is_current) memory.record = sent;
        time_known_ = time_known_ || (collected && memory.is_current);
    }
}

bool ReceivedRecords::almanac_known(GpsTime time) const {
    return almanac_kept_ || (almanac_since_ && difference(time, *almanac_since_) >= data_.almanac_collection);
}

const Ephemeris* ReceivedRecords::record(SatelliteId satellite, GpsTime time) const {
    const auto memory = satellites_.find(satellite);
    if (memory == satellites_.end() || !memory->second.record) return nullptr;
    const Ephemeris& record = *memory->second.record;
    const double age = std::abs(difference(time, toe_of(record)).value());
    return memory->second.is_current || age <= usual_validity(record).value() ? &record : nullptr;
}

std::vector<SatelliteId> ReceivedRecords::satellites() const {
    std::vector<SatelliteId> known;
    for (const auto& [id, memory] : satellites_)
        if (memory.record) known.push_back(id);
    return known;
}

std::optional<Ephemeris> ReceivedRecords::ephemeris(SatelliteId satellite, GpsTime time) const {
    const Ephemeris* known = record(satellite, time);
    if (known == nullptr) return std::nullopt;
    return *known;
}

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
        if (range.used) found->sbas = input.equations[i].sbas;
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

}  // namespace skyloop::inline receiver
