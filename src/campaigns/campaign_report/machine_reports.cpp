#include <fmt/format.h>

#include <algorithm>

#include "base/core/json.hpp"
#include "campaigns/campaign_report/campaign_report.hpp"
#include "detail/page_parts.hpp"
#include "detail/shown_names.hpp"

namespace skyloop::inline campaigns {
namespace {

template <class T>
Json json_or_null(const std::optional<T>& value) {
    return value ? Json(*value) : Json();
}

Json rate_json(const Rate& rate) {
    const Interval wilson = wilson_interval(rate.count);
    const Interval exact = clopper_pearson_interval(rate.count);
    return {{"passed", rate.count.passed},
            {"trials", rate.count.trials},
            {"share", rate.count.trials > 0 ? Json(rate.share()) : Json()},
            {"interval", {rate.interval.low, rate.interval.high}},
            {"interval_kind", rate.exact ? "clopper_pearson" : "wilson"},
            {"wilson", {wilson.low, wilson.high}},
            {"clopper_pearson", {exact.low, exact.high}}};
}

Json effect_json(const CampaignResults& results, const Effect& effect) {
    Json json{{"parameter", results.parameters[effect.parameter].name},
              {"seen", effect.seen()},
              {"words", effect_words(effect)}};
    if (effect.trend)
        json["spearman"] = {{"rho", effect.trend->rho}, {"p_value", effect.trend->p_value}, {"n", effect.trend->n}};
    if (effect.levels)
        json["kruskal_wallis"] = {{"h", effect.levels->h},
                                  {"p_value", effect.levels->p_value},
                                  {"epsilon_squared", effect.levels->strength},
                                  {"groups", effect.levels->groups},
                                  {"n", effect.levels->n}};
    return json;
}

Json effects_json(const CampaignResults& results, const std::vector<Effect>& effects) {
    Json list = Json::array();
    for (const Effect& effect : effects)
        list.push_back(effect_json(results, effect));
    return list;
}

Json run_json(const CampaignResults& results, std::size_t index) {
    const GatheredRun& run = results.runs[index];
    Json json{{"number", run.number}, {"seed", run.seed}, {"key", run.key}, {"status", run_status_word(run.status)}};
    Json parameters = Json::object();
    for (const ReportedParameter& parameter : results.parameters)
        if (parameter.values[index]) parameters[parameter.name] = *parameter.values[index];
    json["parameters"] = parameters;
    json["replay"] = json_or_null(replay_command(results, run));
    return json;
}

Json verdict_json(const CampaignResults& results, const CampaignSummary& summary, const VerdictSummary& verdict) {
    Json json{{"name", verdict.verdict ? Json(results.verdicts[*verdict.verdict].name) : Json()},
              {"rate", rate_json(verdict.rate)},
              {"runs_without", verdict.without},
              {"effects", effects_json(results, verdict.effects)}};
    Json parameters = Json::array();
    for (std::size_t i = 0; i < summary.levels.size(); ++i) {
        Json levels = Json::array();
        for (std::size_t k = 0; k < summary.levels[i].levels.size(); ++k) {
            const ParameterLevel& level = summary.levels[i].levels[k];
            Json entry{{"label", level.label}};
            if (summary.levels[i].numeric) {
                entry["low"] = level.low;
                entry["high"] = level.high;
            }
            entry["rate"] = rate_json(verdict.by_level[i][k]);
            levels.push_back(entry);
        }
        parameters.push_back({{"parameter", results.parameters[i].name}, {"levels", levels}});
    }
    json["by_parameter"] = parameters;
    return json;
}

Json metric_json(const CampaignResults& results, const MetricSummary& metric) {
    const ReportedMetric& reported = results.metrics[metric.metric];
    Json json{{"name", reported.name},
              {"unit", metric_words(reported.name).unit},
              {"count", metric.sorted.size()},
              {"without", metric.without},
              {"infinite", metric.infinite},
              {"mean", json_or_null(metric.mean)},
              {"sd", json_or_null(metric.sd)},
              {"min", metric.sorted.empty() ? Json() : Json(metric.sorted.front())},
              {"max", metric.sorted.empty() ? Json() : Json(metric.sorted.back())}};
    Json percentiles = Json::array();
    for (const PercentileSummary& percentile : metric.percentiles)
        percentiles.push_back(
            {{"share", percentile.share},
             {"value", percentile.value},
             {"interval", {json_or_null(percentile.interval.low), json_or_null(percentile.interval.high)}}});
    json["percentiles"] = percentiles;
    json["effects"] = effects_json(results, metric.effects);
    constexpr std::array<std::string_view, 3> ends{"largest", "smallest", "farthest_from_zero"};
    json["worst_end"] = ends[static_cast<std::size_t>(metric.worst_end)];
    json["worst"] = Json::array();
    for (const std::size_t run : metric.worst) {
        Json entry = run_json(results, run);
        entry["value"] = reported.values[run];
        json["worst"].push_back(entry);
    }
    return json;
}

Json failed_run_json(const CampaignResults& results, std::size_t run) {
    Json json = run_json(results, run);
    if (!results.runs[run].error.empty()) json["error"] = results.runs[run].error;
    json["failed_verdicts"] = Json::array();
    for (const ReportedVerdict& verdict : results.verdicts)
        if (verdict.passed[run] == false)
            json["failed_verdicts"].push_back({{"name", verdict.name}, {"detail", verdict.details[run]}});
    return json;
}

}  // namespace

std::string campaign_report_json(const CampaignResults& results, const CampaignSummary& summary) {
    Json json;
    json["campaign"] = {{"name", results.name},
                        {"scenario", results.scenario},
                        {"scenario_digest", results.scenario_digest},
                        {"options", results.options},
                        {"campaign_file", results.campaign_file},
                        {"program_version", results.program_version}};
    json["runs"] = {{"planned", json_or_null(results.planned)},
                    {"done", results.runs.size()},
                    {"missing", json_or_null(summary.missing)},
                    {"passed", summary.passed},
                    {"failed", summary.failed},
                    {"errors", summary.errors}};
    json["confidence"] = report_confidence;
    json["tests"] = summary.tests;
    json["false_alarm"] = report_false_alarm;
    json["all_checks"] = verdict_json(results, summary, summary.verdicts.front());
    json["verdicts"] = Json::array();
    for (std::size_t i = 1; i < summary.verdicts.size(); ++i)
        json["verdicts"].push_back(verdict_json(results, summary, summary.verdicts[i]));
    json["metrics"] = Json::array();
    for (const MetricSummary& metric : summary.metrics)
        json["metrics"].push_back(metric_json(results, metric));
    json["failed_runs"] = Json::array();
    for (const std::size_t run : summary.failed_runs)
        json["failed_runs"].push_back(failed_run_json(results, run));
    return json_text(json, 1) + "\n";
}

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

}  // namespace skyloop::inline campaigns
