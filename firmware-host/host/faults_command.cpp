#include <fmt/format.h>
#include <fmt/ranges.h>

#include <nlohmann/json.hpp>

#include "base/core/spelling.hpp"
#include "commands.hpp"
#include "messages.hpp"
#include "run/control/command_json.hpp"
#include "run/fault/fault_listing.hpp"
#include "run_options.hpp"

namespace skyloop::host {
namespace {

struct FaultsOptions {
    std::string name;
    std::string format = "text";
    Verbosity verbosity;
};

std::string one_of_all_json(std::string_view name) {
    for (const auto& kind : nlohmann::ordered_json::parse(fault_kinds_json()))
        if (kind.at("name") == name) return kind.dump();
    return "null";
}

int show_faults(const FaultsOptions& options) {
    const Messages messages(options.verbosity);
    if (!options.name.empty()) {
        if (options.format == "markdown")
            return messages.error(
                {ErrorCode::usage, "faults: --format markdown lists all of them; expected text or json beside a NAME"});
        if (const FaultKind* kind = find_fault_kind(options.name)) {
            fmt::print("{}", options.format == "json" ? one_of_all_json(kind->name) + "\n" : fault_text(*kind));
            return 0;
        }
        std::vector<std::string_view> names;
        for (const FaultKind& kind : fault_kinds())
            names.push_back(kind.name);
        return messages.error(
            {ErrorCode::usage, fmt::format("faults {}: unknown; expected one of {}{}", options.name,
                                           fmt::join(names, " "), did_you_mean(options.name, names))});
    }
    if (options.format == "json")
        fmt::print("{}\n", fault_kinds_json());
    else
        fmt::print("{}", options.format == "markdown" ? fault_catalogue_markdown() : fault_list_text());
    return 0;
}

}  // namespace

Action add_faults_command(CLI::App& app) {
    CLI::App* command = app.add_subcommand("faults", "The faults that a scenario can hold, or one in full");
    auto options = std::make_shared<FaultsOptions>();
    command->add_option("NAME", options->name, "A fault's kind");
    command->add_option("--format", options->format, "text, json or markdown")
        ->check(CLI::IsMember({"text", "json", "markdown"}));
    add_verbosity_options(*command, options->verbosity);
    return [options] { return show_faults(*options); };
}

}  // namespace skyloop::host
