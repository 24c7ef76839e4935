/// The statistics of a campaign: rates, distributions, and what moves them.
/// The values of a swept parameter as few groups of runs that can be compared.
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "campaigns/campaign_report/campaign_results.hpp"
#include "campaigns/campaign_report/statistical_tests.hpp"

namespace skyloop::inline campaigns {

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

/// The percentiles that are told, as shares.
inline constexpr std::array<double, 4> reported_shares{0.05, 0.50, 0.95, 0.99};

/// Below this many runs nothing is said of what moves a metric: Student's law of a rank correlation is too rough there.
inline constexpr std::size_t fewest_runs_for_effects = 10;

/// The chance, over all tests of a report together, of taking luck for an effect; each test gets its part of it
/// (Bonferroni's inequality).
inline constexpr double report_false_alarm = 0.05;

/// What is known of how a parameter moves a metric or a verdict.
struct Effect {
    enum class Kind {
        too_few,    ///< fewest_runs_for_effects
        constant,   ///< the parameter or the metric does not vary
        unseen,     ///< nothing that luck does not do
        rising,     ///< larger with larger values of the parameter
        falling,    ///< smaller with them
        differing,  ///< differs between levels without one direction
    };
    std::size_t parameter = 0;             ///< which of the results
    std::optional<RankCorrelation> trend;  ///< of numbers
    std::optional<GroupTest> levels;
    Kind kind = Kind::unseen;
    /// |ρ| where it rises or falls, the root of ε² where it differs, otherwise 0.
    double strength = 0;
    [[nodiscard]] bool seen() const { return kind >= Kind::rising; }
};

/// "rises strongly", "differs slightly between values", "no relation seen": strong from 0.6, clear from 0.3.
std::string effect_words(const Effect& effect);
/// The same of an effect that is seen, with the parameter's name: "rises strongly with noise".
std::string effect_words(const Effect& effect, std::string_view parameter);

/// Which end of a metric is the bad one.
enum class WorstEnd { largest, smallest, farthest_from_zero };

struct PercentileSummary {
    double share = 0;  ///< 0 … 1
    double value = 0;  ///< linear between order statistics
    PercentileInterval interval;
};

struct MetricSummary {
    std::size_t metric = 0;                      ///< which of the results
    std::vector<double> sorted;                  ///< finite values, ascending
    std::size_t without = 0;                     ///< runs that ended, without a value
    std::size_t infinite = 0;                    ///< runs whose value is infinite or beyond largest_reported_number
    std::optional<double> mean;                  ///< nothing without values
    std::optional<double> sd;                    ///< with n − 1; nothing for fewer than two values
    std::vector<PercentileSummary> percentiles;  ///< of reported_shares; none without values
    std::vector<Effect> effects;                 ///< one for each parameter
    WorstEnd worst_end = WorstEnd::largest;
    std::vector<std::size_t> worst;      ///< runs, the worst first
    std::vector<std::size_t> valueless;  ///< runs that ended with no value or an infinite one
};

struct VerdictSummary {
    std::optional<std::size_t> verdict;  ///< which of the results; nothing: all checks of a run
    Rate rate;
    std::size_t without = 0;                  ///< runs that ended, without this verdict
    std::vector<Effect> effects;              ///< one for each parameter
    std::vector<std::vector<Rate>> by_level;  ///< [parameter][level]
};

struct CampaignSummary {
    std::size_t passed = 0, failed = 0, errors = 0;
    std::optional<std::uint64_t> missing;  ///< planned less those in the database; nothing when not told
    std::vector<ParameterLevels> levels;   ///< of each parameter
    std::vector<VerdictSummary> verdicts;  ///< first all checks together
    std::vector<MetricSummary> metrics;
    std::vector<std::size_t> failed_runs;  ///< failed and erroneous, by number
    std::size_t tests = 0;                 ///< that the false alarms are shared among
};

/// @param worst how many runs each metric names
CampaignSummary summarise(const CampaignResults& results, std::size_t worst);

/// How a run passed a verdict, nothing where it has none or came to no end.
std::optional<bool> verdict_of(const CampaignResults& results, const VerdictSummary& verdict, std::size_t run);

}  // namespace skyloop::inline campaigns
