#include <fmt/format.h>

#include "commands.hpp"
#include "messages.hpp"
#include "run/scenario/key_catalogue.hpp"
#include "run_options.hpp"

namespace skyloop::host {

Action add_schema_command(CLI::App& app) {
    CLI::App* command = app.add_subcommand("schema", "Every key of scenario files, as a JSON Schema for editors");
    auto format = std::make_shared<std::string>("json");
    command->add_option("--format", *format, "json or markdown")->check(CLI::IsMember({"json", "markdown"}));
    return [format] {
        fmt::print("{}", *format == "markdown" ? scenario_keys_markdown() : scenario_schema_json());
        return 0;
    };
}

}  // namespace skyloop::host
