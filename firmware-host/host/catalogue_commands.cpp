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
#include "run_options.hpp"

namespace skyloop::host {
namespace {

struct BoardOptions {
    std::string name;
    Verbosity verbosity;
};

void print_board(const firmware::BoardProfile& board) {
    std::vector<std::string_view> constellations;
    for (const Constellation c : board.constellations)
        constellations.push_back(constellation_name(c));
    std::vector<std::string> sentences;
    for (const firmware::SentenceRate& s : board.sentences)
        sentences.push_back(fmt::format("{}{}", firmware::nmea_sentence_names[static_cast<std::size_t>(s.sentence)],
                                        s.every_epochs == 1 ? std::string() : fmt::format("/{}", s.every_epochs)));
    fmt::print("{}\n  {}\n", board.name, board.description);
    fmt::print("  speed            {} baud, transmit buffer {} bytes\n", board.baud, board.transmit_buffer_bytes);
    fmt::print("  rate             {:g} Hz, at most {:g} Hz\n", board.default_rate_hz, board.max_rate_hz);
    fmt::print("  constellations   {}\n", fmt::join(constellations, " "));
    fmt::print("  elevation mask   {:g} deg\n", board.elevation_mask.deg());
    fmt::print("  sentences        {}\n", fmt::join(sentences, " "));
    fmt::print("  latency          {:g} ms\n", board.solution_latency.value() * 1e3);
}

int show_boards(const BoardOptions& options) {
    const Messages messages(options.verbosity);
    const auto folders = board_folders(data_folders());
    if (!options.name.empty()) {
        const auto board = find_board(options.name, folders);
        if (!board) return messages.error(board.error());
        print_board(*board);
        return 0;
    }
    const auto names = list_boards(folders);
    if (names.empty())
        return messages.error(
            {ErrorCode::outside, fmt::format("no boards in {}; SKYLOOP_DATA_DIR may name the folder that holds boards/",
                                             folders.front().string())});
    std::size_t longest = 0;
    for (const std::string& name : names)
        longest = std::max(longest, name.size());
    for (const std::string& name : names) {
        const auto board = find_board(name, folders);
        if (!board) return messages.error(board.error());
        fmt::print("{:<{}}  {}\n", board->name, longest, board->description);
    }
    return 0;
}

}  // namespace

Action add_boards_command(CLI::App& app) {
    CLI::App* command = app.add_subcommand("boards", "The receiver profiles, or one in full");
    auto options = std::make_shared<BoardOptions>();
    command->add_option("NAME", options->name, "A profile's name");
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
