#include "fit_logs.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>

#include "base/core/words.hpp"
#include "base/time/utc_time.hpp"
#include "data_folders.hpp"
#include "file_streams.hpp"
#include "run_options.hpp"
#include "run_session.hpp"

namespace skyloop::host {
namespace {

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

}  // namespace

FitProgress::FitProgress(const Messages& messages)
    : shown_(!messages.verbosity().quiet && !messages.verbosity().json && ::isatty(STDERR_FILENO) != 0) {}

void FitProgress::clear() const {
    if (shown_ && done_ > 0) say("\r\x1b[K");
}

void FitProgress::count() {
    ++done_;
    stop_ = stop_was_asked();
    const auto now = std::chrono::steady_clock::now();
    if (!shown_ || now - last_ < std::chrono::milliseconds(200)) return;
    last_ = now;
    say(fmt::format("\r\x1b[Krunning the model: {:.0f} %",
                    100 * std::min(1.0, static_cast<double>(done_) / expected_)));
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

ComparisonPercent percent_of(const SampleStatistics& model, const StandingLog& log) {
    return comparison_percent(model, log.horizontal).value_or(ComparisonPercent{});
}

namespace {

Result<std::vector<std::filesystem::path>> fit_files(const FitOptions& options) {
    if (options.check_rest && options.count == 0)
        return fail(ErrorCode::usage, "--check-rest: cuts the rest into parts of --count fixes; expected --count, too");
    if (options.model != "modern")
        for (const auto& [name, given] : {std::pair("--board", !options.board.empty()),
                                          {"--surroundings", !options.surroundings.empty()},
                                          {"--constellations", !options.constellations.empty()}})
            if (given)
                return fail(ErrorCode::usage,
                            fmt::format("{}: is of the modern model; expected --model modern, too", name));
    const std::filesystem::path folder = options.out;
    std::vector<std::filesystem::path> files{folder / "fit.toml", folder / "fit.svg"};
    if (const auto room = check_made_by("fit", files); !room) return fail(room.error());
    return files;
}

Result<FitLogs> read_fit_logs(const FitOptions& options, const Messages& messages) {
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

void print_log(const StandingLog& log) {
    const Geodetic& at = log.place;
    fmt::print("log         {}: {} fixes in {:.0f} s from {}, at rest at {:.7f}, {:.7f}, {:.2f} m\n",
               on_a_terminal(log.series.name), log.series.fixes(), log.length.value(), utc_text(*log.start),
               at.latitude.deg(), at.longitude.deg(), at.height.above_ellipsoid.value());
    static constexpr std::string_view about[] = {"its own truth", "the reference", "its own mean"};
    fmt::print("            horizontal error about {}: {}\n", about[static_cast<std::size_t>(log.errors.reference)],
               figures_text(log.horizontal));
}

Result<void> write_files(const std::vector<std::filesystem::path>& files, const FitLogs& logs, const FitOutput& output,
                         const FitOptions& options) {
    if (const auto made = make_folder(options.out); !made) return fail(made.error());
    const std::string figure = scatter_plot_svg(output.cloud, {on_a_terminal(logs.log.series.name), logs.log.errors});
    if (const auto done = write_whole_file(files.front(), output.scenario); !done) return done;
    return write_whole_file(files.back(), figure);
}

}  // namespace

int fit_logs(const FitOptions& options, const FitModel& fit) {
    const Messages messages(options.verbosity);
    const auto files = fit_files(options);
    if (!files) return messages.error(files.error());
    catch_stop_signals();
    const auto logs = read_fit_logs(options, messages);
    if (!logs) return messages.error(logs.error());
    FitProgress progress(messages);
    const auto output = fit(*logs, options, progress);
    progress.clear();
    if (stop_was_asked())
        return messages.error({ErrorCode::outside, "fit was stopped by a signal; nothing is written"});
    if (!output) return messages.error(output.error());
    messages.warnings(output->warnings);
    if (const auto written = write_files(*files, *logs, *output, options); !written)
        return messages.error(written.error());
    if (options.verbosity.quiet) return 0;
    print_log(logs->log);
    output->print();
    fmt::print("written     {}, {}\n", files->front().string(), files->back().string());
    return 0;
}

}  // namespace skyloop::host
