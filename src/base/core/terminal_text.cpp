#include "base/core/terminal_text.hpp"

#include <fmt/format.h>

namespace skyloop {

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

}  // namespace skyloop
