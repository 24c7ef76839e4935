#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <utility>

#include "base/core/files.hpp"
#include "base/core/words.hpp"
#include "base/time/utc_time.hpp"
#include "campaigns/fit/baseline_fit.hpp"
#include "commands.hpp"
#include "data_folders.hpp"
#include "file_streams.hpp"
#include "run_options.hpp"
#include "run_session.hpp"
#include "study/analysis/standing_log.hpp"
#include "study/plot/scatter_plot.hpp"

namespace skyloop::host {
namespace {

struct FitOptions {
    std::string log, start, reference, out = ".";
    std::vector<std::string> nav, check;
    double interval = 0;  // s; 0: as the logs say
    std::size_t skip = 0, count = 0;
    bool check_rest = false;
    Verbosity verbosity;
};

// Of one terminal line, rewritten, and asked after each epoch whether the user wants to stop.
class FitProgress {
public:
    explicit FitProgress(const Messages& messages)
        : shown_(!messages.verbosity().quiet && !messages.verbosity().json && ::isatty(STDERR_FILENO) != 0) {}
    ~FitProgress() { clear(); }
    FitProgress(const FitProgress&) = delete;
    FitProgress& operator=(const FitProgress&) = delete;

    void expect(double epochs) { expected_ += epochs; }
    [[nodiscard]] FitWatch watch() {
        return {&stop_, [this] { count(); }};
    }
    void clear() const {
        if (shown_ && done_ > 0) say("\r\x1b[K");
    }

private:
    void count() {
        ++done_;
        stop_ = stop_was_asked();
        const auto now = std::chrono::steady_clock::now();
        if (!shown_ || now - last_ < std::chrono::milliseconds(200)) return;
        last_ = now;
        say(fmt::format("\r\x1b[Krunning the model: {:.0f} %",
                        100 * std::min(1.0, static_cast<double>(done_) / expected_)));
    }

    bool shown_;
    std::atomic<bool> stop_{false};
    std::uint64_t done_ = 0;
    double expected_ = 1;
    std::chrono::steady_clock::time_point last_{};
};

// How the logs are to be read.
struct LogReading {
    std::unique_ptr<Geoid> geoid;
    std::optional<Geodetic> reference;
    std::optional<GpsTime> start;
    double interval = 0;
};

Result<LogReading> reading_of(const FitOptions& options) {
    LogReading reading;
    std::vector<std::string> unused;
    reading.geoid = find_geoid(data_folders(), unused);
    reading.interval = options.interval;
    if (!options.reference.empty()) {
        const auto place = parse_reference(options.reference);
        if (!place) return fail(place.error());
        reading.reference = *place;
    }
    if (!options.start.empty()) {
        const auto utc = parse_utc(options.start);
        if (!utc) return fail(utc.error().code, "--start: " + utc.error().message);
        reading.start = to_gps_time(*utc, LeapSeconds::announced());
    }
    return reading;
}

// A log with the time of each fix.
Result<FixSeries> read_dated(const std::string& path, const LogReading& reading, const Messages& messages) {
    auto series = read_fix_series(path, reading.geoid.get());
    if (!series) return series;
    messages.warnings(series->warnings);
    if (reading.interval > 0 && series->interval)
        messages.warning(fmt::format("{}: has times of its own, one fix every {:g} s; --interval is not used", path,
                                     series->interval->value()));
    else if (reading.interval > 0)
        series->interval = Seconds(reading.interval);
    if (series->dated && reading.start)
        messages.warning(fmt::format("{}: has dates of its own; --start is not used", path));
    if (!series->interval)
        return fail(ErrorCode::usage,
                    fmt::format("{}: has no times; expected --interval with the seconds between its fixes", path));
    if (!series->dated && !reading.start)
        return fail(ErrorCode::usage,
                    fmt::format("{}: tells no date; expected --start with the time of its first fix in UTC", path));
    return reading.start ? dated_from(std::move(*series), *reading.start) : std::move(*series);
}

// What is fitted to, and what the fit is held against.
struct FitLogs {
    StandingLog log;
    std::vector<StandingLog> checks;
};

Result<std::vector<StandingLog>> rest_of(const FixSeries& whole, const FitOptions& options, const LogReading& reading,
                                         const Messages& messages) {
    std::vector<StandingLog> checks;
    if (!options.check_rest) return checks;
    const FixSeries rest = slice(whole, {options.skip + options.count, 1, 0});
    for (FixSeries& part : windows(rest, options.count)) {
        part.name =
            fmt::format("{}, fixes {} to {}", whole.name, options.skip + options.count * (checks.size() + 1) + 1,
                        options.skip + options.count * (checks.size() + 2));
        auto standing = standing_log(std::move(part), reading.reference);
        if (!standing) return fail(standing.error());
        checks.push_back(std::move(*standing));
    }
    if (checks.empty())
        messages.warning(fmt::format("{}: --check-rest: {} fixes are left, fewer than --count {}", whole.name,
                                     rest.fixes(), options.count));
    return checks;
}

Result<FitLogs> read_logs(const FitOptions& options, const Messages& messages) {
    const auto reading = reading_of(options);
    if (!reading) return fail(reading.error());
    const auto whole = read_dated(options.log, *reading, messages);
    if (!whole) return fail(whole.error());
    FixSeries part = slice(*whole, {options.skip, 1, options.count});
    if (part.fixes() == 0)
        return fail(ErrorCode::usage, fmt::format("--skip {}: {} has {} fixes; expected fewer", options.skip,
                                                  whole->name, whole->fixes()));
    auto log = standing_log(std::move(part), reading->reference);
    if (!log) return fail(log.error());
    auto checks = rest_of(*whole, options, *reading, messages);
    if (!checks) return fail(checks.error());
    for (const std::string& path : options.check) {
        auto series = read_dated(path, *reading, messages);
        if (!series) return fail(series.error());
        auto standing = standing_log(std::move(*series), reading->reference);
        if (!standing) return fail(standing.error());
        checks->push_back(std::move(*standing));
    }
    return FitLogs{std::move(*log), std::move(*checks)};
}

FitConditions conditions_of(const StandingLog& log, const FitOptions& options) {
    FitConditions conditions{log.place, *log.start, log.length};
    conditions.navigation.assign(options.nav.begin(), options.nav.end());
    return conditions;
}

std::string figures_text(const SampleStatistics& s) {
    return fmt::format("mean {:.2f} m, standard deviation {:.2f} m", s.mean, s.std);
}

SampleStatistics figures_of(const std::vector<double>& values) {
    return sample_statistics(values).value_or(SampleStatistics{});
}

// The article's percentage of what the model makes against the log.
ComparisonPercent percent_of(const SampleStatistics& model, const StandingLog& log) {
    return comparison_percent(model, log.horizontal).value_or(ComparisonPercent{});
}

void print_log(const StandingLog& log) {
    const Geodetic& at = log.place;
    fmt::print("log         {}: {} fixes in {:.0f} s from {}, at rest at {:.7f}, {:.7f}, {:.2f} m\n",
               on_a_terminal(log.series.name), log.series.fixes(), log.length.value(), utc_text(*log.start),
               at.latitude.deg(), at.longitude.deg(), at.height.above_ellipsoid.value());
    static constexpr std::string_view about[] = {"its own truth", "the reference", "its own mean"};
    fmt::print("            horizontal error about {}: {}\n", about[static_cast<std::size_t>(log.errors.reference)],
               figures_text(log.horizontal));
}

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

Result<FitResult> compute(const FitLogs& logs, const FitOptions& options, FitProgress& progress,
                          const Messages& messages) {
    FitConditions conditions = conditions_of(logs.log, options);
    progress.expect(static_cast<double>(last_seed + 1) * logs.log.length.value());
    for (const StandingLog& log : logs.checks)
        progress.expect(log.length.value());
    FitResult result;
    const DataFolders data = data_folders();
    auto before = run_baseline(conditions, BaselineFractions::calibrated(), data, progress.watch());
    if (!before) return fail(before.error());
    result.before = std::move(*before);
    progress.clear();
    messages.warnings(result.before.warnings);
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

Result<void> write_files(const std::vector<std::filesystem::path>& files, const FitLogs& logs, const FitResult& result,
                         const FitOptions& options) {
    if (const auto made = make_folder(options.out); !made) return fail(made.error());
    const std::string figure = scatter_plot_svg({"baseline, fitted", result.after.errors},
                                                {on_a_terminal(logs.log.series.name), logs.log.errors});
    if (const auto done = write_whole_file(files.front(), scenario_text(logs, result, options)); !done) return done;
    return write_whole_file(files.back(), figure);
}

int fit_log(const FitOptions& options) {
    const Messages messages(options.verbosity);
    if (options.check_rest && options.count == 0)
        return messages.error({ErrorCode::usage,
                               "--check-rest: cuts the rest into parts of --count fixes; expected "
                               "--count, too"});
    const std::filesystem::path folder = options.out;
    const std::vector<std::filesystem::path> files{folder / "fit.toml", folder / "fit.svg"};
    if (const auto room = check_made_by("fit", files); !room) return messages.error(room.error());
    catch_stop_signals();
    const auto logs = read_logs(options, messages);
    if (!logs) return messages.error(logs.error());
    FitProgress progress(messages);
    const auto result = compute(*logs, options, progress, messages);
    progress.clear();
    if (stop_was_asked())
        return messages.error({ErrorCode::outside, "fit was stopped by a signal; nothing is written"});
    if (!result) return messages.error(result.error());
    if (result->fit.at_limit)
        messages.warning(
            fmt::format("the fractions end at {:g}, and the receiver's errors are larger than the model's "
                        "with them",
                        largest_fraction));
    if (const auto written = write_files(files, *logs, *result, options); !written)
        return messages.error(written.error());
    if (options.verbosity.quiet) return 0;
    print_log(logs->log);
    print_result(*logs, *result);
    fmt::print("written     {}, {}\n", files.front().string(), files.back().string());
    return 0;
}

}  // namespace

Action add_fit_command(CLI::App& app) {
    CLI::App* command = app.add_subcommand(
        "fit", "Fit the sensor model baseline to a receiver's log at rest: a scenario, percentages, a figure");
    auto options = std::make_shared<FitOptions>();
    command
        ->add_option("LOG", options->log,
                     "A receiver's output, RTKLIB .pos, CSV or track, of 10 minutes or more without gaps")
        ->required();
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
    return [options] { return fit_log(*options); };
}

}  // namespace skyloop::host
