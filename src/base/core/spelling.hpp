/// What a user may have meant by a word that is not known.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace skyloop {

/// The candidate with the smallest edit distance to `word` (insertions, deletions, substitutions and swaps of
/// neighbours), or an empty string when none is near enough to be meant.
std::string nearest_word(std::string_view word, std::span<const std::string_view> candidates);

/// "; did you mean 'X'?" for the nearest candidate, or an empty string.
std::string did_you_mean(std::string_view word, std::span<const std::string_view> candidates);

}  // namespace skyloop
