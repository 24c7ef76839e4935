#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "detail/page_parts.hpp"
#include "detail/shown_names.hpp"
#include "study/analysis/statistics.hpp"
#include "study/plot/metric_plots.hpp"
#include "study/plot/rate_plots.hpp"

namespace skyloop::inline campaigns {
namespace {

// The finite values of each level, ascending.
std::vector<std::vector<double>> values_by_level(const ReportedMetric& metric, const ParameterLevels& levels) {
    std::vector<std::vector<double>> values(levels.levels.size());
    for (std::size_t run = 0; run < levels.of_run.size(); ++run)
        if (levels.of_run[run] != ParameterLevels::none && std::abs(metric.values[run]) <= largest_reported_number)
            values[levels.of_run[run]].push_back(metric.values[run]);
    for (std::vector<double>& of_level : values)
        std::sort(of_level.begin(), of_level.end());
    return values;
}

SvgDocument box_picture(const ReportedMetric& metric, const ParameterLevels& levels, const std::string& title) {
    std::vector<BoxRow> rows;
    const auto values = values_by_level(metric, levels);
    for (std::size_t i = 0; i < values.size(); ++i) {
        BoxRow row{levels.levels[i].label, 0, 0, 0, 0, 0, values[i].size()};
        if (row.count > 0) {
            row.p5 = sorted_quantile(values[i], 0.05);
            row.p25 = sorted_quantile(values[i], 0.25);
            row.median = sorted_quantile(values[i], 0.50);
            row.p75 = sorted_quantile(values[i], 0.75);
            row.p95 = sorted_quantile(values[i], 0.95);
        }
        rows.push_back(row);
    }
    return box_rows_plot(rows, metric_words(metric.name).axis(), title);
}

SvgDocument dot_picture(const ReportedMetric& metric, const ParameterLevels& levels, const std::string& parameter,
                        const std::string& title) {
    TrendPlot plot;
    plot.title = title;
    plot.x_axis = parameter;
    plot.y_axis = metric_words(metric.name).axis();
    for (std::size_t run = 0; run < metric.values.size(); ++run)
        if (!std::isnan(levels.numbers[run]) && std::abs(metric.values[run]) <= largest_reported_number)
            plot.dots.push_back({levels.numbers[run], metric.values[run]});
    const auto values = values_by_level(metric, levels);
    for (std::size_t i = 0; i < values.size(); ++i)
        if (!values[i].empty())
            plot.ranges.push_back({levels.levels[i].low, levels.levels[i].high, sorted_quantile(values[i], 0.05),
                                   sorted_quantile(values[i], 0.50), sorted_quantile(values[i], 0.95)});
    return trend_plot(plot);
}

std::string rho_text(const Effect& effect) {
    if (!effect.trend) return {};
    return fmt::format("ρ = {}{:.2f}", effect.trend->rho < 0 ? "−" : "", std::abs(effect.trend->rho));
}

// "ρ = −0.72, p < 0.001, 2000 runs"
std::string effect_figures(const Effect& effect) {
    if (effect.trend && effect.kind != Effect::Kind::differing)
        return fmt::format("{}, {}, {} runs", rho_text(effect), p_value_text(effect.trend->p_value), effect.trend->n);
    if (effect.levels)
        return fmt::format("ε² = {:.2f}, {}, {} runs", effect.levels->strength, p_value_text(effect.levels->p_value),
                           effect.levels->n);
    return {};
}

std::string percentile_table(const MetricSummary& metric) {
    std::string head, values, intervals;
    const auto column = [&](const std::string& name, const std::string& value, const std::string& interval) {
        head += fmt::format("<th class=\"n\">{}</th>", name);
        values += number_cell(value);
        intervals += number_cell(interval);
    };
    column("runs", fmt::format("{}", metric.sorted.size()), "");
    column("mean", figure_text(*metric.mean), "");
    column("sd", metric.sd ? figure_text(*metric.sd) : "–", "");
    column("min", figure_text(metric.sorted.front()), "");
    for (const PercentileSummary& percentile : metric.percentiles)
        column(fmt::format("p{:g}", 100 * percentile.share), figure_text(percentile.value),
               interval_text(percentile.interval));
    column("max", figure_text(metric.sorted.back()), "");
    return fmt::format(
        "<div class=\"scroll\"><table><thead><tr><th></th>{}</tr></thead>\n<tbody><tr><td>value</td>{}"
        "</tr>\n<tr><td>95 %</td>{}</tr></tbody></table></div>\n",
        head, values, intervals);
}

// Which percentiles have an open end, and how many runs would close it.
std::string open_ends(const MetricSummary& metric) {
    std::string text;
    for (const PercentileSummary& percentile : metric.percentiles)
        if (!percentile.interval.low || !percentile.interval.high)
            text += fmt::format("{}p{:g} ({})", text.empty() ? "" : ", ", 100 * percentile.share,
                                fewest_values_for(percentile.share));
    if (text.empty()) return {};
    return fmt::format(
        "<p class=\"faint\">Too few runs for both ends of an interval of {}: in brackets how many it "
        "takes.</p>\n",
        text);
}

std::string what_moves(const CampaignResults& results, const MetricSummary& metric) {
    if (metric.effects.empty()) return {};
    std::string seen, unseen;
    std::vector<const Effect*> order;
    for (const Effect& effect : metric.effects)
        order.push_back(&effect);
    std::stable_sort(order.begin(), order.end(),
                     [](const Effect* a, const Effect* b) { return a->strength > b->strength; });
    for (const Effect* effect : order) {
        const std::string name = "<code>" + page_text(results.parameters[effect->parameter].name) + "</code>";
        if (effect->seen())
            seen += fmt::format("{}<b>{}</b> ({})", seen.empty() ? "" : "; ", effect_words(*effect, name),
                                page_text(effect_figures(*effect)));
        else
            unseen += fmt::format("{}{} ({})", unseen.empty() ? "" : ", ", name, effect_words(*effect));
    }
    std::string text = "<p>";
    if (!seen.empty()) text += "It " + seen + ". ";
    if (!unseen.empty()) text += (seen.empty() ? "Nothing seen moves it: " : "Not seen to move it: ") + unseen + ".";
    return text + "</p>\n";
}

std::string worst_runs_table(const CampaignResults& results, const MetricSummary& metric) {
    constexpr std::array<std::string_view, 3> ends{"largest", "smallest", "farthest from zero"};
    const ReportedMetric& reported = results.metrics[metric.metric];
    std::string rows;
    for (const std::size_t run : metric.worst)
        rows += run_row(results, run, figure_text(reported.values[run]));
    if (rows.empty()) return {};
    return fmt::format("<details><summary>The {} worst runs ({})</summary>\n{}</details>\n", metric.worst.size(),
                       ends[static_cast<std::size_t>(metric.worst_end)],
                       run_table(metric_words(reported.name).axis(), rows));
}

std::string valueless_table(const CampaignResults& results, const MetricSummary& metric) {
    if (metric.valueless.empty()) return {};
    std::string rows;
    const std::size_t shown = std::min(metric.valueless.size(), most_listed_runs);
    for (std::size_t i = 0; i < shown; ++i) {
        const double value = results.metrics[metric.metric].values[metric.valueless[i]];
        rows += run_row(results, metric.valueless[i], std::isnan(value) ? "none" : "infinite");
    }
    return fmt::format("<details><summary>Runs that ended without a finite value: {}{}</summary>\n{}</details>\n",
                       metric.valueless.size(),
                       shown < metric.valueless.size() ? fmt::format(", the first {}", shown) : "",
                       run_table("value", rows));
}

std::string metric_pictures(const CampaignResults& results, const CampaignSummary& summary,
                            const MetricSummary& metric) {
    const ReportedMetric& reported = results.metrics[metric.metric];
    DistributionPlot plot{
        metric_words(reported.name).axis(), metric.sorted, distribution_band(metric.sorted.size()), {}};
    for (const PercentileSummary& percentile : metric.percentiles)
        plot.percentiles.push_back(
            {percentile.share, percentile.value, percentile.interval.low, percentile.interval.high});
    std::string text = "<figure>" + distribution_plot(plot).element() + "</figure>\n";
    const std::vector<std::size_t> pictured = pictured_effects(metric.effects);
    if (pictured.empty()) return text;
    text += "<div class=\"pair\">\n";
    for (const std::size_t i : pictured)
        text += effect_picture(results, summary, metric, metric.effects[i]);
    text += "</div>\n";
    const std::size_t left_out = metric.effects.size() - pictured.size();
    if (pictured.size() == most_pictured_effects && left_out > 0)
        text += fmt::format("<p class=\"faint\">The other {} parameters are not drawn.</p>\n", left_out);
    return text;
}

std::string metric_section(const CampaignResults& results, const CampaignSummary& summary, const MetricSummary& metric,
                           bool pictured) {
    const ReportedMetric& reported = results.metrics[metric.metric];
    std::string text = fmt::format("<h3>{}</h3>\n", page_text(metric_words(reported.name).axis()));
    if (metric.sorted.empty()) {
        text += "<p>No run has a finite value.</p>\n";
    } else {
        text += percentile_table(metric) + open_ends(metric);
        if (metric.sorted.size() == 1)
            text += "<p>One value makes no distribution.</p>\n";
        else if (metric.sorted.front() == metric.sorted.back())
            return text + "<p>All values are equal.</p>\n" + valueless_table(results, metric);
        else
            text += what_moves(results, metric) + (pictured ? metric_pictures(results, summary, metric) : "");
    }
    return text + worst_runs_table(results, metric) + valueless_table(results, metric);
}

}  // namespace

std::string effect_picture(const CampaignResults& results, const CampaignSummary& summary, const MetricSummary& metric,
                           const Effect& effect) {
    const ReportedMetric& reported = results.metrics[metric.metric];
    const ParameterLevels& levels = summary.levels[effect.parameter];
    const std::string& parameter = results.parameters[effect.parameter].name;
    const std::string title = metric_words(reported.name).words + " by " + parameter;
    const SvgDocument picture =
        levels.binned ? dot_picture(reported, levels, parameter, title) : box_picture(reported, levels, title);
    const std::string figures = page_text(effect_figures(effect));
    return fmt::format(
        "<figure><figcaption><b>by {}</b><br/><span class=\"{}\">{}</span>{}{}</figcaption>\n{}</figure>\n",
        page_text(parameter), effect.seen() ? "seen" : "faint", effect_words(effect), figures.empty() ? "" : ": ",
        figures, picture.element());
}

std::string metric_sections(const CampaignResults& results, const CampaignSummary& summary) {
    std::string text = "<h2>Metrics</h2>\n";
    if (summary.metrics.empty()) return text + "<p>The runs gave no metrics.</p>\n";
    for (std::size_t i = 0; i < summary.metrics.size(); ++i)
        text += metric_section(results, summary, summary.metrics[i], i < most_pictured_metrics);
    if (summary.metrics.size() > most_pictured_metrics)
        text +=
            fmt::format("<p class=\"faint\">Pictures are drawn of the first {} metrics.</p>\n", most_pictured_metrics);
    return text;
}

}  // namespace skyloop::inline campaigns
