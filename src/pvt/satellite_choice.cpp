#include "satellite_choice.hpp"

#include <algorithm>
#include <map>
#include <utility>
#include <vector>

namespace skyloop {

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

}  // namespace skyloop
