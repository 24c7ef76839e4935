#include "vehicle_files.hpp"

#include <filesystem>

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

}  // namespace

std::vector<std::string> files_of_command(std::string_view command) {
    std::vector<std::string> files = words_read_in(command);
    std::erase_if(files, [](const std::string& word) {
        std::error_code none;
        return word.find('/') == std::string::npos || !std::filesystem::is_regular_file(word, none);
    });
    return files;
}

}  // namespace skyloop
