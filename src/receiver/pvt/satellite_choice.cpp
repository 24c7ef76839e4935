#include "detail/satellite_choice.hpp"

#include <algorithm>
#include <iterator>

namespace skyloop {
namespace {

constexpr double soundest_pdop = 6;  // up to which a geometry is sound; ours

bool touched_by_ionosphere(const RangeEquation& e) { return e.carrier > Hertz(0); }

}  // namespace

bool keep_strongest(const SinglePoint& point, std::size_t most, std::vector<RangeEquation>& equations,
                    std::vector<const Observation*>& observations) {
    std::vector<std::size_t> used;
    for (std::size_t i = 0; i < point.ranges.size(); ++i)
        if (point.ranges[i].used) used.push_back(i);
    if (most == 0 || used.size() <= most) return false;
    std::stable_sort(used.begin(), used.end(),
                     [&](std::size_t a, std::size_t b) { return observations[a]->cn0 > observations[b]->cn0; });
    used.resize(most);
    std::sort(used.begin(), used.end());
    for (std::size_t i = 0; i < most; ++i) {
        equations[i] = equations[used[i]];
        observations[i] = observations[used[i]];
    }
    equations.resize(most);
    observations.resize(most);
    return true;
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
