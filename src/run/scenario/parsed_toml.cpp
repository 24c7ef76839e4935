#include "detail/toml_values.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <vector>

namespace skyloop {
namespace {

// The place behind the text in quotes that begins at `at` (TOML 1.0, "String"); of one that does not end, its line's
// end, where the parser refuses it, or the end of all.
std::size_t end_of_quoted(std::string_view text, std::size_t at) {
    const char quote = text[at];
    const bool of_lines = text.substr(at, 3) == std::string_view(quote == '"' ? "\"\"\"" : "'''");
    std::size_t run = 0;  // of quotes that follow each other
    for (std::size_t i = at + (of_lines ? 3 : 1); i < text.size(); ++i) {
        if (!of_lines && text[i] == '\n') return i;
        run = text[i] == quote ? run + 1 : 0;
        if (run == (of_lines ? 3 : 1)) {
            ++i;
            // Up to two quotes before the three that close are of the text.
            for (int more = 0; of_lines && more < 2 && i < text.size() && text[i] == quote; ++more)
                ++i;
            return i;
        }
        if (quote == '"' && text[i] == '\\') ++i;
    }
    return text.size();
}

// Counts the dots of the key that is being read, and of those in whose inline tables it stands.
class KeyDepth {
public:
    // @return whether the key has too many parts
    bool take(char c) {
        const bool in_value = levels_.back().in_value;
        if (c == '.' && !in_value) ++levels_.back().dots, ++dots_;
        if (c == '=') levels_.back().in_value = true;
        if (c == ',' || c == '\n') begin_anew();
        if (c == '{') levels_.push_back({});
        if (c == '[') levels_.push_back({0, in_value, in_value});
        if ((c == ']' || c == '}') && levels_.size() > 1) {
            dots_ -= levels_.back().dots;
            levels_.pop_back();
        }
        return dots_ >= most_key_parts;
    }

private:
    struct Level {
        std::size_t dots = 0;   // of its key
        bool in_value = false;  // where dots are those of numbers
        bool list = false;      // of values; else a header, an inline table or the document
    };
    void begin_anew() {
        Level& level = levels_.back();
        dots_ -= level.dots;
        level = {0, level.list, level.list};
    }

    std::vector<Level> levels_{Level{}};  // of each bracket that is open
    std::size_t dots_ = 0;                // of all levels
};

// Where a key has its first part too many.
std::optional<std::size_t> part_too_many(std::string_view text) {
    KeyDepth depth;
    for (std::size_t i = 0; i < text.size();) {
        const char c = text[i];
        if (c == '"' || c == '\'') {
            i = end_of_quoted(text, i);
        } else if (c == '#') {
            i = std::min(text.find('\n', i), text.size());
        } else if (depth.take(c)) {
            return i;
        } else {
            ++i;
        }
    }
    return std::nullopt;
}

// Lines and columns as the parser counts them, in characters of UTF-8.
toml::source_position position_of(std::string_view text, std::size_t at) {
    const std::string_view before = text.substr(0, at);
    const std::size_t line = before.rfind('\n') + 1;  // npos + 1 is 0
    const auto begins = [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; };
    return {static_cast<toml::source_index>(1 + std::count(before.begin(), before.end(), '\n')),
            static_cast<toml::source_index>(
                1 + std::count_if(before.begin() + static_cast<std::ptrdiff_t>(line), before.end(), begins))};
}

}  // namespace

toml::table parsed_toml(std::string_view text, std::string_view file) {
    if (const auto at = part_too_many(text))
        throw toml::parse_error(
            fmt::format("the key has more than {} parts; expected at most {}", most_key_parts, most_key_parts).c_str(),
            position_of(text, *at));
    return toml::parse(text, file);
}

}  // namespace skyloop
