#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdio>

#include "commands.hpp"
#include "data_folders.hpp"
#include "messages.hpp"
#include "run/scenario/board_file.hpp"
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

}  // namespace skyloop::host
