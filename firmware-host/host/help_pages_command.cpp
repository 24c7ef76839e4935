#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "base/core/make_folder.hpp"
#include "commands.hpp"
#include "messages.hpp"
#include "option_table.hpp"

namespace skyloop::host {
namespace {

struct HelpPagesOptions {
    std::string format = "markdown";
    std::string out;
};

int write_page(const std::filesystem::path& path, const std::string& text) {
    std::ofstream file(path, std::ios::binary | std::ios::trunc);
    file << text;
    file.close();
    if (file) return 0;
    return Messages({}).error(
        {ErrorCode::outside, fmt::format("{}: cannot be written: {}", path.string(), std::strerror(errno))});
}

int write_manual_pages(std::span<const CommandRow> commands, const std::filesystem::path& folder) {
    if (const auto made = make_folder(folder); !made) return Messages({}).error(made.error());
    for (const CommandRow& command : commands) {
        const auto path = folder / fmt::format("skyloop-{}.1", command.name);
        if (const int code = write_page(path, manual_page(command, SKYLOOP_VERSION)); code != 0) return code;
    }
    return 0;
}

int help_pages(const CLI::App& program, const HelpPagesOptions& options) {
    const std::vector<CommandRow> commands = option_table(program);
    if (options.format == "man") {
        if (options.out.empty())
            return Messages({}).error(
                {ErrorCode::usage, "help-pages --format man: expected --out DIR, a folder for them"});
        return write_manual_pages(commands, options.out);
    }
    const std::string page = options.format == "bash"  ? bash_completion(commands)
                             : options.format == "zsh" ? zsh_completion(commands)
                                                       : commands_markdown(commands);
    if (!options.out.empty()) return write_page(options.out, page);
    fmt::print("{}", page);
    return 0;
}

}  // namespace

Action add_help_pages_command(CLI::App& app) {
    CLI::App* command =
        app.add_subcommand("help-pages", "Manual pages, completions and the page of all options, for packages");
    auto options = std::make_shared<HelpPagesOptions>();
    command
        ->add_option("--format", options->format,
                     "man (a page for each command), bash or zsh (completions) or markdown (default)")
        ->check(CLI::IsMember({"man", "bash", "zsh", "markdown"}));
    command->add_option("--out", options->out,
                        "Folder of the manual pages, or file of the rest; default: standard output");
    command->group("");  // for whoever makes packages: not in the help
    return [&app, options] { return help_pages(app, *options); };
}

}  // namespace skyloop::host
