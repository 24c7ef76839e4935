#include "detail/shown_text.hpp"

#include "base/core/utf8.hpp"

namespace skyloop {
namespace {

// C0, DEL and C1, which a terminal obeys, and the two that XML 1.0 does not have (section 2.2): U+FFFE, U+FFFF.
bool is_not_shown(std::string_view character) {
    const auto first = static_cast<unsigned char>(character[0]);
    if (character.size() == 1) return first < 0x20 || first == 0x7F;
    if (character == "\xEF\xBF\xBE" || character == "\xEF\xBF\xBF") return true;
    return first == 0xC2 && static_cast<unsigned char>(character[1]) < 0xA0;
}

}  // namespace

std::string shown_text(std::string_view text, std::size_t most) {
    std::string shown;
    for (std::size_t characters = 0; !text.empty(); ++characters) {
        if (characters == most) return shown + "…";
        const std::size_t length = utf8_length(text);
        if (length == 0 || is_not_shown(text.substr(0, length)))
            shown += '?';
        else
            shown += text.substr(0, length);
        text.remove_prefix(length == 0 ? 1 : length);
    }
    return shown;
}

}  // namespace skyloop
