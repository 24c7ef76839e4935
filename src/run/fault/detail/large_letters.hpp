/// Names that people may write in letters of any case.
#pragma once

#include <string>
#include <string_view>

namespace skyloop {

/// a to z as A to Z, every other byte as it is.
inline std::string large_letters(std::string_view text) {
    std::string large(text);
    for (char& c : large)
        if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
    return large;
}

}  // namespace skyloop
