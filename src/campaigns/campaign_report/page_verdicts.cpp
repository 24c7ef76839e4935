#include <fmt/format.h>

#include <algorithm>

#include "detail/page_parts.hpp"
#include "detail/shown_names.hpp"
#include "study/plot/rate_plots.hpp"

namespace skyloop::inline campaigns {
namespace {

constexpr std::size_t most_rate_rows = 60;
constexpr std::size_t most_maps = 6;
constexpr std::size_t most_map_levels = 12;

std::string caption(const std::string& what, const std::string& words) {
    return fmt::format("<figcaption><b>{}</b><br/>{}</figcaption>\n", what, words);
}

RateRow rate_row(const std::string& label, const Rate& rate) {
    return {label, rate.share(), rate.interval.low, rate.interval.high, rate.count.passed, rate.count.trials};
}

std::string verdict_row(const CampaignResults& results, const VerdictSummary& verdict) {
    const Rate& rate = verdict.rate;
    std::string row = fmt::format("<tr><td>{}</td>", page_text(verdict_name(results, verdict)));
    row += number_cell(fmt::format("{} of {}", rate.count.passed, rate.count.trials));
    if (rate.count.trials == 0) {
        row += number_cell("–") + number_cell("–") + "<td>no run came to an end</td>";
    } else {
        row += number_cell(percent_text(rate.share())) + number_cell(percent_interval_text(rate.interval));
        row += fmt::format("<td>{}</td>", rate.exact ? "Clopper–Pearson" : "Wilson");
    }
    return row + number_cell(verdict.without > 0 ? fmt::format("{}", verdict.without) : "–") + "</tr>\n";
}

// A verdict whose outcome varies: only there is something to compare.
bool varies(const VerdictSummary& verdict) {
    return verdict.rate.count.passed > 0 && verdict.rate.count.passed < verdict.rate.count.trials;
}

std::string rate_picture(const CampaignResults& results, const CampaignSummary& summary, const VerdictSummary& verdict,
                         std::size_t parameter) {
    std::vector<RateRow> rows;
    const ParameterLevels& levels = summary.levels[parameter];
    for (std::size_t i = 0; i < levels.levels.size(); ++i)
        rows.push_back(rate_row(levels.levels[i].label, verdict.by_level[parameter][i]));
    const std::string name = page_text(results.parameters[parameter].name);
    const std::string title =
        fmt::format("{} by {}", verdict_name(results, verdict), results.parameters[parameter].name);
    return "<figure>" + caption("by " + name, effect_words(verdict.effects[parameter])) +
           rate_rows_plot(rows, title, level_plot_width).element() + "</figure>\n";
}

std::string map_picture(const CampaignResults& results, const CampaignSummary& summary, const VerdictSummary& verdict,
                        std::pair<std::size_t, std::size_t> parameters) {
    const ParameterLevels& across = summary.levels[parameters.first];
    const ParameterLevels& upward = summary.levels[parameters.second];
    RateMap map;
    map.column_axis = results.parameters[parameters.first].name;
    map.row_axis = results.parameters[parameters.second].name;
    map.title = fmt::format("{} by {} and {}", verdict_name(results, verdict), map.column_axis, map.row_axis);
    for (const ParameterLevel& level : across.levels)
        map.columns.push_back(level.label);
    for (const ParameterLevel& level : upward.levels)
        map.rows.push_back(level.label);
    map.cells.resize(map.columns.size() * map.rows.size());
    for (std::size_t run = 0; run < results.runs.size(); ++run) {
        const auto passed = verdict_of(results, verdict, run);
        if (!passed || across.of_run[run] == ParameterLevels::none || upward.of_run[run] == ParameterLevels::none)
            continue;
        RateCell& cell = map.cells[upward.of_run[run] * map.columns.size() + across.of_run[run]];
        cell.passed += *passed ? 1U : 0U;
        ++cell.trials;
    }
    for (RateCell& cell : map.cells) {
        const Interval interval = rate_of({cell.passed, cell.trials}).interval;
        cell.low = interval.low;
        cell.high = interval.high;
    }
    return fmt::format("<figure>{}{}</figure>\n",
                       caption(page_text(map.column_axis) + " and " + page_text(map.row_axis),
                               "rate in percent; point at a cell for its counts and interval"),
                       rate_map_plot(map).element());
}

bool fits_a_map(const ParameterLevels& levels) {
    return levels.levels.size() > 1 && levels.levels.size() <= most_map_levels && levels.not_shown == 0;
}

std::string map_pictures(const CampaignResults& results, const CampaignSummary& summary,
                         const VerdictSummary& verdict) {
    std::string text;
    std::size_t drawn = 0, left_out = 0;
    for (std::size_t i = 0; i < summary.levels.size(); ++i)
        for (std::size_t k = i + 1; k < summary.levels.size(); ++k) {
            if (!fits_a_map(summary.levels[i]) || !fits_a_map(summary.levels[k])) continue;
            if (drawn == most_maps) {
                ++left_out;
                continue;
            }
            text += map_picture(results, summary, verdict, {i, k});
            ++drawn;
        }
    if (left_out > 0)
        text += fmt::format("<p class=\"faint\">{} more pairs of parameters are not drawn.</p>\n", left_out);
    return text;
}

}  // namespace

std::string number_cell(std::string_view text) { return fmt::format("<td class=\"n\">{}</td>", page_text(text)); }

std::vector<std::size_t> pictured_effects(const std::vector<Effect>& effects) {
    std::vector<std::size_t> order;
    for (std::size_t i = 0; i < effects.size(); ++i)
        if (effects[i].kind != Effect::Kind::constant) order.push_back(i);
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return effects[a].strength > effects[b].strength; });
    order.resize(std::min(order.size(), most_pictured_effects));
    return order;
}

std::string verdict_section(const CampaignResults& results, const CampaignSummary& summary) {
    std::string text = "<h2>Verdicts</h2>\n";
    std::vector<RateRow> rows;
    for (std::size_t i = 0; i < std::min(summary.verdicts.size(), most_rate_rows); ++i)
        rows.push_back(rate_row(verdict_name(results, summary.verdicts[i]), summary.verdicts[i].rate));
    text += "<figure>" + rate_rows_plot(rows, "Verdict rates with 95 % intervals", wide_plot_width).element() +
            "</figure>\n";
    text +=
        "<div class=\"scroll\"><table><thead><tr><th>verdict</th><th class=\"n\">passed</th><th class=\"n\">rate</th>"
        "<th class=\"n\">95 % interval</th><th>by</th><th class=\"n\">runs without it</th></tr></thead>\n<tbody>\n";
    for (const VerdictSummary& verdict : summary.verdicts)
        text += verdict_row(results, verdict);
    return text + "</tbody></table></div>\n";
}

std::string rate_sections(const CampaignResults& results, const CampaignSummary& summary) {
    if (summary.levels.empty()) return {};
    std::string text = "<h2>Where the checks fail</h2>\n";
    std::size_t pictured = 0, steady = 0;
    for (const VerdictSummary& verdict : summary.verdicts) {
        if (!varies(verdict)) {
            ++steady;
            continue;
        }
        if (++pictured > most_pictured_metrics) continue;
        text += fmt::format("<h3>{}</h3>\n<div class=\"pair\">\n", page_text(verdict_name(results, verdict)));
        for (const std::size_t parameter : pictured_effects(verdict.effects))
            text += rate_picture(results, summary, verdict, parameter);
        text += "</div>\n<div class=\"pair\">\n" + map_pictures(results, summary, verdict) + "</div>\n";
    }
    if (steady > 0)
        text += fmt::format(
            "<p class=\"faint\">Verdicts that had the same outcome in all runs, and so nothing to "
            "compare: {}.</p>\n",
            steady);
    return text;
}

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

}  // namespace skyloop::inline campaigns
