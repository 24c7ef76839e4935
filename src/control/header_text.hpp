/// How HTTP compares what stands in headers.
#pragma once

#include <algorithm>
#include <string>
#include <string_view>

namespace skyloop {

/// The letters A to Z as a to z, whatever the locale.
inline std::string in_lower_case(std::string_view text) {
    std::string lower(text);
    std::transform(lower.begin(), lower.end(), lower.begin(),
                   [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
    return lower;
}

/// Without blanks and tabs at both ends.
inline std::string_view without_blanks(std::string_view text) {
    const std::size_t begin = std::min(text.find_first_not_of(" \t"), text.size());
    return text.substr(begin, text.find_last_not_of(" \t") + 1 - begin);
}

}  // namespace skyloop
