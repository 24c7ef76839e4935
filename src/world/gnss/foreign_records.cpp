#include "world/gnss/foreign_records.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>

#include "base/time/utc_time.hpp"
#include "world/gnss/orbit.hpp"

namespace skyloop::inline world {
namespace {

// Records further apart are not compared: extrapolated for half of it, a good orbit is still right within tens of
// kilometres.
constexpr std::chrono::hours comparable_span{12};
// The simplified equations of motion of GLONASS hold for half an hour, and within 1 km for an hour.
constexpr std::chrono::hours comparable_span_glonass{2};
// How many records before and after are compared; enough to look past several foreign ones in a row.
constexpr std::size_t comparable_records = 6;
// Two satellites of one plane are kept apart by more, broadcast records of one satellite agree far better.
constexpr double same_orbit_m = 100e3;

double distance_between(const Ephemeris& a, const Ephemeris& b) {
    const GpsTime middle = toe_of(a) + (toe_of(b) - toe_of(a)) / 2;
    return (satellite_state(a, middle).position - satellite_state(b, middle).position).length().value();
}

bool comparable(const Ephemeris& a, const Ephemeris& b) {
    const bool glonass = std::holds_alternative<GlonassEphemeris>(a) || std::holds_alternative<GlonassEphemeris>(b);
    return std::chrono::abs(toe_of(a) - toe_of(b)) <= (glonass ? comparable_span_glonass : comparable_span);
}

// The records of one satellite in time order, joined to clusters of records that agree, directly or through others. A
// manoeuvre changes the orbit little from one record to the next, so it does not part a cluster.
class Clusters {
public:
    explicit Clusters(std::vector<const Ephemeris*> records) : records_(std::move(records)) {
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
    [[nodiscard]] const Ephemeris& record(std::size_t i) const { return *records_[i]; }
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
        const auto apart = [&](std::size_t k) { return std::chrono::abs(toe_of(*records_[i]) - toe_of(*records_[k])); };
        if (size > worst.cluster_size || (size == worst.cluster_size && apart(j) < apart(worst.record)))
            worst = {size, j, distance};
    }

    std::vector<const Ephemeris*> records_;
    std::vector<std::size_t> parent_;  // after construction: the root of each record's cluster
    std::vector<std::size_t> size_;
};

// Records of each satellite, ascending by toe.
using RecordsBySatellite = std::map<SatelliteId, std::vector<const Ephemeris*>>;

const Ephemeris& nearest_record(const std::vector<const Ephemeris*>& records, GpsTime time) {
    const auto next = std::lower_bound(records.begin(), records.end(), time,
                                       [](const Ephemeris* r, GpsTime t) { return toe_of(*r) < t; });
    if (next == records.end()) return *records.back();
    if (next == records.begin() || toe_of(**next) - time < time - toe_of(**(next - 1))) return **next;
    return **(next - 1);
}

// The satellite, other than its own, whose orbit the record describes.
std::optional<SatelliteId> owner(const Ephemeris& record, const RecordsBySatellite& all) {
    std::optional<SatelliteId> nearest;
    double smallest = same_orbit_m;
    for (const auto& [satellite, records] : all) {
        const Ephemeris& other = nearest_record(records, toe_of(record));
        if (satellite == satellite_of(record) || !comparable(record, other)) continue;
        const double distance = distance_between(record, other);
        if (distance >= smallest) continue;
        smallest = distance;
        nearest = satellite;
    }
    return nearest;
}

std::string foreign_sentence(const Ephemeris& record, double distance, std::optional<SatelliteId> true_owner) {
    std::string toe = format_utc(gps_calendar(toe_of(record)), 0);
    toe.pop_back();  // GPS time carries no Z
    return fmt::format("{}: record with toe {} lies {:.0f} km from its neighbours{}; dropped",
                       to_string(satellite_of(record)), toe, distance / 1e3,
                       true_owner ? fmt::format(" (it is the orbit of {})", to_string(*true_owner)) : "");
}

// The foreign records among those of one satellite.
void find_foreign(const Clusters& own, const RecordsBySatellite& all, std::map<const Ephemeris*, std::string>& found) {
    const std::vector<Clusters::Contradiction> contradictions = own.contradictions();
    for (std::size_t i = 0; i < own.size(); ++i) {
        const Ephemeris& record = own.record(i);
        const Clusters::Contradiction& against = contradictions[i];
        if (!is_healthy(record) || against.cluster_size == 0 || own.cluster_size(i) > against.cluster_size) continue;
        const std::optional<SatelliteId> true_owner = owner(record, all);
        const bool outnumbered = own.cluster_size(i) < against.cluster_size;
        const bool outed = true_owner && !owner(own.record(against.record), all);
        if (outnumbered || outed) found[&record] = foreign_sentence(record, against.distance, true_owner);
    }
}

}  // namespace

std::vector<DroppedRecord> drop_foreign_records(std::vector<Ephemeris>& records) {
    std::map<SatelliteId, std::vector<const Ephemeris*>> satellites;
    for (const Ephemeris& r : records)
        if (message_of(r) != NavigationMessage::sbas && message_of(r) != NavigationMessage::almanac)
            satellites[satellite_of(r)].push_back(&r);
    // Files of one system are in the order of time; merged ones need not be.
    for (auto& [satellite, own] : satellites)
        std::stable_sort(own.begin(), own.end(),
                         [](const Ephemeris* a, const Ephemeris* b) { return toe_of(*a) < toe_of(*b); });

    std::map<const Ephemeris*, std::string> found;
    for (const auto& [satellite, own] : satellites)
        find_foreign(Clusters(own), satellites, found);

    std::vector<DroppedRecord> dropped;
    std::vector<Ephemeris> kept;
    for (const Ephemeris& r : records) {
        const auto reason = found.find(&r);
        if (reason == found.end())
            kept.push_back(r);
        else
            dropped.push_back({r, reason->second});
    }
    if (!dropped.empty()) records = std::move(kept);
    return dropped;
}

}  // namespace skyloop::inline world
