#include <fmt/format.h>

#include <cstdio>
#include <fstream>

#include "commands.hpp"
#include "messages.hpp"
#include "run_options.hpp"
#include "skyloop/analysis/comparison.hpp"
#include "skyloop/plot/scatter_plot.hpp"

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
    Verbosity verbosity;
};

Result<FixSeries> read_slice(const std::string& path, const Slice& part) {
    auto series = read_fix_series(path);
    if (!series) return series;
    return slice(*series, part);
}

int compare_files(const CompareOptions& options) {
    const Messages messages(options.verbosity);
    ComparisonOptions wanted;
    wanted.quantity = *error_quantity_from_name(options.series);
    wanted.window = options.window;
    if (!options.reference.empty()) {
        const auto place = parse_place(options.reference);
        if (!place) return messages.error({place.error().code, "--reference" + place.error().message.substr(4)});
        wanted.reference = *place;
    }
    const auto a = read_slice(options.a, {options.skip_a, options.every_a, options.count_a});
    if (!a) return messages.error(a.error());
    const auto b = read_slice(options.b, {options.skip_b, options.every_b, options.count_b});
    if (!b) return messages.error(b.error());
    for (const FixSeries* series : {&*a, &*b})
        for (const std::string& warning : series->warnings)
            messages.warning(warning);
    const auto result = compare(*a, *b, wanted);
    if (!result) return messages.error(result.error());
    if (options.format == "svg")
        fmt::print("{}", scatter_plot_svg({a->name, position_errors(*a, wanted.reference)},
                                          {b->name, position_errors(*b, wanted.reference)}));
    else
        fmt::print("{}", options.format == "json" ? comparison_json(*result) : comparison_text(*result));
    return 0;
}

}  // namespace

Action add_compare_command(CLI::App& app) {
    CLI::App* command =
        app.add_subcommand("compare", "Statistics of two fix files (CSV or NMEA) and their difference in percent");
    auto options = std::make_shared<CompareOptions>();
    command->add_option("A", options->a, "The candidate, e.g. a simulated fixes.csv")->required();
    command->add_option("B", options->b, "The reference, e.g. a real receiver's log")->required();
    command->add_option("--reference", options->reference,
                        "The true place LAT,LON,HEIGHT for a file that does not know it; default: its own mean");
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
    add_verbosity_options(*command, options->verbosity);
    return [options] { return compare_files(*options); };
}

}  // namespace skyloop::host
