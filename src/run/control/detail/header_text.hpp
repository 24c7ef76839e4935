/// How HTTP compares what stands in headers.
#pragma once

#include <algorithm>
#include <string_view>

namespace skyloop {

/// Without blanks and tabs at both ends.
inline std::string_view without_blanks(std::string_view text) {
    const std::size_t begin = std::min(text.find_first_not_of(" \t"), text.size());
    return text.substr(begin, text.find_last_not_of(" \t") + 1 - begin);
}

}  // namespace skyloop
