/// The values of a swept parameter as few groups of runs that can be compared.
#pragma once

#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include "campaigns/campaign_report/campaign_results.hpp"

namespace skyloop {

/// Numbers farther from zero than this are taken for infinite: their squares could not be added up.
inline constexpr double largest_reported_number = 1e100;

/// At most so many different numbers are levels of their own; more are put into `number_bins` of like counts.
inline constexpr std::size_t most_number_levels = 12;
inline constexpr std::size_t number_bins = 8;
/// Of words, so many levels are shown: those that most runs have.
inline constexpr std::size_t most_word_levels = 20;

/// One value, or the numbers between two.
struct ParameterLevel {
    std::string label;
    double low = 0, high = 0;  ///< the smallest and largest number in it; of words 0
    std::size_t runs = 0;
};

struct ParameterLevels {
    /// Of a run that has no value, or one that is not shown.
    static constexpr std::size_t none = std::numeric_limits<std::size_t>::max();

    bool numeric = false;                ///< every value is a number
    bool binned = false;                 ///< levels are ranges of numbers
    std::vector<ParameterLevel> levels;  ///< ascending by number, or by word
    std::vector<std::size_t> of_run;     ///< which level, or `none`
    std::vector<double> numbers;         ///< of each run; NaN where it has none or the values are words
    std::size_t distinct = 0;            ///< different values
    std::size_t not_shown = 0;           ///< runs with a value beyond `most_word_levels`
};

ParameterLevels levels_of(const ReportedParameter& parameter);

}  // namespace skyloop
