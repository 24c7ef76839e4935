#include "campaigns/campaign_report/parameter_levels.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "base/core/number_in.hpp"
#include "detail/shown_text.hpp"

namespace skyloop {
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

}  // namespace skyloop
