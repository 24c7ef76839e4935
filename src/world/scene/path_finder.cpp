// Paths by sequences of planes: those that were paths a moment ago, and new ones.
#include "world/scene/path_finder.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/time/gps_time.hpp"
#include "detail/path_refiner.hpp"
#include "detail/path_search.hpp"

namespace skyloop::inline world {

/// A path that is lost behind an edge is likely to come back: it is kept dormant for a while and tried again each
/// epoch, which costs a microsecond.
class PathMemory {
public:
    explicit PathMemory(double seconds) : seconds_(seconds) {}

    /// A path found for an instant.
    void add(const SatelliteSequence& path, GpsTime when);
    /// Forgets what is older than remembered, or from the future.
    void forget_old(GpsTime now);
    /// Proposes all that belongs to a target.
    void propose_to(PathRefiner& refiner, std::span<const SearchTarget> targets);
    /// Paths that hold now; those of before that do not stay dormant.
    void update(std::span<const FoundPath> paths, std::span<const SearchTarget> targets, GpsTime now);
    /// Marks all that is remembered, so that a search need not try it.
    void mark(KeySet& tried) const;
    [[nodiscard]] std::size_t size() const { return entries_.size(); }

private:
    struct Entry {
        SatelliteSequence path;
        std::uint64_t key = 0;
        GpsTime last;  ///< when it was a path
    };
    double seconds_;
    std::vector<Entry> entries_, next_;
    KeySet keys_;
    std::vector<std::pair<SatelliteId, std::uint32_t>> places_;  ///< of targets, by satellite
};

void PathMemory::add(const SatelliteSequence& path, GpsTime when) {
    entries_.push_back({path, sequence_key(path.id, planes_of(path.planes)), when});
}

void PathMemory::forget_old(GpsTime now) {
    std::erase_if(entries_, [this, now](const Entry& entry) {
        const double age = difference(now, entry.last).value();
        return !(age >= 0 && age <= seconds_);
    });
}

void PathMemory::propose_to(PathRefiner& refiner, std::span<const SearchTarget> targets) {
    places_.clear();
    for (std::uint32_t i = 0; i < targets.size(); ++i)
        places_.emplace_back(targets[i].id, i);
    std::sort(places_.begin(), places_.end());
    for (const Entry& entry : entries_) {
        const auto place = std::lower_bound(places_.begin(), places_.end(), std::pair(entry.path.id, 0U));
        if (place != places_.end() && place->first == entry.path.id)
            refiner.propose(place->second, planes_of(entry.path.planes));
    }
}

void PathMemory::update(std::span<const FoundPath> paths, std::span<const SearchTarget> targets, GpsTime now) {
    next_.clear();
    keys_.clear();
    for (const FoundPath& path : paths) {
        const SatelliteId id = targets[path.target].id;
        const std::uint64_t key = sequence_key(id, planes_of(path.planes));
        if (keys_.insert(key)) next_.push_back({{id, path.planes}, key, now});
    }
    for (const Entry& entry : entries_)
        if (keys_.insert(entry.key)) next_.push_back(entry);
    entries_.swap(next_);
}

void PathMemory::mark(KeySet& tried) const {
    for (const Entry& entry : entries_)
        tried.insert(entry.key);
}

namespace {

// Beyond this distance between where was searched and where the antenna is, another search does not wait, m.
constexpr double jump = 50;
// An antenna that moves less than this since a search of all rays is at the same place, m.
constexpr double still = 0.01;

Eigen::Vector3d finite_or_zero(const Eigen::Vector3d& vector) {
    return vector.allFinite() ? vector : Eigen::Vector3d::Zero();
}

}  // namespace

int default_rays(double epochs_per_second) {
    constexpr double most = 65536, at_25 = 16384, fewest = 2048;
    if (!(epochs_per_second > 10)) return static_cast<int>(most);
    // A search costs less than in proportion to its rays: the power of the rate that leads from 10 to 25 Hz.
    const double power = std::log(at_25 / most) / std::log(10.0 / 25);
    return static_cast<int>(std::lround(std::max(fewest, most * std::pow(10 / epochs_per_second, power))));
}

struct PathFinder::Parts {
    Parts(std::shared_ptr<const UrbanScene> city, const PathSearchSettings& how)
        : scene(std::move(city)),
          settings(how),
          memory(how.cache_seconds),
          refiner(*scene, how),
          search(*scene, how, static_cast<std::size_t>(std::max(1, how.threads))),
          crew(how.threads) {}

    void discover(const SceneObserver& observer, std::span<const SceneSatellite> satellites);
    void take_found(GpsTime now);
    void begin_search(const Eigen::Vector3d& place, std::span<const SceneSatellite> satellites, double ahead,
                      bool may_be_still);
    void search_for_next(const SceneObserver& observer, std::span<const SceneSatellite> satellites);
    std::vector<SatellitePaths> results(const SceneObserver& observer, std::span<const SceneSatellite> satellites);

    std::shared_ptr<const UrbanScene> scene;
    PathSearchSettings settings;
    PathSearchCounters counters;
    PathMemory memory;
    SightLines sight;
    std::vector<SearchTarget> targets;
    std::vector<FoundPath> paths;
    PathRefiner refiner;

    PathSearch search;  ///< the crew's while `searching`
    bool searching = false;
    std::uint64_t searches = 0;
    Eigen::Vector3d searched = Eigen::Vector3d::Zero();  ///< place of the last search
    std::optional<Eigen::Vector3d> searched_fully;       ///< place of the last search of all rays
    std::optional<GpsTime> last_epoch;
    double interval = 0;  ///< since the epoch before, s; 0: not known, or too long to look ahead so far

    SearchCrew crew;  ///< last: its end waits for the search
};

PathFinder::PathFinder(std::shared_ptr<const UrbanScene> scene, const PathSearchSettings& settings)
    : parts_(std::make_unique<Parts>(std::move(scene), settings)) {}
PathFinder::~PathFinder() = default;
PathFinder::PathFinder(PathFinder&&) noexcept = default;
PathFinder& PathFinder::operator=(PathFinder&&) noexcept = default;

const UrbanScene& PathFinder::scene() const { return *parts_->scene; }
const PathSearchCounters& PathFinder::counters() const { return parts_->counters; }

std::vector<SatellitePaths> PathFinder::epoch(const SceneObserver& observer,
                                              std::span<const SceneSatellite> satellites) {
    Parts& own = *parts_;
    ++own.counters.epochs;
    own.memory.forget_old(observer.now);
    own.discover(observer, satellites);

    own.sight.look(*own.scene, observer.position, satellites);
    own.sight.collect_targets(satellites, own.settings.blocked_only, own.targets);
    own.refiner.begin(observer.position, own.targets);
    own.memory.propose_to(own.refiner, own.targets);
    own.paths.clear();
    own.refiner.settle(own.paths);
    order_paths(own.paths);
    own.counters.segments += own.refiner.segments();
    own.counters.candidates += own.refiner.candidates();
    own.counters.accepted += own.paths.size();
    own.memory.update(own.paths, own.targets, observer.now);

    std::vector<SatellitePaths> answer = own.results(observer, satellites);
    // Without an interval it is not known how far ahead, and the next epoch searches on the spot.
    if (own.settings.search_ahead && own.interval > 0) own.search_for_next(observer, satellites);
    return answer;
}

// What was searched for this epoch, or, where nothing was or for another place, a search at once.
void PathFinder::Parts::discover(const SceneObserver& observer, std::span<const SceneSatellite> satellites) {
    counters.cached_last = static_cast<int>(memory.size());
    counters.rays_last = counters.found_last = 0;
    interval = last_epoch ? difference(observer.now, *last_epoch).value() : 0;
    if (!(interval > 0 && interval <= settings.cache_seconds)) interval = 0;
    last_epoch = observer.now;
    const bool expected = searching && interval > 0 && (observer.position - searched).norm() <= jump;
    if (searching) crew.wait();
    searching = false;
    if (!expected) {
        if (!observer.position.allFinite()) return;
        begin_search(observer.position, satellites, 0, false);
        crew.wait();
    }
    take_found(observer.now);
}

void PathFinder::Parts::take_found(GpsTime now) {
    for (const SatelliteSequence& path : search.found())
        memory.add(path, now);
    const PathSearch::Effort& effort = search.effort();
    counters.rays += effort.rays;
    counters.segments += effort.segments;
    counters.candidates += effort.candidates;
    counters.rays_last = static_cast<int>(effort.rays);
    counters.found_last = static_cast<int>(search.found().size());
}

void PathFinder::Parts::begin_search(const Eigen::Vector3d& place, std::span<const SceneSatellite> satellites,
                                     double ahead, bool may_be_still) {
    PathSearch::Request& request = search.request();
    request.antenna = place;
    request.satellites.assign(satellites.begin(), satellites.end());
    for (SceneSatellite& satellite : request.satellites)
        satellite.position += ahead * finite_or_zero(satellite.velocity);
    request.number = searches++;
    request.still = may_be_still && searched_fully && (place - *searched_fully).norm() < still;
    if (!request.still) searched_fully = place;
    searched = place;
    search.known().clear();
    memory.mark(search.known());
    crew.start([this] { search.run(crew); });
}

// Searches where the antenna and the satellites will be in the next epoch if they go on as they do.
void PathFinder::Parts::search_for_next(const SceneObserver& observer, std::span<const SceneSatellite> satellites) {
    const Eigen::Vector3d place = observer.position + interval * finite_or_zero(observer.velocity);
    if (!place.allFinite()) return;
    begin_search(place, satellites, interval, true);
    searching = true;
}

std::vector<SatellitePaths> PathFinder::Parts::results(const SceneObserver& observer,
                                                       std::span<const SceneSatellite> satellites) {
    std::vector<SatellitePaths> answer(satellites.size());
    for (std::size_t i = 0; i < satellites.size(); ++i) {
        answer[i].id = satellites[i].id;
        answer[i].line_of_sight = sight.seen(i);
    }
    const Eigen::Vector3d velocity = finite_or_zero(observer.velocity);
    for (const FoundPath& path : paths) {
        const SearchTarget& target = targets[path.target];
        const Eigen::Vector3d satellite_velocity = finite_or_zero(satellites[target.satellite].velocity);
        const UnfoldedPath& way = path.unfolded;
        const double rate = excess_growth({way.arrival, way.departure, target.direction}, velocity, satellite_velocity);
        answer[target.satellite].paths.push_back({path.planes, way.arrival, way.excess, rate});
    }
    return answer;
}

}  // namespace skyloop::inline world
