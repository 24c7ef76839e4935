#include <fmt/format.h>

#include <algorithm>

#include "base/core/words.hpp"
#include "campaigns/campaign_report/campaign_report.hpp"
#include "detail/page_parts.hpp"
#include "detail/shown_names.hpp"
#include "study/plot/svg_document.hpp"

namespace skyloop::inline campaigns {
namespace {

std::string tile(std::string_view name, const std::string& figure, const std::string& note, bool warns = false) {
    return fmt::format("<div class=\"tile{}\"><span>{}</span><b>{}</b><small>{}</small></div>\n", warns ? " warns" : "",
                       name, figure, note);
}

std::string part_of(std::uint64_t part, const std::optional<std::uint64_t>& planned) {
    if (!planned || *planned == 0) return "";
    return percent_text(static_cast<double>(part) / static_cast<double>(*planned)) + " of those planned";
}

std::string tiles(const CampaignResults& results, const CampaignSummary& summary) {
    const Rate& all = summary.verdicts.front().rate;
    std::string text = "<div class=\"tiles\">\n";
    text += tile("planned", results.planned ? fmt::format("{}", *results.planned) : "not told", "runs");
    text += tile("done", fmt::format("{}", results.runs.size()), part_of(results.runs.size(), results.planned));
    text += tile("missing", summary.missing ? fmt::format("{}", *summary.missing) : "not told",
                 summary.missing ? part_of(*summary.missing, results.planned) : "", summary.missing.value_or(0) > 0);
    text += tile("errors", fmt::format("{}", summary.errors), "runs without an end", summary.errors > 0);
    text += tile("failed", fmt::format("{}", summary.failed), "runs with a failed check", summary.failed > 0);
    text += tile("all checks passed", all.count.trials > 0 ? percent_text(all.share()) : "–",
                 all.count.trials > 0 ? percent_interval_text(all.interval) : "no run came to an end");
    return text + "</div>\n";
}

std::string fact(std::string_view name, const std::string& value) {
    if (value.empty()) return {};
    return fmt::format("<tr><th>{}</th><td><code>{}</code></td></tr>\n", name, page_text(value));
}

std::string swept(const CampaignResults& results, const CampaignSummary& summary) {
    std::string text;
    for (std::size_t i = 0; i < results.parameters.size(); ++i) {
        const ParameterLevels& levels = summary.levels[i];
        std::string values;
        if (levels.binned)
            values = fmt::format("{} different numbers, {} … {}", levels.distinct,
                                 figure_text(levels.levels.front().low), figure_text(levels.levels.back().high));
        else
            for (const ParameterLevel& level : levels.levels)
                values += (values.empty() ? "" : ", ") + level.label;
        if (levels.not_shown > 0) values += fmt::format(", … ({} different values)", levels.distinct);
        text += fmt::format("<tr><th>varied</th><td><code>{}</code>: {}</td></tr>\n",
                            page_text(results.parameters[i].name), page_text(values, 600));
    }
    return text;
}

std::string seeds_of(const CampaignResults& results) {
    if (results.runs.empty()) return {};
    auto [least, most] =
        std::minmax_element(results.runs.begin(), results.runs.end(),
                            [](const GatheredRun& a, const GatheredRun& b) { return a.seed < b.seed; });
    return least->seed == most->seed ? fmt::format("{}", least->seed) : fmt::format("{} … {}", least->seed, most->seed);
}

std::string what_was_run(const CampaignResults& results, const CampaignSummary& summary) {
    std::string text = "<div class=\"scroll\"><table class=\"facts\">\n";
    text += fact("scenario", results.scenario);
    text += fact("digest of the scenario", results.scenario_digest);
    text += fact("options", shell_quoted(results.options));
    text += fact("plan", results.campaign_file);
    text += fact("program", results.program_version.empty() ? "" : "skyloop " + results.program_version);
    text += fact("seeds", seeds_of(results));
    return text + swept(results, summary) + "</table></div>\n";
}

std::string notices(const CampaignResults& results, const CampaignSummary& summary) {
    std::string text;
    const auto notice = [&](const std::string& words) { text += "<p class=\"notice\">" + words + "</p>\n"; };
    if (results.runs.empty()) notice("No run is in the database: there is nothing to tell yet.");
    if (summary.missing.value_or(0) > 0)
        notice(
            fmt::format("{} of {} planned runs are missing: what is told is of a part of the campaign. The same "
                        "<code>skyloop campaign</code> command runs the rest.",
                        *summary.missing, *results.planned));
    if (results.planned && *results.planned < results.runs.size())
        notice(
            fmt::format("There are {} runs, more than the {} planned: results of another plan may lie in this folder.",
                        results.runs.size(), *results.planned));
    if (summary.errors > 0)
        notice(fmt::format("Runs that came to no end ({}) count in no rate and no distribution.", summary.errors));
    return text;
}

}  // namespace

std::string page_text(std::string_view text, std::size_t most) { return svg_escape(shown_text(text, most)); }

std::string campaign_report_html(const CampaignResults& results, const CampaignSummary& summary) {
    const std::string name = results.name.empty() ? "Campaign" : page_text(results.name);
    std::string page = fmt::format(
        "<!DOCTYPE html>\n<html xmlns=\"http://www.w3.org/1999/xhtml\" lang=\"en\">\n<head>\n"
        "<meta charset=\"utf-8\"/>\n"
        "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src 'unsafe-inline'\"/>\n"
        "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>\n"
        "<meta name=\"color-scheme\" content=\"light dark\"/>\n"
        "<title>{} · skyloop campaign</title>\n<style>\n{}</style>\n</head>\n<body>\n<main>\n<h1>{}</h1>\n",
        name, style_sheet(), name);
    page += tiles(results, summary) + notices(results, summary) + what_was_run(results, summary);
    page += verdict_section(results, summary);
    page += effect_section(results, summary);
    page += metric_sections(results, summary);
    page += rate_sections(results, summary);
    page += failed_run_section(results, summary);
    page += method_section(summary);
    return page + "</main>\n</body>\n</html>\n";
}

namespace {

constexpr std::string_view light_sheet = R"(:root {
  --ink: #1f2933; --faint: #5f6b7a; --line: #cbd3dd; --soft: #e3e8ef; --paper: #ffffff; --panel: #f6f8fb;
  --accent: #b4540a; --series: #1f5fbf; --good: #0a8f72; --bad: #b3403a;
}
body { margin: 0; background: var(--panel); color: var(--ink);
  font: 15px/1.5 system-ui, -apple-system, 'Segoe UI', Roboto, 'DejaVu Sans', Arial, sans-serif; }
main { max-width: 920px; margin: 0 auto; padding: 28px 24px 60px; }
h1 { font-size: 26px; margin: 0 0 18px; } h2 { font-size: 20px; margin: 44px 0 10px; }
h3 { font-size: 16px; margin: 34px 0 8px; } p { margin: 8px 0; max-width: 74ch; }
.tiles { display: grid; grid-template-columns: repeat(auto-fit, minmax(138px, 1fr)); gap: 10px; }
.tile { background: var(--paper); border: 1px solid var(--line); border-radius: 10px; padding: 10px 14px; }
.tile span, .tile small { display: block; color: var(--faint); font-size: 12.5px; }
.tile b { font-size: 23px; font-weight: 600; font-variant-numeric: tabular-nums; }
.tile.warns b { color: var(--bad); }
.notice { border-left: 4px solid var(--accent); background: var(--paper); padding: 8px 14px; max-width: none; }
.scroll { overflow-x: auto; }
table { border-collapse: collapse; margin: 10px 0; font-size: 13.5px; font-variant-numeric: tabular-nums; }
th, td { text-align: left; padding: 4px 14px 4px 0; border-bottom: 1px solid var(--soft); vertical-align: top; }
th { font-weight: 600; } thead th { color: var(--faint); font-weight: 500; border-bottom-color: var(--line); }
td.n, th.n { text-align: right; white-space: nowrap; }
table.facts th { color: var(--faint); font-weight: 500; white-space: nowrap; }
table.facts td { overflow-wrap: anywhere; }
code { font: 12.5px/1.4 ui-monospace, 'DejaVu Sans Mono', Menlo, Consolas, monospace; }
td code.command { white-space: nowrap; user-select: all; background: var(--soft); border-radius: 4px; padding: 1px 6px; }
svg { display: block; width: 100%; height: auto; }
.pair { display: grid; grid-template-columns: repeat(auto-fill, minmax(min(440px, 100%), 1fr)); gap: 16px 20px; align-items: start; }
figure { margin: 10px 0; } figcaption { font-size: 13px; color: var(--faint); margin: 0 0 6px; min-height: 2.9em; }
figcaption b { color: var(--ink); font-weight: 600; }
.seen { color: var(--accent); font-weight: 600; } .faint { color: var(--faint); }
summary { cursor: pointer; color: var(--series); margin: 8px 0; }
)";

constexpr std::string_view dark_sheet = R"(@media (prefers-color-scheme: dark) {
:root {
  --ink: #e4e9ef; --faint: #9aa7b5; --line: #3a4653; --soft: #2b3540; --paper: #161c23; --panel: #10151b;
  --accent: #ec9a55; --series: #6ba3f5; --good: #3cc3a0; --bad: #f0817a;
}
)";

constexpr std::string_view print_sheet =
    R"(@media print { body { background: none; } figure, tr { break-inside: avoid; } }
)";

}  // namespace

std::string style_sheet() {
    std::string sheet(light_sheet);
    sheet += print_sheet;
    sheet += dark_sheet;
    return sheet + dark_picture_rules() + "}\n";
}

}  // namespace skyloop::inline campaigns
