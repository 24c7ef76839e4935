/// Texts that are compared without regard to case.
#pragma once

#include <string>
#include <string_view>

namespace skyloop {

/// A to Z as a to z, every other byte as it is, whatever the locale.
inline std::string lowered_text(std::string_view text) {
    std::string lower(text);
    for (char& letter : lower)
        if (letter >= 'A' && letter <= 'Z') letter = static_cast<char>(letter - 'A' + 'a');
    return lower;
}

}  // namespace skyloop
