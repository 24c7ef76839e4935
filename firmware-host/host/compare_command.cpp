#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <system_error>

#include "commands.hpp"
#include "data_folders.hpp"
#include "messages.hpp"
#include "run/emulator/assembly.hpp"
#include "run_options.hpp"
#include "study/analysis/comparison.hpp"
#include "study/plot/scatter_plot.hpp"

namespace skyloop::host {
namespace {

struct CompareOptions {
    std::string a, b;
    std::string reference;
    std::string series = "horizontal";
    std::string format = "text";
    std::size_t every_a = 1, every_b = 1;
    std::size_t skip_a = 0, skip_b = 0;
    std::size_t count_a = 0, count_b = 0;
    std::size_t window = 0;
    double interval_a = 0, interval_b = 0;  // s; 0: as the file says
    Verbosity verbosity;
};

// What to take of a file and how to see it.
struct FileView {
    std::string path;
    Slice part;
    double interval = 0;  // s; 0: as the file says
    bool own_mean = false;
};

// Of a recording its fixes.
std::string fixes_at(const std::string& path) {
    std::error_code absent;
    return std::filesystem::is_directory(path, absent) ? (std::filesystem::path(path) / "fixes.csv").string() : path;
}

Result<FixSeries> read_view(const FileView& view, const Geoid* geoid) {
    auto series = read_fix_series(view.path, geoid);
    if (!series) return series;
    if (view.interval > 0 && series->interval)
        series->warnings.push_back(
            fmt::format("{}: has times of its own, one fix every {:g} s; the given interval of "
                        "{:g} s is not used",
                        view.path, series->interval->value(), view.interval));
    else if (view.interval > 0)
        series->interval = Seconds(view.interval);
    return slice(view.own_mean ? without_truth(std::move(*series)) : std::move(*series), view.part);
}

int compare_files(const CompareOptions& options) {
    const Messages messages(options.verbosity);
    if (options.format == "svg" && options.window > 0)
        return messages.error(
            {ErrorCode::usage, "--window: the figure shows no windows; expected --format text or json"});
    ComparisonOptions wanted;
    wanted.quantity = *error_quantity_from_name(options.series);
    wanted.window = options.window;
    const bool own_mean = options.reference == "own-mean";
    if (!options.reference.empty() && !own_mean) {
        const auto place = parse_reference(options.reference);
        if (!place) return messages.error(place.error());
        wanted.reference = *place;
    }
    std::vector<std::string> unused;
    const auto geoid = find_geoid(data_folders(), unused);
    const auto a = read_view(
        {fixes_at(options.a), {options.skip_a, options.every_a, options.count_a}, options.interval_a, own_mean},
        geoid.get());
    if (!a) return messages.error(a.error());
    const auto b = read_view(
        {fixes_at(options.b), {options.skip_b, options.every_b, options.count_b}, options.interval_b, own_mean},
        geoid.get());
    if (!b) return messages.error(b.error());
    for (const FixSeries* series : {&*a, &*b})
        messages.warnings(series->warnings);
    const auto result = compare(*a, *b, wanted);
    if (!result) return messages.error(result.error());
    if (options.format == "svg") {
        // Text and JSON hold them, a picture cannot.
        messages.warnings(result->warnings);
        fmt::print("{}", scatter_plot_svg({a->name, position_errors(*a, wanted.reference)},
                                          {b->name, position_errors(*b, wanted.reference)}, wanted.quantity));
    } else {
        fmt::print("{}", options.format == "json" ? comparison_json(*result) : comparison_text(*result));
    }
    return 0;
}

}  // namespace

Action add_compare_command(CLI::App& app) {
    CLI::App* command = app.add_subcommand("compare",
                                           "Statistics of two files of fixes (receivers' logs, RTKLIB .pos, CSV or "
                                           "tracks) and their difference in percent");
    auto options = std::make_shared<CompareOptions>();
    command->add_option("A", options->a, "The candidate, e.g. a simulated fixes.csv, or the folder that holds it")
        ->required();
    command->add_option("B", options->b, "The reference, e.g. a real receiver's log")->required();
    command->add_option("--reference", options->reference,
                        "The true place LAT,LON,HEIGHT for a file that does not know it; default: its own mean. "
                        "own-mean: both files about their own means, even where they know the truth");
    command->add_option("--series", options->series, "The error whose percentage is told")
        ->check(CLI::IsMember({"east", "north", "up", "horizontal", "3d"}));
    command->add_option("--format", options->format, "text, json or svg")
        ->check(CLI::IsMember({"text", "json", "svg"}));
    command->add_option("--window", options->window,
                        "Compare with each window of so many fixes of B, and these with each other");
    const auto positive = CLI::Range(std::size_t{1}, std::size_t{1'000'000});
    command->add_option("--every-a", options->every_a, "Take every N-th fix of A")->check(positive);
    command->add_option("--every-b", options->every_b, "Take every N-th fix of B")->check(positive);
    command->add_option("--skip-a", options->skip_a, "Leave out the first N fixes of A");
    command->add_option("--skip-b", options->skip_b, "Leave out the first N fixes of B");
    command->add_option("--count-a", options->count_a, "Take at most N fixes of A");
    command->add_option("--count-b", options->count_b, "Take at most N fixes of B");
    const auto seconds = CLI::Range(1e-3, 1e6);
    command->add_option("--interval-a", options->interval_a, "Seconds between the fixes of A, if it holds no times")
        ->check(seconds);
    command->add_option("--interval-b", options->interval_b, "Seconds between the fixes of B, if it holds no times")
        ->check(seconds);
    add_verbosity_options(*command, options->verbosity);
    return [options] { return compare_files(*options); };
}

}  // namespace skyloop::host
