#include "campaigns/campaign_report/campaign_summary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>

#include "base/core/number_text.hpp"
#include "detail/shown_names.hpp"
#include "study/analysis/statistics.hpp"

namespace skyloop::inline campaigns {
namespace {

constexpr std::size_t longest_label = 32;

std::optional<double> whole_number_text(const std::string& text) {
    const auto number = number_in<double>(text);
    return number && std::abs(*number) <= largest_reported_number ? number : std::nullopt;
}

// The numbers of all runs, or nothing when a value is none.
std::optional<std::vector<double>> numbers_of(const ReportedParameter& parameter) {
    std::vector<double> numbers;
    bool any = false;
    for (const auto& value : parameter.values) {
        numbers.push_back(std::numeric_limits<double>::quiet_NaN());
        if (!value) continue;
        const auto number = whole_number_text(*value);
        if (!number) return std::nullopt;
        numbers.back() = *number;
        any = true;
    }
    if (!any) return std::nullopt;
    return numbers;
}

std::string range_label(double low, double high) {
    return low == high ? fmt::format("{:.6g}", low) : fmt::format("{:.3g} … {:.3g}", low, high);
}

// Where the bins end: the last number of each, so that equal numbers share one.
std::vector<double> bin_ends(std::vector<double> sorted) {
    std::vector<double> ends;
    for (std::size_t bin = 1; bin <= number_bins; ++bin) {
        const double end = sorted[bin * sorted.size() / number_bins - 1];
        if (ends.empty() || end > ends.back()) ends.push_back(end);
    }
    return ends;
}

void take_numbers(ParameterLevels& result) {
    std::vector<double> sorted;
    for (const double number : result.numbers)
        if (!std::isnan(number)) sorted.push_back(number);
    std::sort(sorted.begin(), sorted.end());
    std::vector<double> distinct = sorted;
    distinct.erase(std::unique(distinct.begin(), distinct.end()), distinct.end());
    result.distinct = distinct.size();
    result.binned = distinct.size() > most_number_levels;
    const std::vector<double> ends = result.binned ? bin_ends(sorted) : distinct;
    result.levels.resize(ends.size());
    for (std::size_t run = 0; run < result.numbers.size(); ++run) {
        const double number = result.numbers[run];
        if (std::isnan(number)) continue;
        const auto place = static_cast<std::size_t>(std::lower_bound(ends.begin(), ends.end(), number) - ends.begin());
        ParameterLevel& level = result.levels[place];
        level.low = level.runs == 0 ? number : std::min(level.low, number);
        level.high = level.runs == 0 ? number : std::max(level.high, number);
        ++level.runs;
        result.of_run[run] = place;
    }
    for (ParameterLevel& level : result.levels)
        level.label = range_label(level.low, level.high);
}

void take_words(ParameterLevels& result, const ReportedParameter& parameter) {
    std::map<std::string, std::size_t> counts;
    for (const auto& value : parameter.values)
        if (value) ++counts[*value];
    result.distinct = counts.size();
    std::vector<std::pair<std::string, std::size_t>> shown(counts.begin(), counts.end());
    std::stable_sort(shown.begin(), shown.end(), [](const auto& a, const auto& b) { return a.second > b.second; });
    shown.resize(std::min(shown.size(), most_word_levels));
    std::sort(shown.begin(), shown.end());
    std::map<std::string, std::size_t> places;
    for (const auto& [word, runs] : shown) {
        places.emplace(word, result.levels.size());
        result.levels.push_back({word.empty() ? "(empty)" : shown_text(word, longest_label), 0, 0, runs});
    }
    for (std::size_t run = 0; run < parameter.values.size(); ++run) {
        if (!parameter.values[run]) continue;
        const auto found = places.find(*parameter.values[run]);
        if (found == places.end())
            ++result.not_shown;
        else
            result.of_run[run] = found->second;
    }
}

}  // namespace

ParameterLevels levels_of(const ReportedParameter& parameter) {
    ParameterLevels result;
    result.of_run.assign(parameter.values.size(), ParameterLevels::none);
    if (auto numbers = numbers_of(parameter)) {
        result.numeric = true;
        result.numbers = std::move(*numbers);
        take_numbers(result);
    } else {
        result.numbers.assign(parameter.values.size(), std::numeric_limits<double>::quiet_NaN());
        take_words(result, parameter);
    }
    return result;
}

namespace {

constexpr double strong_effect = 0.6;
constexpr double clear_effect = 0.3;

bool came_to_an_end(const GatheredRun& run) { return run.status != RunStatus::error; }

bool usable(double value) { return std::abs(value) <= largest_reported_number; }

// What a metric or a verdict gave in the runs that have it.
struct Outcomes {
    std::vector<std::size_t> runs;
    std::vector<double> values;
};

// The tests of one parameter against some outcomes; what they mean is judged when their number is known.
Effect tested(const Outcomes& outcomes, const ParameterLevels& levels) {
    Effect effect;
    std::vector<double> numbers, of_numbers, of_levels;
    std::vector<std::size_t> groups;
    for (std::size_t i = 0; i < outcomes.runs.size(); ++i) {
        const std::size_t run = outcomes.runs[i];
        if (!std::isnan(levels.numbers[run])) {
            numbers.push_back(levels.numbers[run]);
            of_numbers.push_back(outcomes.values[i]);
        }
        if (levels.of_run[run] != ParameterLevels::none) {
            groups.push_back(levels.of_run[run]);
            of_levels.push_back(outcomes.values[i]);
        }
    }
    if (groups.size() < fewest_runs_for_effects) {
        effect.kind = Effect::Kind::too_few;
        return effect;
    }
    effect.trend = spearman_correlation(numbers, of_numbers);
    effect.levels = kruskal_wallis_test(of_levels, groups);
    if (!effect.trend && !effect.levels) effect.kind = Effect::Kind::constant;
    return effect;
}

std::vector<Effect> tested_all(const Outcomes& outcomes, const std::vector<ParameterLevels>& levels) {
    std::vector<Effect> effects;
    for (std::size_t i = 0; i < levels.size(); ++i) {
        effects.push_back(tested(outcomes, levels[i]));
        effects.back().parameter = i;
    }
    return effects;
}

std::size_t tests_of(const Effect& effect) { return (effect.trend ? 1U : 0U) + (effect.levels ? 1U : 0U); }

void judge(Effect& effect, double bound) {
    if (effect.trend && effect.trend->p_value < bound) {
        effect.kind = effect.trend->rho > 0 ? Effect::Kind::rising : Effect::Kind::falling;
        effect.strength = std::abs(effect.trend->rho);
    } else if (effect.levels && effect.levels->p_value < bound) {
        effect.kind = Effect::Kind::differing;
        effect.strength = std::sqrt(effect.levels->strength);
    }
}

void judge_effects(CampaignSummary& summary) {
    std::vector<Effect*> effects;
    for (MetricSummary& metric : summary.metrics)
        for (Effect& effect : metric.effects)
            effects.push_back(&effect);
    for (VerdictSummary& verdict : summary.verdicts)
        for (Effect& effect : verdict.effects)
            effects.push_back(&effect);
    for (const Effect* effect : effects)
        summary.tests += tests_of(*effect);
    const double bound = report_false_alarm / static_cast<double>(std::max<std::size_t>(summary.tests, 1));
    for (Effect* effect : effects)
        judge(*effect, bound);
}

// The worst first; of equal ones the first in the plan.
std::vector<std::size_t> worst_runs(const Outcomes& outcomes, WorstEnd end, std::size_t count) {
    std::vector<std::size_t> order(outcomes.runs.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    const auto badness = [&](std::size_t i) {
        const double value = outcomes.values[i];
        return end == WorstEnd::smallest ? -value : end == WorstEnd::largest ? value : std::abs(value);
    };
    const auto worse = [&](std::size_t a, std::size_t b) {
        return badness(a) != badness(b) ? badness(a) > badness(b) : a < b;
    };
    const std::size_t kept = std::min(count, order.size());
    std::partial_sort(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(kept), order.end(), worse);
    order.resize(kept);
    for (std::size_t& place : order)
        place = outcomes.runs[place];
    return order;
}

void take_statistics(MetricSummary& summary, const std::vector<double>& values) {
    const auto statistics = sample_statistics(values);
    if (!statistics) return;
    summary.sorted = values;
    std::sort(summary.sorted.begin(), summary.sorted.end());
    // Rounding must not put the mean of equal values beside them.
    summary.mean = std::clamp(statistics->mean, statistics->min, statistics->max);
    if (statistics->n > 1) summary.sd = statistics->min == statistics->max ? 0 : statistics->std;
    for (const double share : reported_shares)
        summary.percentiles.push_back(
            {share, sorted_quantile(summary.sorted, share), percentile_interval(summary.sorted, share)});
}

MetricSummary metric_summary(const CampaignResults& results, std::size_t index,
                             const std::vector<ParameterLevels>& levels, std::size_t worst) {
    const ReportedMetric& metric = results.metrics[index];
    MetricSummary summary;
    summary.metric = index;
    Outcomes outcomes;
    for (std::size_t run = 0; run < results.runs.size(); ++run) {
        if (!came_to_an_end(results.runs[run])) continue;
        const double value = metric.values[run];
        if (usable(value)) {
            outcomes.runs.push_back(run);
            outcomes.values.push_back(value);
        } else {
            std::isnan(value) ? ++summary.without : ++summary.infinite;
            summary.valueless.push_back(run);
        }
    }
    take_statistics(summary, outcomes.values);
    summary.effects = tested_all(outcomes, levels);
    summary.worst_end = worst_end_of(metric.name, !summary.sorted.empty() && summary.sorted.front() < 0);
    summary.worst = worst_runs(outcomes, summary.worst_end, worst);
    return summary;
}

VerdictSummary verdict_summary(const CampaignResults& results, std::optional<std::size_t> index,
                               const std::vector<ParameterLevels>& levels) {
    VerdictSummary summary;
    summary.verdict = index;
    Outcomes outcomes;
    TrialCount count;
    std::vector<std::vector<TrialCount>> by_level;
    for (const ParameterLevels& parameter : levels)
        by_level.emplace_back(parameter.levels.size());
    for (std::size_t run = 0; run < results.runs.size(); ++run) {
        const auto passed = verdict_of(results, summary, run);
        if (!passed) {
            if (came_to_an_end(results.runs[run])) ++summary.without;
            continue;
        }
        outcomes.runs.push_back(run);
        outcomes.values.push_back(*passed ? 1 : 0);
        count.passed += *passed ? 1U : 0U;
        ++count.trials;
        for (std::size_t i = 0; i < levels.size(); ++i)
            if (const std::size_t level = levels[i].of_run[run]; level != ParameterLevels::none) {
                by_level[i][level].passed += *passed ? 1U : 0U;
                ++by_level[i][level].trials;
            }
    }
    summary.rate = rate_of(count);
    for (const auto& counts : by_level) {
        summary.by_level.emplace_back();
        for (const TrialCount& of_level : counts)
            summary.by_level.back().push_back(rate_of(of_level));
    }
    summary.effects = tested_all(outcomes, levels);
    return summary;
}

std::string strength_word(double strength) {
    return strength >= strong_effect ? "strongly" : strength >= clear_effect ? "clearly" : "slightly";
}

}  // namespace

std::string effect_words(const Effect& effect) {
    switch (effect.kind) {
        case Effect::Kind::too_few:
            return fmt::format("fewer than {} runs: nothing can be said", fewest_runs_for_effects);
        case Effect::Kind::constant:
            return "does not vary";
        case Effect::Kind::unseen:
            return "no relation seen";
        case Effect::Kind::rising:
            return fmt::format("rises {}", strength_word(effect.strength));
        case Effect::Kind::falling:
            return fmt::format("falls {}", strength_word(effect.strength));
        case Effect::Kind::differing:
            break;
    }
    return fmt::format("differs {} between values", strength_word(effect.strength));
}

std::string effect_words(const Effect& effect, std::string_view parameter) {
    const bool has_direction = effect.kind == Effect::Kind::rising || effect.kind == Effect::Kind::falling;
    return fmt::format("{} {} {}", effect_words(effect), has_direction ? "with" : "of", parameter);
}

std::optional<bool> verdict_of(const CampaignResults& results, const VerdictSummary& verdict, std::size_t run) {
    if (!came_to_an_end(results.runs[run])) return std::nullopt;
    if (verdict.verdict) return results.verdicts[*verdict.verdict].passed[run];
    return results.runs[run].status == RunStatus::passed;
}

CampaignSummary summarise(const CampaignResults& results, std::size_t worst) {
    CampaignSummary summary;
    for (std::size_t run = 0; run < results.runs.size(); ++run) {
        const RunStatus status = results.runs[run].status;
        ++(status == RunStatus::passed ? summary.passed
                                       : (status == RunStatus::failed ? summary.failed : summary.errors));
        if (status != RunStatus::passed) summary.failed_runs.push_back(run);
    }
    if (results.planned)
        summary.missing = *results.planned - std::min<std::uint64_t>(*results.planned, results.runs.size());
    for (const ReportedParameter& parameter : results.parameters)
        summary.levels.push_back(levels_of(parameter));
    summary.verdicts.push_back(verdict_summary(results, std::nullopt, summary.levels));
    for (std::size_t i = 0; i < results.verdicts.size(); ++i)
        summary.verdicts.push_back(verdict_summary(results, i, summary.levels));
    for (std::size_t i = 0; i < results.metrics.size(); ++i)
        summary.metrics.push_back(metric_summary(results, i, summary.levels, worst));
    judge_effects(summary);
    return summary;
}

}  // namespace skyloop::inline campaigns
