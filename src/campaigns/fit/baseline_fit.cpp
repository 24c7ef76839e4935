#include "campaigns/fit/baseline_fit.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include "study/analysis/fix_series.hpp"

namespace skyloop::inline campaigns {
namespace {

// A proportion of the fractions: tan of it is tropo over iono.
struct Proportion {
    double degrees = 0;
    [[nodiscard]] BaselineFractions of_size(double size) const {
        const double radians = degrees * std::numbers::pi / 180;
        return {size * std::cos(radians), size * std::sin(radians)};
    }
    [[nodiscard]] double largest_size() const {
        const BaselineFractions unit = of_size(1);
        return largest_fraction / std::max(unit.iono, unit.tropo);
    }
};

Proportion calibrated_proportion() {
    const BaselineFractions preset = BaselineFractions::calibrated();
    return {std::atan2(preset.tropo, preset.iono) * 180 / std::numbers::pi};
}

struct Candidate {
    Proportion proportion;
    double size = 0, difference = 0;
    bool at_limit = false;
};

double percent_between(const RunningStatistics& candidate, double size, const SampleStatistics& real) {
    SampleStatistics scaled;
    scaled.n = candidate.n();
    scaled.mean = size * candidate.mean();
    scaled.std = size * candidate.std();
    return comparison_percent(scaled, real)->difference;
}

// The measure is linear between the sizes at which the mean or the deviation meets the receiver's.
Candidate best_of(const BaselineRun& run, const SampleStatistics& real, Proportion proportion) {
    RunningStatistics unit;
    for (const double value : run.horizontal_with(proportion.of_size(1)))
        unit.add(value);
    Candidate best{proportion, 0, percent_between(unit, 0, real), false};
    for (const double met : {real.mean / unit.mean(), real.std / unit.std()}) {
        if (!std::isfinite(met)) continue;
        const double size = std::min(met, proportion.largest_size());
        const double difference = percent_between(unit, size, real);
        if (difference < best.difference) best = {proportion, size, difference, size < met};
    }
    return best;
}

// Nearer to the receiver, or as near and nearer to what is expected of one.
bool is_better(const Candidate& a, const Candidate& b) {
    constexpr double alike_percent = 0.01;
    if (std::abs(a.difference - b.difference) > alike_percent) return a.difference < b.difference;
    const double expected = calibrated_proportion().degrees;
    return std::abs(a.proportion.degrees - expected) < std::abs(b.proportion.degrees - expected);
}

std::vector<Candidate> scan(const BaselineRun& run, const SampleStatistics& real, Proportion from, Proportion to) {
    constexpr int steps = 180;
    std::vector<Candidate> found;
    for (int i = 0; i <= steps; ++i)
        found.push_back(best_of(run, real, {from.degrees + (to.degrees - from.degrees) * i / steps}));
    return found;
}

// Around each dip of the coarse scan a fine one.
Candidate best_of_all(const BaselineRun& run, const SampleStatistics& real) {
    constexpr double least = 0, most = 90;  // degrees
    const std::vector<Candidate> coarse = scan(run, real, {least}, {most});
    std::optional<Candidate> best;
    for (std::size_t i = 0; i < coarse.size(); ++i) {
        const Candidate& before = coarse[i == 0 ? 0 : i - 1];
        const Candidate& after = coarse[std::min(i + 1, coarse.size() - 1)];
        if (coarse[i].difference > std::min(before.difference, after.difference)) continue;
        for (const Candidate& next : scan(run, real, before.proportion, after.proportion))
            if (!best || is_better(next, *best)) best = next;
    }
    return *best;  // the least of all is a dip
}

// Of the larger one, as the scenario has them.
BaselineFractions with_six_digits(const BaselineFractions& exact) {
    const double larger = std::max(exact.iono, exact.tropo);
    if (!(larger > 0)) return {};
    const double unit = std::pow(10, std::floor(std::log10(larger)) - 5);
    return {std::round(exact.iono / unit) * unit, std::round(exact.tropo / unit) * unit};
}

}  // namespace

BaselineFit fit_fractions(const BaselineRun& run, const SampleStatistics& real) {
    const Candidate best = best_of_all(run, real);
    BaselineFit fit;
    fit.fractions = with_six_digits(best.proportion.of_size(best.size));
    RunningStatistics errors;
    for (const double value : run.horizontal_with(fit.fractions))
        errors.add(value);
    fit.difference = percent_between(errors, 1, real);
    fit.at_limit = best.at_limit;
    return fit;
}

}  // namespace skyloop::inline campaigns
