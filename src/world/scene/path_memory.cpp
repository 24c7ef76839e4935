#include "detail/path_memory.hpp"

#include <algorithm>

namespace skyloop {

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

}  // namespace skyloop
