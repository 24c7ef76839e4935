#include <fmt/format.h>

#include <algorithm>

#include "detail/names.hpp"
#include "detail/page_parts.hpp"

namespace skyloop {
namespace {

std::string effect_cell(const Effect& effect) {
    const std::string words = effect_words(effect);
    std::string sign = "–", kind = "faint";
    if (effect.seen()) {
        kind = "seen";
        const char* mark = effect.kind == Effect::Kind::rising ? "▲" : effect.kind == Effect::Kind::falling ? "▼" : "◆";
        sign = fmt::format("{} {:.2f}", mark, effect.strength);
    }
    return fmt::format("<td class=\"n\"><span class=\"{}\" title=\"{}\">{}</span></td>", kind, words, sign);
}

std::string effect_row(const std::string& name, const std::vector<Effect>& effects) {
    std::string row = fmt::format("<tr><td>{}</td>", page_text(name));
    for (const Effect& effect : effects)
        row += effect_cell(effect);
    return row + "</tr>\n";
}

}  // namespace

std::string run_row(const CampaignResults& results, std::size_t run, const std::string& value) {
    const auto command = replay_command(results, results.runs[run]);
    return fmt::format(
        "<tr>{}{}<td>{}</td><td>{}</td><td>{}</td></tr>\n", number_cell(fmt::format("{}", results.runs[run].number)),
        number_cell(fmt::format("{}", results.runs[run].seed)), page_text(value, 300),
        page_text(parameters_of(results, run), 300),
        // Never cut: half a command would run something else.
        command ? "<code class=\"command\">" + page_text(*command, command->size()) + "</code>" : std::string("–"));
}

std::string run_table(std::string_view value_heading, const std::string& rows) {
    return fmt::format(
        "<div class=\"scroll\"><table><thead><tr><th class=\"n\">run</th><th class=\"n\">seed</th><th>{}</th>"
        "<th>parameters</th><th>replay it</th></tr></thead>\n<tbody>\n{}</tbody></table></div>\n",
        page_text(value_heading), rows);
}

std::string effect_section(const CampaignResults& results, const CampaignSummary& summary) {
    if (results.parameters.empty()) return {};
    std::string text =
        "<h2>What moves what</h2>\n<p>▲ larger with larger values of the parameter, ▼ smaller (the size of Spearman's "
        "ρ, 0 … 1), ◆ differs between levels without one direction (the root of ε²), – no relation seen.</p>\n"
        "<div class=\"scroll\"><table><thead><tr><th></th>";
    for (const ReportedParameter& parameter : results.parameters)
        text += fmt::format("<th class=\"n\"><code>{}</code></th>", page_text(parameter.name, 60));
    text += "</tr></thead>\n<tbody>\n";
    for (const VerdictSummary& verdict : summary.verdicts)
        text += effect_row("passed: " + verdict_name(results, verdict), verdict.effects);
    for (const MetricSummary& metric : summary.metrics)
        text += effect_row(metric_words(results.metrics[metric.metric].name).axis(), metric.effects);
    return text + "</tbody></table></div>\n";
}

std::string failed_run_section(const CampaignResults& results, const CampaignSummary& summary) {
    std::string text = "<h2>Failed runs</h2>\n";
    if (summary.failed_runs.empty()) return text + "<p>None.</p>\n";
    const std::size_t shown = std::min(summary.failed_runs.size(), most_listed_runs);
    if (shown < summary.failed_runs.size())
        text += fmt::format("<p>The first {} of {}; the JSON file beside this page has all.</p>\n", shown,
                            summary.failed_runs.size());
    std::string rows;
    for (std::size_t i = 0; i < shown; ++i)
        rows += run_row(results, summary.failed_runs[i], failures_of(results, summary.failed_runs[i]));
    return text + run_table("what failed", rows);
}

std::string method_section(const CampaignSummary& summary) {
    return fmt::format(
        "<h2>How to read this</h2>\n<ul>\n"
        "<li>Every interval is one of 95 %: of a hundred such intervals about five miss the true value. They tell how "
        "much the chance of the seeds leaves open, not how well the models fit the world.</li>\n"
        "<li>Rates have Wilson’s interval; where fewer than {} runs passed or failed, the exact one of Clopper and "
        "Pearson, because Wilson’s can cover less than it says there.</li>\n"
        "<li>Percentiles lie between two runs’ values; their intervals end at values of runs (order statistics) and "
        "hold for any shape of distribution. The band of a distribution function is the one of Dvoretzky, Kiefer and "
        "Wolfowitz.</li>\n"
        "<li>A relation is called seen when luck would show one as clear in less than {:.0f} % of reports: {} tests "
        "share that chance. ρ is Spearman’s rank correlation, strong from 0.6, clear from 0.3; ε² the share of rank "
        "differences between levels (Kruskal and Wallis). What is not seen may still be there.</li>\n"
        "<li>Boxes go from the first to the third quartile, their whiskers from the 5th to the 95th percentile. Of "
        "many runs only every k-th is drawn as a dot, as the picture says; numbers are always of all "
        "runs.</li>\n</ul>\n",
        few_trials, 100 * report_false_alarm, summary.tests);
}

}  // namespace skyloop
