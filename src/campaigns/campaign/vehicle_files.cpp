#include "detail/vehicle_files.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>

namespace skyloop {
namespace {

// The words as a shell parts and unquotes them (IEEE Std 1003.1, Shell Command Language, 2.2 and 2.3), without those
// behind a >.
std::vector<std::string> words_read_in(std::string_view command) {
    std::vector<std::string> words;
    std::string word;
    bool written = false;
    char quote = 0;
    const auto end_word = [&] {
        if (word.empty()) return;
        if (!written) words.push_back(word);
        written = false;
        word.clear();
    };
    for (std::size_t i = 0; i < command.size(); ++i) {
        const char c = command[i];
        if (quote != 0 && c == quote) {
            quote = 0;
        } else if (quote == 0 && (c == '\'' || c == '"')) {
            quote = c;
        } else if (quote != '\'' && c == '\\' && i + 1 < command.size()) {
            word += command[++i];
        } else if (quote == 0 && std::string_view(" \t\n;&|()<>").find(c) != std::string_view::npos) {
            end_word();
            if (c == '>') written = true;
        } else {
            word += c;
        }
    }
    end_word();
    return words;
}

bool is_program(const std::filesystem::path& file) {
    constexpr std::array<std::string_view, 3> endings{".py", ".sh", ".lua"};
    using std::filesystem::perms;
    std::error_code none;
    const auto status = std::filesystem::status(file, none);
    if (!std::filesystem::is_regular_file(status)) return false;
    if ((status.permissions() & (perms::owner_exec | perms::group_exec | perms::others_exec)) != perms::none)
        return true;
    if (std::find(endings.begin(), endings.end(), file.extension().string()) != endings.end()) return true;
    std::array<char, 2> first{};
    std::ifstream(file, std::ios::binary).read(first.data(), first.size());
    return first == std::array<char, 2>{'#', '!'};
}

}  // namespace

std::vector<std::string> programs_of_command(std::string_view command) {
    std::vector<std::string> programs = words_read_in(command);
    std::erase_if(programs,
                  [](const std::string& word) { return word.find('/') == std::string::npos || !is_program(word); });
    return programs;
}

}  // namespace skyloop
