#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include "base/core/files.hpp"
#include "base/core/words.hpp"
#include "base/time/utc_time.hpp"
#include "campaigns/fit/modern_fit.hpp"
#include "data_folders.hpp"
#include "file_streams.hpp"
#include "fit_logs.hpp"
#include "run_options.hpp"
#include "run_session.hpp"
#include "study/plot/scatter_plot.hpp"

namespace skyloop::host {
namespace {

// Of a word that the command line has checked.
template <class Enum, std::size_t N>
Enum meant(const std::string_view (&names)[N], std::string_view word) {
    return static_cast<Enum>(std::find(std::begin(names), std::end(names), word) - std::begin(names));
}

ModernFitRequest request_of(const StandingLog& log, const FitOptions& options) {
    ModernFitRequest request{conditions_of(log, options), {}};
    request.receiver.preset = meant<ModernPreset>(modern_preset_names, options.preset);
    request.receiver.board = options.board;
    request.receiver.constellations = options.constellations;
    if (!options.surroundings.empty())
        request.surroundings = meant<Surroundings>(surroundings_names, options.surroundings);
    return request;
}

// Everything that was computed.
struct ModernFitResult {
    FitTarget target;
    ModernFit fit;
    struct Check {
        FitTarget target;
        ModernRun before, after;  // each where and when its log was made
    };
    std::vector<Check> checks;
};

Result<ModernFitResult> compute_modern(const FitLogs& logs, const FitOptions& options, FitProgress& progress) {
    const ModernFitRequest request = request_of(logs.log, options);
    progress.expect(static_cast<double>(most_runs(request)) * logs.log.length.value());
    for (const StandingLog& log : logs.checks)
        progress.expect(2 * log.length.value());
    const DataFolders data = data_folders();
    ModernFitResult result{target_of(logs.log), {}, {}};
    auto fit = fit_modern(request, result.target, data, progress.watch());
    if (!fit) return fail(fit.error());
    result.fit = std::move(*fit);
    for (const StandingLog& log : logs.checks) {
        const FitConditions conditions = conditions_of(log, options);
        auto before = run_modern(conditions, request.receiver, {}, data, progress.watch());
        if (!before) return fail(before.error());
        auto after = run_modern(conditions, request.receiver, result.fit.after.settings, data, progress.watch());
        if (!after) return fail(after.error());
        result.checks.push_back({target_of(log), std::move(*before), std::move(*after)});
    }
    return result;
}

std::string_view place_name(const ModernFitSettings& settings) {
    return surroundings_names[static_cast<std::size_t>(settings.surroundings)];
}

std::string settings_text(const ModernFitSettings& settings) {
    std::string text(place_name(settings));
    for (std::size_t cause = 0; cause < fitted_causes.size(); ++cause)
        if (acts(cause, settings.surroundings))
            text += fmt::format(", {} {:.3g}", fitted_causes[cause], settings.scales[cause]);
    return settings.weaker.value() == 0 ? text : text + fmt::format(", signals {:+.1f} dB", -settings.weaker.value());
}

ComparisonPercent percent_of_run(const ModernRun& run, const StandingLog& log, bool placed) {
    return percent_of(figures_of(run.errors(placed).horizontal), log);
}

void print_row(std::string_view name, std::string_view log, std::string_view before, std::string_view after) {
    if (!log.empty()) fmt::print("            {:<30}{:>8}{:>8}{:>8}\n", name, log, before, after);
}

void print_figures(const FitFigures& log, const FitFigures& before, const FitFigures& after) {
    const auto of_log = told_figures(log), of_before = told_figures(before), of_after = told_figures(after);
    print_row("", "log", "before", "fitted");
    for (std::size_t i = 0; i < of_log.size(); ++i)
        print_row(of_log[i].name, of_log[i].value, of_before[i].value, of_after[i].value);
}

void print_signals(const FitTarget& log, const ModernRun& before, const ModernRun& after) {
    const auto mean = [](const RunningStatistics& s) { return s.n() == 0 ? "" : fmt::format("{:.1f}", s.mean()); };
    for (std::size_t i = 0; i < SignalStrengthByElevation::bins; ++i)
        print_row(fmt::format("C/N0 at {} to {} degrees, dB-Hz", 10 * i, 10 * (i + 1)), mean(log.signals.bin(i)),
                  mean(before.signals.bin(i)), mean(after.signals.bin(i)));
    print_row("satellites used", mean(log.satellites_used), mean(before.satellites_used), mean(after.satellites_used));
}

void print_seeds(const ModernTrial& trial, const StandingLog& log, bool placed) {
    std::string text;
    for (const ModernRun& run : trial.runs)
        text += fmt::format("{}{:.1f}", text.empty() ? "" : ", ", percent_of_run(run, log, placed).difference);
    fmt::print("            by the article's measure: difference {} % (a number for each seed)\n", text);
}

void print_result(const FitLogs& logs, const ModernFitResult& result) {
    const ModernFit& fit = result.fit;
    const bool placed = result.target.placed;
    fmt::print("orbits      {}\n", fit.before.runs.front().notes.navigation);
    for (const ModernTrial& one : fit.tried)
        fmt::print("tried       {:<16}misfit {:.2f}, but for the size of errors {:.2f}\n", place_name(one.settings),
                   one.misfit, one.unlikeness);
    fmt::print("before      {}: misfit {:.2f}\n", settings_text(fit.before.settings), fit.before.misfit);
    print_seeds(fit.before, logs.log, placed);
    fmt::print("fitted      {}: misfit {:.2f}\n", settings_text(fit.after.settings), fit.after.misfit);
    print_seeds(fit.after, logs.log, placed);
    print_figures(result.target.figures, fit.before.figures, fit.after.figures);
    print_signals(result.target, fit.before.runs.front(), fit.after.runs.front());
    for (std::size_t i = 0; i < result.checks.size(); ++i) {
        const auto& check = result.checks[i];
        const StandingLog& log = logs.checks[i];
        const bool here = check.target.placed;
        fmt::print("check       {} ({}): before {}; fitted {}\n", on_a_terminal(log.series.name), utc_text(*log.start),
                   percent_of_run(check.before, log, here).text(), percent_of_run(check.after, log, here).text());
        print_figures(check.target.figures, check.before.figures(here), check.after.figures(here));
    }
}

}  // namespace

Result<FitOutput> fit_modern_model(const FitLogs& logs, const FitOptions& options, FitProgress& progress) {
    auto result = compute_modern(logs, options, progress);
    if (!result) return fail(result.error());
    const ModernFitRequest request = request_of(logs.log, options);
    const ModernTrial& after = result->fit.after;
    const std::string remarks = fmt::format(
        "# Made by skyloop fit --model modern of {}, {} fixes of a receiver at rest.\n"
        "# Misfit of the figures {:.2f}, of the preset under an open sky {:.2f} (1: as two hours of one receiver).\n",
        on_a_terminal(logs.log.series.name), logs.log.series.fixes(), after.misfit, result->fit.before.misfit);
    FitOutput output;
    output.warnings = result->fit.before.runs.front().notes.warnings;
    output.scenario = modern_scenario(request.conditions, request.receiver, after.settings, remarks);
    output.cloud = {"modern, fitted", after.runs.front().errors(result->target.placed)};
    output.print = [&logs, found = std::move(*result)] { print_result(logs, found); };
    return output;
}

}  // namespace skyloop::host
