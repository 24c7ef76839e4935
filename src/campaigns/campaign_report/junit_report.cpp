#include <fmt/format.h>

#include <algorithm>

#include "campaigns/campaign_report/campaign_report.hpp"
#include "detail/names.hpp"
#include "detail/page_parts.hpp"

namespace skyloop {
namespace {

constexpr std::size_t most_case_characters = 1000;

// In the order of their numbers: all, or the first that failed and, where there is room, the first that passed.
std::vector<std::size_t> told_runs(const CampaignResults& results, const CampaignSummary& summary) {
    std::vector<std::size_t> runs = summary.failed_runs;
    for (std::size_t i = 0; i < results.runs.size() && runs.size() < most_junit_runs; ++i)
        if (results.runs[i].status == RunStatus::passed) runs.push_back(i);
    runs.resize(std::min(runs.size(), most_junit_runs));
    std::sort(runs.begin(), runs.end());
    return runs;
}

// A case and what became of it. The form asks for a time; results have none, as they are the same on any machine.
std::string test_case(const CampaignResults& results, std::string_view name, const std::string& outcome) {
    return fmt::format("    <testcase classname=\"{}\" name=\"{}\" time=\"0\"{}", page_text(results.name), name,
                       outcome.empty() ? "/>\n" : ">\n" + outcome + "    </testcase>\n");
}

std::string outcome_of(const CampaignResults& results, std::size_t run) {
    const RunStatus status = results.runs[run].status;
    if (status == RunStatus::passed) return {};
    const std::string why = page_text(failures_of(results, run), most_case_characters);
    const auto command = replay_command(results, results.runs[run]);
    return fmt::format("      <{0} type=\"{1}\" message=\"{2}\">{2}{3}</{0}>\n",
                       status == RunStatus::failed ? "failure" : "error", run_status_word(status), why,
                       command ? "\nreplay: " + page_text(*command, command->size()) : std::string());
}

std::string case_of_run(const CampaignResults& results, std::size_t run) {
    const std::string parameters = page_text(parameters_of(results, run), most_case_characters);
    return test_case(results,
                     fmt::format("run {}, seed {}{}{}", results.runs[run].number, results.runs[run].seed,
                                 parameters.empty() ? "" : ", ", parameters),
                     outcome_of(results, run));
}

std::string case_of_missing(const CampaignResults& results, std::uint64_t missing) {
    const std::string why = fmt::format("{} of {} planned runs have no result", missing, results.planned.value_or(0));
    return test_case(results, "every planned run has a result",
                     fmt::format("      <error type=\"missing\" message=\"{0}\">{0}</error>\n", why));
}

}  // namespace

std::string campaign_report_junit(const CampaignResults& results, const CampaignSummary& summary) {
    const std::vector<std::size_t> runs = told_runs(results, summary);
    const auto count = [&](RunStatus status) {
        return std::count_if(runs.begin(), runs.end(),
                             [&](std::size_t run) { return results.runs[run].status == status; });
    };
    const std::uint64_t missing = summary.missing.value_or(0);
    const int more = missing > 0 ? 1 : 0;
    const std::string counts = fmt::format("tests=\"{}\" failures=\"{}\" errors=\"{}\" skipped=\"0\" time=\"0\"",
                                           runs.size() + static_cast<std::size_t>(more), count(RunStatus::failed),
                                           count(RunStatus::error) + more);
    std::string text = fmt::format(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites name=\"skyloop\" {}>\n  <testsuite name=\"{}\" {}>\n"
        "    <properties>\n      <property name=\"runs\" value=\"{}\"/>\n"
        "      <property name=\"runs_left_out\" value=\"{}\"/>\n    </properties>\n",
        counts, page_text(results.name), counts, results.runs.size(), results.runs.size() - runs.size());
    if (missing > 0) text += case_of_missing(results, missing);
    for (const std::size_t run : runs)
        text += case_of_run(results, run);
    return text + "  </testsuite>\n</testsuites>\n";
}

}  // namespace skyloop
