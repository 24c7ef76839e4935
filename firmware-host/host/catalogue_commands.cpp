#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdio>

#include "base/core/json.hpp"
#include "base/core/words.hpp"
#include "commands.hpp"
#include "data_folders.hpp"
#include "messages.hpp"
#include "run/control/command_json.hpp"
#include "run/fault/fault_kind.hpp"
#include "run/scenario/board_files.hpp"
#include "run/scenario/key_catalogue.hpp"
#include "run/scenario/listed_board.hpp"
#include "run_options.hpp"

namespace skyloop::host {
namespace {

struct BoardOptions {
    std::string name;
    std::string format = "text";
    Verbosity verbosity;
};

// A line each, with the aliases behind it in brackets.
std::string board_lines(const std::vector<firmware::BoardProfile>& boards) {
    std::size_t longest = 0;
    for (const firmware::BoardProfile& board : boards)
        longest = std::max(longest, board.name.size());
    std::string text;
    for (const firmware::BoardProfile& board : boards) {
        const std::string aliases =
            board.aliases.empty() ? std::string() : fmt::format(" [{}]", fmt::join(board.aliases, ", "));
        text += fmt::format("{:<{}}  {}{}\n", board.name, longest, board.description, aliases);
    }
    return text;
}

std::string boards_json(const std::vector<firmware::BoardProfile>& boards) {
    Json list = Json::array();
    for (const firmware::BoardProfile& board : boards)
        list.push_back({{"name", board.name}, {"description", board.description}, {"aliases", board.aliases}});
    return json_text(list) + "\n";
}

int show_board(const BoardOptions& options, const Messages& messages) {
    const auto folders = board_folders(data_folders());
    const auto text = options.format == "json" ? board_json(options.name, folders) : board_text(options.name, folders);
    if (!text) return messages.error(text.error());
    fmt::print("{}", *text);
    return 0;
}

int show_boards(const BoardOptions& options) {
    const Messages messages(options.verbosity);
    if (!options.name.empty()) return show_board(options, messages);
    const auto folders = board_folders(data_folders());
    std::vector<firmware::BoardProfile> boards;
    for (const std::string& name : list_boards(folders)) {
        auto board = find_board(name, folders);
        if (!board) return messages.error(board.error());
        boards.push_back(std::move(*board));
    }
    if (boards.empty())
        return messages.error(
            {ErrorCode::outside, fmt::format("no boards in {}; SKYLOOP_DATA_DIR may name the folder that holds boards/",
                                             folders.front().string())});
    fmt::print("{}", options.format == "json" ? boards_json(boards) : board_lines(boards));
    return 0;
}

}  // namespace

Action add_boards_command(CLI::App& app) {
    CLI::App* command = app.add_subcommand("boards", "The receiver profiles, or one in full");
    auto options = std::make_shared<BoardOptions>();
    command->add_option("NAME", options->name, "A profile's name, or that of a module");
    command->add_option("--format", options->format, "text or json")->check(CLI::IsMember({"text", "json"}));
    add_verbosity_options(*command, options->verbosity);
    return [options] { return show_boards(*options); };
}

namespace {

struct FaultsOptions {
    std::string name;
    std::string format = "text";
    Verbosity verbosity;
};

std::string one_of_all_json(std::string_view name) {
    for (const auto& kind : Json::parse(fault_kinds_json()))
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
