#include "skyloop/scenario/board_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "board_keys.hpp"
#include "skyloop/base/spelling.hpp"
#include "skyloop/base/text_file.hpp"

namespace skyloop {
namespace {

namespace fs = std::filesystem;

fs::path board_path(const fs::path& directory, std::string_view name) {
    return directory / "receivers" / (std::string(name) + ".toml");
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
    const std::vector<std::string_view> words(known.begin(), known.end());
    return fail(ErrorCode::usage, fmt::format("board '{}' is not known; expected one of {}{}", name,
                                              fmt::join(known, ", "), did_you_mean(name, words)));
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
