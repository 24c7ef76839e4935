#include "skyloop/gnss/foreign_records.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>

#include "skyloop/gnss/orbit.hpp"
#include "skyloop/time/utc_time.hpp"

namespace skyloop {
namespace {

// Records further apart are not compared: extrapolated for half of it, a good orbit is still right within tens of
// kilometres.
constexpr std::chrono::hours comparable_span{12};
// How many records before and after are compared; enough to look past several foreign ones in a row.
constexpr std::size_t comparable_records = 6;
// Two satellites of one plane are kept apart by more, broadcast records of one satellite agree far better.
constexpr double same_orbit_m = 100e3;

double distance_between(const KeplerEphemeris& a, const KeplerEphemeris& b) {
    const GpsTime middle = a.toe + (b.toe - a.toe) / 2;
    return (satellite_state(a, middle).position - satellite_state(b, middle).position).length().value();
}

bool comparable(const KeplerEphemeris& a, const KeplerEphemeris& b) {
    return std::chrono::abs(a.toe - b.toe) <= comparable_span;
}

// The records of one satellite in time order, joined to clusters of records that agree, directly or through others. A
// manoeuvre changes the orbit little from one record to the next, so it does not part a cluster.
class Clusters {
public:
    explicit Clusters(std::vector<const KeplerEphemeris*> records) : records_(std::move(records)) {
        parent_.resize(records_.size());
        std::iota(parent_.begin(), parent_.end(), std::size_t{0});
        for_each_pair([&](std::size_t i, std::size_t j, double distance) {
            if (distance <= same_orbit_m) parent_[root(i)] = root(j);
        });
        size_.assign(records_.size(), 0);
        for (std::size_t i = 0; i < records_.size(); ++i) {
            parent_[i] = root(i);
            ++size_[parent_[i]];
        }
    }

    // What a record contradicts: the largest other cluster that has a record near in time somewhere else.
    struct Contradiction {
        std::size_t cluster_size = 0;
        std::size_t record = 0;  // the one nearest in time, of that cluster
        double distance = 0;
    };
    [[nodiscard]] std::vector<Contradiction> contradictions() const {
        std::vector<Contradiction> worst(records_.size());
        for_each_pair([&](std::size_t i, std::size_t j, double distance) {
            if (parent_[i] == parent_[j]) return;
            note(worst[i], i, j, distance);
            note(worst[j], j, i, distance);
        });
        return worst;
    }
    [[nodiscard]] std::size_t cluster_size(std::size_t i) const { return size_[parent_[i]]; }
    [[nodiscard]] const KeplerEphemeris& record(std::size_t i) const { return *records_[i]; }
    [[nodiscard]] std::size_t size() const { return records_.size(); }

private:
    template <class Visit>
    void for_each_pair(Visit visit) const {
        for (std::size_t i = 0; i < records_.size(); ++i)
            for (std::size_t j = i + 1; j < records_.size() && j <= i + comparable_records; ++j)
                if (comparable(*records_[i], *records_[j])) visit(i, j, distance_between(*records_[i], *records_[j]));
    }
    [[nodiscard]] std::size_t root(std::size_t i) const {
        while (parent_[i] != i)
            i = parent_[i];
        return i;
    }
    void note(Contradiction& worst, std::size_t i, std::size_t j, double distance) const {
        const std::size_t size = cluster_size(j);
        const auto apart = [&](std::size_t k) { return std::chrono::abs(records_[i]->toe - records_[k]->toe); };
        if (size > worst.cluster_size || (size == worst.cluster_size && apart(j) < apart(worst.record)))
            worst = {size, j, distance};
    }

    std::vector<const KeplerEphemeris*> records_;
    std::vector<std::size_t> parent_;  // after construction: the root of each record's cluster
    std::vector<std::size_t> size_;
};

// Records of each satellite, ascending by toe.
using RecordsBySatellite = std::map<SatelliteId, std::vector<const KeplerEphemeris*>>;

const KeplerEphemeris& nearest_record(const std::vector<const KeplerEphemeris*>& records, GpsTime time) {
    const auto next = std::lower_bound(records.begin(), records.end(), time,
                                       [](const KeplerEphemeris* r, GpsTime t) { return r->toe < t; });
    if (next == records.end()) return *records.back();
    if (next == records.begin() || (*next)->toe - time < time - (*(next - 1))->toe) return **next;
    return **(next - 1);
}

// The satellite, other than its own, whose orbit the record describes.
std::optional<SatelliteId> owner(const KeplerEphemeris& record, const RecordsBySatellite& all) {
    std::optional<SatelliteId> nearest;
    double smallest = same_orbit_m;
    for (const auto& [satellite, records] : all) {
        const KeplerEphemeris& other = nearest_record(records, record.toe);
        if (satellite == record.satellite || !comparable(record, other)) continue;
        const double distance = distance_between(record, other);
        if (distance >= smallest) continue;
        smallest = distance;
        nearest = satellite;
    }
    return nearest;
}

std::string foreign_sentence(const KeplerEphemeris& record, double distance, std::optional<SatelliteId> true_owner) {
    std::string toe = format_utc(gps_calendar(record.toe), 0);
    toe.pop_back();  // GPS time carries no Z
    return fmt::format("{}: record with toe {} lies {:.0f} km from its neighbours{}; dropped",
                       to_string(record.satellite), toe, distance / 1e3,
                       true_owner ? fmt::format(" (it is the orbit of {})", to_string(*true_owner)) : "");
}

// The foreign records among those of one satellite.
void find_foreign(const Clusters& own, const RecordsBySatellite& all,
                  std::map<const KeplerEphemeris*, std::string>& found) {
    const std::vector<Clusters::Contradiction> contradictions = own.contradictions();
    for (std::size_t i = 0; i < own.size(); ++i) {
        const KeplerEphemeris& record = own.record(i);
        const Clusters::Contradiction& against = contradictions[i];
        if (!record.healthy() || against.cluster_size == 0 || own.cluster_size(i) > against.cluster_size) continue;
        const std::optional<SatelliteId> true_owner = owner(record, all);
        const bool outnumbered = own.cluster_size(i) < against.cluster_size;
        const bool outed = true_owner && !owner(own.record(against.record), all);
        if (outnumbered || outed) found[&record] = foreign_sentence(record, against.distance, true_owner);
    }
}

}  // namespace

std::vector<DroppedRecord> drop_foreign_records(std::vector<KeplerEphemeris>& records) {
    std::map<SatelliteId, std::vector<const KeplerEphemeris*>> satellites;
    for (const KeplerEphemeris& r : records)
        satellites[r.satellite].push_back(&r);

    std::map<const KeplerEphemeris*, std::string> found;
    for (const auto& [satellite, own] : satellites)
        find_foreign(Clusters(own), satellites, found);

    std::vector<DroppedRecord> dropped;
    std::vector<KeplerEphemeris> kept;
    for (const KeplerEphemeris& r : records) {
        const auto reason = found.find(&r);
        if (reason == found.end())
            kept.push_back(r);
        else
            dropped.push_back({r, reason->second});
    }
    if (!dropped.empty()) records = std::move(kept);
    return dropped;
}

}  // namespace skyloop
