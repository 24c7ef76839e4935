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

}  // namespace skyloop
