#include "detail/fields.hpp"

#include <array>
#include <cmath>

#include "base/core/number_text.hpp"

namespace skyloop::inline world::rinex {

std::optional<Line> LineReader::next() {
    if (rest_.empty()) return std::nullopt;
    const std::size_t end = rest_.find('\n');
    std::string_view line = rest_.substr(0, end);
    rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
    if (line.ends_with('\r')) line.remove_suffix(1);
    return Line{line, ++number_};
}

std::string_view columns(std::string_view line, std::size_t first, std::size_t width) {
    return first < line.size() ? line.substr(first, width) : std::string_view{};
}

std::vector<std::string_view> words_of(std::string_view line) {
    std::vector<std::string_view> words;
    for (std::size_t at = 0; at < line.size();) {
        const std::size_t first = line.find_first_not_of(" \t", at);
        if (first == std::string_view::npos) break;
        at = std::min(line.find_first_of(" \t", first), line.size());
        words.push_back(line.substr(first, at - first));
    }
    return words;
}

std::string_view without_byte_order_mark(std::string_view text) {
    constexpr std::string_view mark = "\xEF\xBB\xBF";
    return text.starts_with(mark) ? text.substr(mark.size()) : text;
}

std::string_view trimmed(std::string_view text) {
    while (text.starts_with(' '))
        text.remove_prefix(1);
    while (text.ends_with(' '))
        text.remove_suffix(1);
    return text;
}

std::optional<double> real_field(std::string_view field) {
    field = trimmed(field);
    if (field.empty()) return 0.0;
    if (field.starts_with('+')) field.remove_prefix(1);
    std::array<char, 40> digits{};
    if (field.empty() || field.size() > digits.size()) return std::nullopt;
    for (std::size_t i = 0; i < field.size(); ++i)
        digits[i] = field[i] == 'D' || field[i] == 'd' ? 'e' : field[i];
    return number_in<double>({digits.data(), field.size()});
}

std::optional<int> whole_field(std::string_view field) {
    field = trimmed(field);
    return field.empty() ? 0 : number_in<int>(field);
}

std::string in_quotes(std::string_view text) {
    constexpr std::size_t longest = 40;
    text = trimmed(text);
    std::string result = "'";
    for (const char c : text.substr(0, longest))
        result += c >= ' ' && c <= '~' ? c : '?';
    return result + (text.size() > longest ? "…'" : "'");
}

}  // namespace skyloop::inline world::rinex
