#include <fmt/format.h>

#include <algorithm>

#include "detail/names.hpp"
#include "detail/page_parts.hpp"
#include "study/plot/level_plots.hpp"
#include "study/plot/rate_map_plot.hpp"

namespace skyloop {
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

}  // namespace skyloop
