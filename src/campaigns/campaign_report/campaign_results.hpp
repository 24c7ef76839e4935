/// What a campaign's database tells: its runs, what each was given and what came of it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/core/result.hpp"

namespace skyloop::inline campaigns {

/// How a run ended: all verdicts passed, one failed, or the run itself came to no end.
enum class RunStatus { passed, failed, error };
std::string_view run_status_word(RunStatus status);

struct GatheredRun {
    std::string key;
    std::int64_t number = 0;  ///< in the plan
    std::uint64_t seed = 0;
    RunStatus status = RunStatus::passed;
    std::string error;  ///< why it came to no end, where that is told
};

/// A parameter that the campaign varied; one entry for each run.
struct ReportedParameter {
    std::string name;
    std::vector<std::optional<std::string>> values;
};

/// A figure that runs gave; one entry for each run, in the unit that ends its name.
struct ReportedMetric {
    std::string name;
    std::vector<double> values;  ///< NaN: the run has none
};

/// A check that runs passed or failed; one entry for each run.
struct ReportedVerdict {
    std::string name;
    std::vector<std::optional<bool>> passed;  ///< nothing: it was not run
    std::vector<std::string> details;         ///< one for each run, "" where there is none
};

/// Everything, runs in the order of their numbers, the rest in the order in which the database first names them.
struct CampaignResults {
    std::string name, program_version, scenario, scenario_digest, campaign_file;
    std::vector<std::string> options;      ///< words of the command line that the campaign was made with
    std::string vehicle;                   ///< command of the program that was tested; empty: there was none
    std::optional<std::uint64_t> planned;  ///< nothing when the database does not tell
    std::vector<GatheredRun> runs;
    std::vector<ReportedParameter> parameters;
    std::vector<ReportedMetric> metrics;
    std::vector<ReportedVerdict> verdicts;
};

/// More names of parameters, metrics or verdicts than this are refused: no page shows them.
inline constexpr std::size_t most_report_names = 500;

/// Reads the database that `skyloop campaign gather` writes (tables meta, run, parameter, metric and verdict, and error
/// where it is there), without changing it. Fails with `outside` when it cannot be opened, with `input` when it is no
/// such database: each message names the file, the table and the row.
Result<CampaignResults> read_campaign_results(const std::filesystem::path& database);

}  // namespace skyloop::inline campaigns
