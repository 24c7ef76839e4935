#include "receiver/pvt/moving_pair.hpp"

#include <algorithm>
#include <chrono>

namespace skyloop::inline receiver {
namespace {

constexpr Seconds pair_memory{3}, type_memory{10};
// Both clocks show the same instant to better than this (they are kept within half of it).
constexpr std::chrono::milliseconds same_instant{1};

}  // namespace

void MovingPair::remember(GpsTime time, const Observations& observations, const std::set<SatelliteId>& usable,
                          const Position<Ecef>& place) {
    epochs_.push_back({time, observations, usable, place});
    while (difference(time, epochs_.front().time) > pair_memory)
        epochs_.pop_front();
}

std::optional<RelativePosition> MovingPair::solve(const ReferenceStation& base, TransmitterSource& transmitters) {
    const GpsTime then = base.epoch.time;
    if (!base.position || epochs_.empty() || (solved_ && then <= *solved_)) return std::nullopt;
    const auto own = std::ranges::find_if(epochs_, [&](const Remembered& epoch) {
        return epoch.time >= then - same_instant && epoch.time <= then + same_instant;
    });
    if (own == epochs_.end()) return std::nullopt;
    solved_ = then;
    type_.reset();
    const auto solution =
        solver_.solve({own->time, own->observations, base, own->place, own->usable, true}, transmitters);
    if (!solution) return std::nullopt;
    type_ = solution->fixed ? FixType::rtk_fixed : FixType::rtk_float;
    RelativePosition relative = relative_position(*solution, base);
    relative.age = difference(epochs_.back().time, then);
    return relative;
}

std::optional<FixType> MovingPair::type_at(GpsTime time) const {
    return solved_ && difference(time, *solved_) <= type_memory ? type_ : std::nullopt;
}

void MovingPair::reset() {
    solver_.reset();
    epochs_.clear();
    solved_.reset();
    type_.reset();
}

}  // namespace skyloop::inline receiver
