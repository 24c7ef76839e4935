#include "base/core/words.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <vector>

namespace skyloop::inline base {

std::string on_a_terminal(std::string_view text) {
    std::string shown;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const auto byte = static_cast<unsigned char>(text[i]);
        const unsigned next = i + 1 < text.size() ? static_cast<unsigned char>(text[i + 1]) : 0U;
        if (byte == 0xC2 && next >= 0x80 && next < 0xA0) {  // a control character of Latin-1, in UTF-8
            shown += fmt::format("\\u{:04x}", next);
            ++i;
        } else if (byte < 0x20 || byte == 0x7F) {
            shown += byte == '\n' ? "\\n" : byte == '\t' ? "\\t" : fmt::format("\\u{:04x}", byte);
        } else {
            shown += text[i];
        }
    }
    return shown;
}

void say(std::string_view text) { static_cast<void>(std::fwrite(text.data(), 1, text.size(), stderr)); }

namespace {

// Optimal string alignment distance: edits of single letters and swaps of neighbours.
std::size_t edit_distance(std::string_view a, std::string_view b) {
    std::vector<std::vector<std::size_t>> d(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
    for (std::size_t i = 0; i <= a.size(); ++i)
        d[i][0] = i;
    for (std::size_t j = 0; j <= b.size(); ++j)
        d[0][j] = j;
    for (std::size_t i = 1; i <= a.size(); ++i)
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const std::size_t change = a[i - 1] == b[j - 1] ? 0 : 1;
            d[i][j] = std::min({d[i - 1][j] + 1, d[i][j - 1] + 1, d[i - 1][j - 1] + change});
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
                d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
        }
    return d[a.size()][b.size()];
}

}  // namespace

std::string nearest_word(std::string_view word, std::span<const std::string_view> candidates) {
    constexpr std::size_t longest_word = 100;  // the table is quadratic; nobody means anything by a longer word
    std::string_view best;
    // In a word of three letters two edits leave nothing that was meant.
    std::size_t best_distance = (word.size() <= 3 ? 1 : std::max<std::size_t>(2, word.size() / 3)) + 1;
    if (word.size() > longest_word) return {};
    for (const std::string_view candidate : candidates) {
        // A word that is the start of a known one, or the other way round, is a likely slip of memory, and one without
        // its unit, as at of at_s, even where it is short.
        const bool without_unit =
            word.size() >= 2 && candidate.starts_with(word) && candidate.substr(word.size()).starts_with('_');
        const bool prefix = without_unit || (std::min(word.size(), candidate.size()) >= 3 &&
                                             (candidate.starts_with(word) || word.starts_with(candidate)));
        // Each letter too many is an edit of its own: most candidates need no table.
        const std::size_t difference =
            std::max(word.size(), candidate.size()) - std::min(word.size(), candidate.size());
        if (!prefix && difference >= best_distance) continue;
        const std::size_t distance = prefix ? 1 : edit_distance(word, candidate);
        if (distance < best_distance) {
            best = candidate;
            best_distance = distance;
        }
    }
    return std::string(best);
}

std::string did_you_mean(std::string_view word, std::span<const std::string_view> candidates) {
    const std::string nearest = nearest_word(word, candidates);
    return nearest.empty() ? std::string() : "; did you mean '" + nearest + "'?";
}

std::string shell_quoted(std::string_view word) {
    constexpr std::string_view plain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-./:,+@%=";
    if (!word.empty() && word.find_first_not_of(plain) == std::string_view::npos) return std::string(word);
    std::string out = "'";
    for (const char c : word) {
        if (c == '\'')
            out += "'\\''";
        else
            out += c;
    }
    return out + "'";
}

std::string shell_quoted_path(std::string_view path) {
    return shell_quoted((path.starts_with('-') ? "./" : "") + std::string(path));
}

std::string shell_quoted(const std::vector<std::string>& words) {
    std::string out;
    for (const std::string& word : words)
        out += (out.empty() ? "" : " ") + shell_quoted(word);
    return out;
}

}  // namespace skyloop::inline base
