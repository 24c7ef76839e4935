#include "satellite_choice.hpp"

#include <algorithm>
#include <iterator>
#include <map>
#include <utility>
#include <vector>

namespace skyloop {
namespace {

constexpr double soundest_pdop = 6;  // up to which a geometry is sound; ours

bool touched_by_ionosphere(const RangeEquation& e) { return e.carrier > Hertz(0); }

}  // namespace

void keep_strongest(Observations& observations, const ReceiverSettings& settings) {
    std::map<SatelliteId, DbHz> strengths;
    for (const Observation& o : observations.signals) {
        if (!o.pseudorange || o.cn0 < settings.minimum_cn0) continue;
        const auto [place, is_new] = strengths.try_emplace(o.satellite, o.cn0);
        if (!is_new) place->second = std::max(place->second, o.cn0);
    }
    if (strengths.size() <= settings.most_satellites) return;
    std::vector<std::pair<SatelliteId, DbHz>> ranking(strengths.begin(), strengths.end());
    std::stable_sort(ranking.begin(), ranking.end(), [](const auto& a, const auto& b) { return a.second > b.second; });
    for (std::size_t i = settings.most_satellites; i < ranking.size(); ++i)
        for (Observation& o : observations.signals)
            if (o.satellite == ranking[i].first) o.pseudorange.reset();
}

std::optional<CheckedSolution> solve_free_of_ionosphere(IntegrityMonitor& monitor, std::span<RangeEquation> equations,
                                                        const SinglePointSetup& setup) {
    const auto touched = std::count_if(equations.begin(), equations.end(), touched_by_ionosphere);
    if (touched == 0 || touched == std::ssize(equations)) return monitor.solve(equations, setup);
    for (RangeEquation& e : equations)
        e.excluded = touched_by_ionosphere(e);
    std::optional<CheckedSolution> checked = monitor.solve(equations, setup);
    if (checked && checked->solution.redundancy >= 1 && checked->solution.dop.pdop <= soundest_pdop) return checked;
    for (RangeEquation& e : equations)
        e.excluded = false;
    return monitor.solve(equations, setup);
}

}  // namespace skyloop
