#include "receiver/pvt/satellite_choice.hpp"

#include <algorithm>
#include <chrono>
#include <functional>
#include <vector>

#include "world/gnss/signal.hpp"

namespace skyloop::inline receiver {

namespace {
constexpr std::chrono::seconds forgotten{5};  // a satellite that was away, or all of them, for longer
}

void SatelliteChoice::begin(const Observations& observations) {
    constexpr std::size_t needed = 4;
    if (observations.receive_time - now_ > forgotten) solved_ = false;
    now_ = observations.receive_time;
    from_ = parameters_.from;
    std::vector<double> strengths;
    for (const Observation& o : observations.signals)
        if (o.pseudorange && o.signal == first_signal(o.satellite.constellation)) strengths.push_back(o.cn0.value());
    if (strengths.size() < needed) return;
    std::nth_element(strengths.begin(), strengths.begin() + (needed - 1), strengths.end(), std::greater<>());
    from_ = std::max(from_, DbHz(strengths[needed - 1] - parameters_.within.value()));
}

bool SatelliteChoice::takes(const Observation& first) {
    const auto [place, is_new] = candidates_.try_emplace(first.satellite, Candidate{now_, now_, false});
    Candidate& candidate = place->second;
    if (!is_new && now_ - candidate.seen > forgotten) candidate = {now_, now_, false};
    candidate.seen = now_;
    const bool waited = !solved_ || difference(now_, candidate.since) >= parameters_.after;
    candidate.used =
        candidate.used ? first.cn0 >= from_ - DbHz(parameters_.hysteresis.value()) : first.cn0 >= from_ && waited;
    return candidate.used;
}

}  // namespace skyloop::inline receiver
