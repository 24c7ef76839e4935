#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "base/core/files.hpp"
#include "base/core/words.hpp"
#include "base/time/utc_time.hpp"
#include "campaigns/fit/baseline_fit.hpp"
#include "commands.hpp"
#include "data_folders.hpp"
#include "file_streams.hpp"
#include "fit_logs.hpp"
#include "run/scenario/modern_settings.hpp"
#include "run_options.hpp"
#include "run_session.hpp"
#include "study/plot/scatter_plot.hpp"

namespace skyloop::host {
namespace {

void print_model(std::string_view what, const BaselineFractions& fractions, const SampleStatistics& model,
                 const StandingLog& log) {
    fmt::print("{:<12}iono_fraction {:.6g}, tropo_fraction {:.6g}: {}; {}\n", what, fractions.iono, fractions.tropo,
               figures_text(model), percent_of(model, log).text());
}

// Everything that was computed.
struct FitResult {
    BaselineRun before, after;
    BaselineFit fit;
    std::vector<SampleStatistics> other_seeds;
    std::vector<BaselineRun> checks;  // with the fitted fractions, each where and when its log was made
};

constexpr std::uint64_t last_seed = 6;  // the scenario has 1; the others tell how much of the fit is chance

Result<FitResult> compute(const FitLogs& logs, const FitOptions& options, FitProgress& progress) {
    FitConditions conditions = conditions_of(logs.log, options);
    progress.expect(static_cast<double>(last_seed + 1) * logs.log.length.value());
    for (const StandingLog& log : logs.checks)
        progress.expect(log.length.value());
    FitResult result;
    const DataFolders data = data_folders();
    auto before = run_baseline(conditions, BaselineFractions::calibrated(), data, progress.watch());
    if (!before) return fail(before.error());
    result.before = std::move(*before);
    result.fit = fit_fractions(result.before, logs.log.horizontal);
    auto after = run_baseline(conditions, result.fit.fractions, data, progress.watch());
    if (!after) return fail(after.error());
    result.after = std::move(*after);
    while (conditions.seed < last_seed) {
        ++conditions.seed;
        const auto other = run_baseline(conditions, result.fit.fractions, data, progress.watch());
        if (!other) return fail(other.error());
        result.other_seeds.push_back(figures_of(other->errors.horizontal));
    }
    for (const StandingLog& log : logs.checks) {
        auto check = run_baseline(conditions_of(log, options), result.fit.fractions, data, progress.watch());
        if (!check) return fail(check.error());
        result.checks.push_back(std::move(*check));
    }
    return result;
}

// The fitted model where and when another log was made, beside what the preset makes of that, and the run that was
// fitted as it stands.
void print_check(const StandingLog& log, const BaselineRun& run, const SampleStatistics& fitted_run) {
    fmt::print("check       {} ({}): {}\n", on_a_terminal(log.series.name), utc_text(*log.start),
               figures_text(log.horizontal));
    const BaselineFractions preset = BaselineFractions::calibrated();
    fmt::print("            calibrated: {}\n", percent_of(figures_of(run.horizontal_with(preset)), log).text());
    fmt::print("            fitted: {}\n", percent_of(figures_of(run.errors.horizontal), log).text());
    fmt::print("            the fitted run itself: {}\n", percent_of(fitted_run, log).text());
}

void print_result(const FitLogs& logs, const FitResult& result) {
    fmt::print("orbits      {}\n", result.before.navigation);
    print_model("strict", BaselineFractions::strict(),
                figures_of(result.before.horizontal_with(BaselineFractions::strict())), logs.log);
    print_model("calibrated", result.before.fractions, figures_of(result.before.errors.horizontal), logs.log);
    print_model("fitted", result.after.fractions, figures_of(result.after.errors.horizontal), logs.log);
    double least = percent_of(result.other_seeds.front(), logs.log).difference, most = least;
    for (const SampleStatistics& other : result.other_seeds) {
        least = std::min(least, percent_of(other, logs.log).difference);
        most = std::max(most, percent_of(other, logs.log).difference);
    }
    fmt::print("seeds 2-{}   difference {:.1f} to {:.1f} %\n", last_seed, least, most);
    for (std::size_t i = 0; i < logs.checks.size(); ++i)
        print_check(logs.checks[i], result.checks[i], figures_of(result.after.errors.horizontal));
}

std::string scenario_text(const FitLogs& logs, const FitResult& result, const FitOptions& options) {
    const auto difference = [&](const BaselineRun& run) {
        return percent_of(figures_of(run.errors.horizontal), logs.log).difference;
    };
    const std::string remarks = fmt::format(
        "# Made by skyloop fit of {}, {} fixes of a receiver at rest.\n"
        "# By the article's measure of the horizontal error the sensor model baseline differs by {:.1f} % from it, "
        "where\n"
        "# the preset calibrated differs by {:.1f} %.\n",
        on_a_terminal(logs.log.series.name), logs.log.series.fixes(), difference(result.after),
        difference(result.before));
    return baseline_scenario(conditions_of(logs.log, options), result.after.fractions, remarks);
}

Result<FitOutput> fit_baseline_model(const FitLogs& logs, const FitOptions& options, FitProgress& progress) {
    auto result = compute(logs, options, progress);
    if (!result) return fail(result.error());
    FitOutput output;
    output.warnings = result->before.warnings;
    if (result->fit.at_limit)
        output.warnings.push_back(
            fmt::format("the fractions end at {:g}, and the receiver's errors are larger than the model's "
                        "with them",
                        largest_fraction));
    output.scenario = scenario_text(logs, *result, options);
    output.cloud = {"baseline, fitted", result->after.errors};
    output.print = [&logs, found = std::move(*result)] { print_result(logs, found); };
    return output;
}

// What only the modern model has is refused beside baseline, by CLI11's way of saying so.
void add_model_options(CLI::App& command, FitOptions& options) {
    const std::vector<std::string> presets(std::begin(modern_preset_names), std::end(modern_preset_names));
    const std::vector<std::string> places(std::begin(surroundings_names), std::end(surroundings_names));
    const std::vector<std::string> systems(constellation_names.begin(), constellation_names.end());
    command
        .add_option("--model", options.model,
                    "baseline: the two fractions of its delays; modern: surroundings and scales of causes")
        ->check(CLI::IsMember({"baseline", "modern"}))
        ->capture_default_str();
    command.add_option("--preset", options.preset, "Of the modern model: what kind of receiver it is")
        ->check(CLI::IsMember(presets))
        ->capture_default_str();
    command.add_option("--board", options.board,
                       "Of the modern model: the receiver's profile, as `skyloop boards` has them");
    command
        .add_option("--constellations", options.constellations,
                    "Of the modern model: systems that the receiver uses, with commas; default: the board's")
        ->delimiter(',')
        ->check(CLI::IsMember(systems));
    command
        .add_option("--surroundings", options.surroundings,
                    "Of the modern model: what is around the antenna; default: what fits best")
        ->check(CLI::IsMember(places));
}

}  // namespace

Action add_fit_command(CLI::App& app) {
    CLI::App* command = app.add_subcommand(
        "fit", "Fit a model's errors to those of a receiver's log at rest: a scenario, percentages, a figure");
    auto options = std::make_shared<FitOptions>();
    command
        ->add_option("LOG", options->log,
                     "A receiver's output, RTKLIB .pos, CSV or track, of 10 minutes or more without gaps")
        ->required();
    add_model_options(*command, *options);
    command
        ->add_option("--nav", options->nav, "RINEX navigation file of that day; default: the nominal sky; repeatable")
        ->allow_extra_args(false);
    command->add_option("--start", options->start, "Time of the first fix, UTC, of logs that tell no date");
    command->add_option("--interval", options->interval, "Seconds between the fixes of logs without times")
        ->check(CLI::Range(1e-3, 1e6));
    command->add_option("--reference", options->reference,
                        "Where the antenna was: LAT,LON,HEIGHT; default: the mean of the fixes");
    command->add_option("--skip", options->skip, "Leave out the first N fixes of LOG");
    command->add_option("--count", options->count, "Take at most N fixes of LOG");
    command
        ->add_option("--check", options->check,
                     "Another log at rest, with which the fitted model is compared at its place and time; repeatable")
        ->allow_extra_args(false);
    command->add_flag("--check-rest", options->check_rest,
                      "Compare it with what follows in LOG, too, in parts of --count fixes");
    command->add_option("--out", options->out, "Folder for fit.toml and fit.svg; default: this one");
    add_verbosity_options(*command, options->verbosity);
    return [options] { return fit_logs(*options, options->model == "modern" ? fit_modern_model : fit_baseline_model); };
}

}  // namespace skyloop::host
