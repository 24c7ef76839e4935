#include "campaigns/campaign_report/campaign_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <system_error>

#include "base/core/files.hpp"
#include "detail/shown_names.hpp"

namespace skyloop::inline campaigns {
namespace {

// What the campaign itself goes on with.
bool is_kept_by_campaign(const std::filesystem::path& file, const std::filesystem::path& folder) {
    std::error_code none;
    const auto inside = std::filesystem::weakly_canonical(file, none)
                            .lexically_relative(std::filesystem::weakly_canonical(folder, none));
    return inside == "campaign.json" || inside == "campaign.sqlite" || (!inside.empty() && *inside.begin() == "shards");
}

Result<void> check_targets(const std::filesystem::path& folder, const WrittenCampaignReport& report,
                           const std::filesystem::path& junit) {
    if (report.json == report.html)
        return fail(
            ErrorCode::usage,
            fmt::format("{}: a page does not end in .json; expected a name such as report.html", report.html.string()));
    if (junit == report.html || junit == report.json)
        return fail(ErrorCode::usage, fmt::format("--junit {}: is the page or its numbers; expected a name such as "
                                                  "junit.xml",
                                                  junit.string()));
    for (const std::filesystem::path* file : {&report.html, &report.json})
        if (is_kept_by_campaign(*file, folder))
            return fail(ErrorCode::usage, fmt::format("--out {}: {} is the campaign's own; expected a name such as "
                                                      "report.html",
                                                      report.html.string(), file->string()));
    if (!junit.empty() && is_kept_by_campaign(junit, folder))
        return fail(
            ErrorCode::usage,
            fmt::format("--junit {}: is the campaign's own; expected a name such as junit.xml", junit.string()));
    return {};
}

// Whether a part has added to its results since they were gathered.
bool is_outdated(const std::filesystem::path& database, const std::filesystem::path& shards) {
    std::error_code none;
    const auto gathered = std::filesystem::last_write_time(database, none);
    for (const auto& part : std::filesystem::directory_iterator(shards, none))
        if (part.last_write_time(none) > gathered) return true;
    return false;
}

}  // namespace

Result<WrittenCampaignReport> write_campaign_report(const std::filesystem::path& folder,
                                                    const CampaignReportOptions& options) {
    WrittenCampaignReport written;
    written.html = options.html.empty() ? folder / "report.html" : options.html;
    written.json = written.html;
    written.json.replace_extension(".json");
    if (const auto targets = check_targets(folder, written, options.junit); !targets) return fail(targets.error());
    written.outdated = is_outdated(folder / "campaign.sqlite", folder / "shards");
    const auto results = read_campaign_results(folder / "campaign.sqlite");
    if (!results) return fail(results.error());
    const CampaignSummary summary = summarise(*results, options.worst);
    if (const auto kept = replace_file(written.html, campaign_report_html(*results, summary)); !kept)
        return fail(kept.error());
    written.text = campaign_report_text(*results, summary);
    // Beside a device or a pipe there is no place for a second file.
    std::error_code none;
    if (!std::filesystem::is_regular_file(written.html, none))
        written.json.clear();
    else if (const auto kept = replace_file(written.json, campaign_report_json(*results, summary)); !kept)
        return fail(kept.error());
    if (!options.junit.empty())
        if (const auto kept = replace_file(options.junit, campaign_report_junit(*results, summary)); !kept)
            return fail(kept.error());
    return written;
}

namespace {

constexpr std::size_t most_text_lines = 20;  // of each part

// As many characters as UTF-8 has, filled up: fmt counts the width of bytes in older versions.
std::string padded(std::string text, std::size_t width) {
    const auto characters =
        static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xC0) != 0x80; }));
    if (characters < width) text.append(width - characters, ' ');
    return text;
}

std::string more_line(std::size_t shown, std::size_t all) {
    return all > shown ? fmt::format("  … and {} more\n", all - shown) : std::string();
}

std::string verdict_lines(const CampaignResults& results, const CampaignSummary& summary) {
    std::string text;
    const std::size_t shown = std::min(summary.verdicts.size(), most_text_lines);
    for (std::size_t i = 0; i < shown; ++i) {
        const VerdictSummary& verdict = summary.verdicts[i];
        const Rate& rate = verdict.rate;
        if (rate.count.trials == 0) {
            text += fmt::format("  {} no run came to an end\n", padded(verdict_name(results, verdict), 36));
            continue;
        }
        text += fmt::format("  {} {} of {} = {} (95 % interval {}, {})\n", padded(verdict_name(results, verdict), 36),
                            rate.count.passed, rate.count.trials, percent_text(rate.share()),
                            percent_interval_text(rate.interval), rate.exact ? "Clopper–Pearson" : "Wilson");
    }
    return text + more_line(shown, summary.verdicts.size());
}

std::string metric_lines(const CampaignResults& results, const CampaignSummary& summary) {
    std::string text;
    const std::size_t shown = std::min(summary.metrics.size(), most_text_lines);
    for (std::size_t i = 0; i < shown; ++i) {
        const MetricSummary& metric = summary.metrics[i];
        const MetricWords words = metric_words(results.metrics[metric.metric].name);
        text += "  " + padded(words.axis(), 36);
        if (metric.percentiles.empty()) {
            text += " no value\n";
            continue;
        }
        text += fmt::format(" p50 {}  p95 {} ({})  max {}  n {}\n", figure_text(metric.percentiles[1].value),
                            figure_text(metric.percentiles[2].value), interval_text(metric.percentiles[2].interval),
                            figure_text(metric.sorted.back()), metric.sorted.size());
    }
    return text + more_line(shown, summary.metrics.size());
}

struct SeenEffect {
    double strength = 0;
    std::string line;
};

std::string effect_lines(const CampaignResults& results, const CampaignSummary& summary) {
    std::vector<SeenEffect> seen;
    const auto take = [&](const std::string& what, const std::vector<Effect>& effects) {
        for (const Effect& effect : effects)
            if (effect.seen())
                seen.push_back(
                    {effect.strength,
                     fmt::format("  {} {}\n", padded(what, 36),
                                 effect_words(effect, shown_text(results.parameters[effect.parameter].name, 80)))});
    };
    for (const VerdictSummary& verdict : summary.verdicts)
        take(verdict_name(results, verdict), verdict.effects);
    for (const MetricSummary& metric : summary.metrics)
        take(metric_words(results.metrics[metric.metric].name).words, metric.effects);
    std::stable_sort(seen.begin(), seen.end(),
                     [](const SeenEffect& a, const SeenEffect& b) { return a.strength > b.strength; });
    std::string text;
    const std::size_t shown = std::min(seen.size(), most_text_lines);
    for (std::size_t i = 0; i < shown; ++i)
        text += seen[i].line;
    return text + more_line(shown, seen.size());
}

std::string failed_lines(const CampaignResults& results, const CampaignSummary& summary) {
    std::string text;
    const std::size_t shown = std::min<std::size_t>(summary.failed_runs.size(), 5);
    for (std::size_t i = 0; i < shown; ++i) {
        const GatheredRun& run = results.runs[summary.failed_runs[i]];
        text += fmt::format("  run {} (seed {}): {}\n", run.number, run.seed,
                            replay_command(results, run).value_or(std::string(run_status_word(run.status))));
    }
    return text + more_line(shown, summary.failed_runs.size());
}

}  // namespace

std::string campaign_report_text(const CampaignResults& results, const CampaignSummary& summary) {
    std::string text =
        fmt::format("campaign {}: {} of {} runs done, {} passed, {} failed, {} errors\n",
                    results.name.empty() ? "without a name" : shown_text(results.name, 80), results.runs.size(),
                    results.planned ? fmt::format("{}", *results.planned) : "an unknown number of", summary.passed,
                    summary.failed, summary.errors);
    if (summary.missing.value_or(0) > 0) text += fmt::format("missing runs: {}\n", *summary.missing);
    text += "verdicts:\n" + verdict_lines(results, summary);
    if (!summary.metrics.empty()) text += "metrics (95 % interval of p95):\n" + metric_lines(results, summary);
    if (const std::string effects = effect_lines(results, summary); !effects.empty())
        text += "what moves them:\n" + effects;
    if (!summary.failed_runs.empty())
        text += (results.vehicle.empty() ? "failed runs, and how to replay them:\n"
                                         : "failed runs (with a vehicle; not replayed):\n") +
                failed_lines(results, summary);
    return text;
}

}  // namespace skyloop::inline campaigns
