#include "run/scenario/board_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <set>
#include <utility>

#include "base/core/letter_case.hpp"
#include "base/core/spelling.hpp"
#include "base/core/text_file.hpp"
#include "detail/board_keys.hpp"

namespace skyloop {
namespace {

namespace fs = std::filesystem;

fs::path board_path(const fs::path& directory, std::string_view name) {
    return directory / "receivers" / (std::string(name) + ".toml");
}

constexpr std::size_t least_of_module = 3;  // letters, of a name that means one

// What names a board: its own name, and modules by which its receiver reports itself. In small letters.
std::vector<std::string> words_of_board(const std::string& name, const fs::path& path) {
    std::vector<std::string> words{name};
    const auto text = read_text_file(path);
    const auto board = text ? read_board(*text, path.string()) : fail(text.error());
    if (!board) return words;
    constexpr std::string_view module = "MOD=";
    words.push_back(lower_case(board->identity.hardware));
    for (const std::string& line : board->identity.extensions)
        if (line.starts_with(module)) words.push_back(lower_case(line.substr(module.size())));
    for (const std::string& answer : board->identity.version_answers)
        for (std::size_t from = 0, to = 0; to != std::string::npos; from = to + 1) {
            to = answer.find(',', from);
            words.push_back(lower_case(answer.substr(from, to - from)));
        }
    // Numbers, and letters alone, name no module.
    std::erase_if(words, [](const std::string& word) {
        return word.size() < least_of_module || std::isalpha(static_cast<unsigned char>(word.front())) == 0;
    });
    return words;
}

// "m8" of "ublox-m8", which stands in the names of its modules; empty: it is of no generation.
std::string_view generation_of(std::string_view board) {
    const std::string_view last = board.substr(board.rfind('-') + 1);
    const bool numbered = std::any_of(last.begin(), last.end(), [](unsigned char c) { return std::isdigit(c) != 0; });
    return numbered && last.size() < board.size() ? last : std::string_view();
}

// Not as a part of a longer number.
bool contains_generation(std::string_view word, std::string_view generation) {
    const auto digit_at = [word](std::size_t i) {
        return i < word.size() && std::isdigit(static_cast<unsigned char>(word[i])) != 0;
    };
    const std::size_t at = generation.empty() ? std::string_view::npos : word.find(generation);
    if (at == std::string_view::npos) return false;
    const bool continues = at > 0 && digit_at(at - 1) && digit_at(at);
    return !continues && !digit_at(at + generation.size());
}

// The board that is meant by "m8", "NEO-M8N" or "ubloxm8"; empty: nobody can tell.
std::string meant_board(std::string_view name, const std::vector<std::string>& boards,
                        std::span<const fs::path> directories) {
    const std::string word = lower_case(name);
    std::vector<std::pair<std::string, std::string>> named;  // a word, and its board
    std::set<std::string> begin_so;
    for (const std::string& board : boards)
        for (std::string& other : words_of_board(board, *find_board_file(board, directories))) {
            if (word.size() >= least_of_module && other.starts_with(word)) begin_so.insert(board);
            named.emplace_back(std::move(other), board);
        }
    if (!begin_so.empty()) return begin_so.size() == 1 ? *begin_so.begin() : std::string();
    for (const std::string& board : boards)
        if (contains_generation(word, generation_of(board))) return board;
    std::vector<std::string_view> words;
    for (const auto& [other, board] : named)
        words.push_back(other);
    const auto nearest = std::find(words.begin(), words.end(), nearest_word(word, words));
    return nearest == words.end() ? "" : named[static_cast<std::size_t>(nearest - words.begin())].second;
}

}  // namespace

Result<firmware::BoardProfile> read_board(std::string_view toml_text, std::string_view name) {
    firmware::BoardProfile board;
    board.name = fs::path(name).stem().string();
    const auto read = read_toml(toml_text, std::string(name), [&](TableReader& top) { read_board_keys(top, board); });
    if (!read) return fail(read.error());
    return board;
}

bool is_board_path(std::string_view name) { return name.ends_with(".toml"); }

std::optional<fs::path> find_board_file(std::string_view name, std::span<const fs::path> directories) {
    if (is_board_path(name)) return name;
    if (name.find('/') != std::string_view::npos) return std::nullopt;
    std::error_code absent;
    for (const fs::path& directory : directories)
        if (fs::exists(board_path(directory, name), absent)) return board_path(directory, name);
    return std::nullopt;
}

Result<firmware::BoardProfile> find_board(std::string_view name, std::span<const fs::path> directories) {
    if (const auto path = find_board_file(name, directories)) {
        const auto text = read_text_file(*path);
        if (!text) return fail(text.error());
        return read_board(*text, path->string());
    }
    const std::vector<std::string> known = list_boards(directories);
    if (known.empty()) {
        std::string searched;
        for (const fs::path& directory : directories)
            searched += " " + directory.string();
        return fail(ErrorCode::usage, fmt::format("board '{}': no board files are found; searched:{}", name, searched));
    }
    const std::string meant = meant_board(name, known, directories);
    return fail(ErrorCode::usage, fmt::format("board '{}' is not known; {}", name,
                                              meant.empty() ? fmt::format("expected one of {}", fmt::join(known, ", "))
                                                            : fmt::format("did you mean '{}'?", meant)));
}

std::vector<std::string> list_boards(std::span<const fs::path> directories) {
    std::vector<std::string> names;
    for (const fs::path& directory : directories) {
        std::error_code error;
        for (const fs::directory_entry& entry : fs::directory_iterator(directory / "receivers", error))
            if (entry.path().extension() == ".toml") names.push_back(entry.path().stem().string());
    }
    std::sort(names.begin(), names.end());
    names.erase(std::unique(names.begin(), names.end()), names.end());
    return names;
}

}  // namespace skyloop
