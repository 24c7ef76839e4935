#include "receiver/pvt/integrity.hpp"

#include <boost/math/special_functions/gamma.hpp>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

namespace skyloop::inline receiver {
namespace {

// The equation with the largest normalised residual, of those that a residual can accuse.
std::optional<std::size_t> most_suspect(const SinglePoint& solution) {
    std::optional<std::size_t> worst;
    double largest = 0;
    for (std::size_t i = 0; i < solution.ranges.size(); ++i) {
        const RangeOutcome& r = solution.ranges[i];
        const double left = r.variance - r.cofactor;
        // A range that alone carries an unknown fits whatever it says.
        if (!r.used || left < 1e-6 * r.variance) continue;
        const double normalised = r.residual.value() * r.residual.value() / left;
        if (normalised > largest) {
            largest = normalised;
            worst = i;
        }
    }
    return worst;
}

}  // namespace

double chi_square_threshold(int degrees, double probability) {
    return 2 * boost::math::gamma_q_inv(degrees / 2.0, probability);
}

IntegrityMonitor::IntegrityMonitor(const IntegrityParameters& parameters) : parameters_(parameters) {}

double IntegrityMonitor::threshold(int degrees) {
    const auto wanted = static_cast<std::size_t>(degrees);
    while (thresholds_.size() <= wanted) {
        const int next = static_cast<int>(thresholds_.size());
        thresholds_.push_back(next == 0 ? 0 : chi_square_threshold(next, parameters_.false_alarm));
    }
    return thresholds_[wanted];
}

std::optional<CheckedSolution> IntegrityMonitor::solve(std::span<RangeEquation> equations,
                                                       const SinglePointSetup& setup) {
    std::optional<SinglePoint> solution = solve_single_point(equations, setup);
    if (!solution) return std::nullopt;
    CheckedSolution checked{std::move(*solution), {}, {}};
    if (checked.solution.redundancy > 0)
        checked.test.of_all = std::sqrt(checked.solution.statistic / checked.solution.redundancy);
    if (!parameters_.enabled) return checked;
    SinglePointSetup again = setup;
    const auto fits = [this](const SinglePoint& s) {
        return s.redundancy < 1 || s.statistic <= threshold(s.redundancy);
    };
    for (int n = 0; n < parameters_.most_exclusions && !fits(checked.solution); ++n) {
        // One degree of freedom tells that something is wrong, not what.
        if (checked.solution.redundancy < 2) break;
        const std::optional<std::size_t> suspect = most_suspect(checked.solution);
        if (!suspect) break;
        equations[*suspect].excluded = true;
        again.start = checked.solution.position;
        std::optional<SinglePoint> without = solve_single_point(equations, again);
        if (!without) {
            equations[*suspect].excluded = false;
            break;
        }
        checked.excluded.push_back(equations[*suspect].satellite);
        checked.solution = std::move(*without);
    }
    checked.test.consistent = fits(checked.solution);
    return checked;
}

namespace {

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

}  // namespace skyloop::inline receiver
