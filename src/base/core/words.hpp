/// Letters A to Z and a to z; every other byte stays as it is, whatever the locale.
/// Texts without what stands around them, and where the characters of a UTF-8 text end.
/// Texts of files, as a terminal may have them.
/// Words for whoever reads standard error.
/// What a user may have meant by a word that is not known.
/// Words for a shell.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace skyloop::inline base {

constexpr char lower_case(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }
constexpr char upper_case(char c) { return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c; }

inline std::string lower_case(std::string_view text) {
    std::string lower(text);
    for (char& c : lower)
        c = lower_case(c);
    return lower;
}

inline std::string upper_case(std::string_view text) {
    std::string upper(text);
    for (char& c : upper)
        c = upper_case(c);
    return upper;
}

/// Without blanks at both ends. Every field of a file comes by here: a search takes several times as long.
constexpr std::string_view trimmed(std::string_view text) {
    while (text.starts_with(' '))
        text.remove_prefix(1);
    while (text.ends_with(' '))
        text.remove_suffix(1);
    return text;
}

/// Without any of the characters `around` at both ends.
constexpr std::string_view trimmed(std::string_view text, std::string_view around) {
    text.remove_prefix(std::min(text.find_first_not_of(around), text.size()));
    text.remove_suffix(text.size() - (text.find_last_not_of(around) + 1));
    return text;
}

/// The length in bytes of the UTF-8 character at the start of `text`, 0 when it is none or cut (RFC 3629, section 4).
constexpr std::size_t utf8_length(std::string_view text) {
    const auto byte = [&](std::size_t i) { return i < text.size() ? static_cast<unsigned char>(text[i]) : 0U; };
    const auto follows = [&](std::size_t i) { return (byte(i) & 0xC0U) == 0x80U; };
    const unsigned first = byte(0);
    if (text.empty()) return 0;
    if (first < 0x80) return 1;
    if (first >= 0xC2 && first <= 0xDF) return follows(1) ? 2 : 0;
    if (first >= 0xE0 && first <= 0xEF) {
        const bool overlong_or_surrogate = (first == 0xE0 && byte(1) < 0xA0) || (first == 0xED && byte(1) >= 0xA0);
        return follows(1) && follows(2) && !overlong_or_surrogate ? 3 : 0;
    }
    if (first >= 0xF0 && first <= 0xF4) {
        const bool out_of_range = (first == 0xF0 && byte(1) < 0x90) || (first == 0xF4 && byte(1) >= 0x90);
        return follows(1) && follows(2) && follows(3) && !out_of_range ? 4 : 0;
    }
    return 0;
}

/// What would lead a terminal elsewhere, or break the line, as JSON writes it: \u001b. The rest as it stands.
std::string on_a_terminal(std::string_view text);

/// Writes to standard error. That nobody reads it, or that its disk is full, is no reason to end: unlike
/// fmt::print() this never throws because of it.
void say(std::string_view text);

/// The candidate with the smallest edit distance to `word` (insertions, deletions, substitutions and swaps of
/// neighbours), or an empty string when none is near enough to be meant.
std::string nearest_word(std::string_view word, std::span<const std::string_view> candidates);

/// "; did you mean 'X'?" for the nearest candidate, or an empty string.
std::string did_you_mean(std::string_view word, std::span<const std::string_view> candidates);

/// One word of a POSIX shell (IEEE Std 1003.1, Shell Command Language, 2.2.2): as it is where nothing in it means
/// anything to a shell, else between single quotes.
std::string shell_quoted(std::string_view word);
/// The same of a file's name, which a program does not take for an option where it begins with a dash.
std::string shell_quoted_path(std::string_view path);
/// A command of words that a shell reads back as they were.
std::string shell_quoted(const std::vector<std::string>& words);

}  // namespace skyloop::inline base
