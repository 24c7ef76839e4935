#include "world/propagation/told_obstacles.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "world/propagation/propagation_effect.hpp"

namespace skyloop::inline world {
namespace {

using Reflection = ToldPath::Reflection;

const Angle half_turn = Angle::radians(std::numbers::pi);

double told_amplitude(Decibels strength) { return std::pow(10, strength.value() / 20); }

// The ray that is tracked, over the direct one without anything in its way.
struct TrackedRay {
    Metres excess;
    Decibels strength;
    Angle lag;
};

void add_echoes(Arrival& arrival, const TrackedRay& tracked, const Reflection* begin, const Reflection* end) {
    for (const Reflection* one = begin; one != end; ++one)
        arrival.echoes.push_back({arrival.direction, one->excess - tracked.excess, MetresPerSecond(0),
                                  told_amplitude(one->strength - tracked.strength), half_turn - tracked.lag, 1});
    arrival.paths = 1 + static_cast<int>(end - begin);
}

void arrive_as_told(Arrival& arrival, ToldPath told) {
    std::stable_sort(told.reflections.begin(), told.reflections.end(),
                     [](const Reflection& a, const Reflection& b) { return a.strength > b.strength; });
    const Reflection* first = told.reflections.begin();
    const Reflection* end = told.reflections.end();
    arrival.echoes_known = true;
    arrival.echoes.clear();
    arrival.shadowing_loss = Decibels(0);
    arrival.excess_rate = MetresPerSecond(0);
    if (told.blocked && first == end) return hide(arrival);
    arrival.line_of_sight = !told.blocked;
    arrival.reflections = told.blocked ? 1 : 0;
    arrival.excess_path = told.blocked ? first->excess : Metres(0);
    arrival.reflection_loss = told.blocked ? Decibels(0) - first->strength : Decibels(0);
    if (told.blocked) return add_echoes(arrival, {first->excess, first->strength, half_turn}, first + 1, end);
    arrival.foliage_loss += told.attenuation;
    add_echoes(arrival, {Metres(0), Decibels(0) - told.attenuation, Angle{}}, first, end);
}

}  // namespace

void ToldObstacles::apply(Arrivals& arrivals, const SkyView&, const TruthState&) {
    if (told_->empty()) return;
    for (Arrival& arrival : arrivals.satellites)
        if (const auto told = told_->find(arrival.id); told != told_->end()) arrive_as_told(arrival, told->second);
}

}  // namespace skyloop::inline world
