#include "receiver/pvt/received_records.hpp"

#include <cmath>

#include "world/gnss/navigation_data.hpp"

namespace skyloop {
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

}  // namespace skyloop
