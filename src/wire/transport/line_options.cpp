#include "detail/line_options.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <utility>

#include "base/core/letter_case.hpp"
#include "base/core/number_in.hpp"

namespace skyloop {
namespace {

// "8N1"; nothing for anything else.
std::optional<SerialFormat> read_format(std::string_view text) {
    if (text.size() != 3) return std::nullopt;
    const char parity = upper_case(text[1]);
    SerialFormat format;
    if (text[0] != '7' && text[0] != '8') return std::nullopt;
    if (parity != 'N' && parity != 'E' && parity != 'O') return std::nullopt;
    if (text[2] != '1' && text[2] != '2') return std::nullopt;
    format.data_bits = text[0] - '0';
    format.stop_bits = text[2] - '0';
    if (parity != 'N') format.parity = parity == 'E' ? Parity::even : Parity::odd;
    return format;
}

}  // namespace

std::optional<std::uint32_t> read_baud(std::string_view text) {
    const auto baud = number_in<std::uint32_t>(text);
    return baud && *baud >= lowest_baud && *baud <= highest_baud ? baud : std::nullopt;
}

std::string read_line_options(std::string_view text, SerialFormat& format) {
    bool shaped = false;
    for (std::size_t at = 0; at <= text.size();) {
        const std::size_t end = std::min(text.find(',', at), text.size());
        const std::string_view option = text.substr(at, end - at);
        at = end + 1;
        if (option == "rtscts") {
            if (std::exchange(format.rtscts, true)) return "option 'rtscts' is there twice";
            continue;
        }
        const auto shape = read_format(option);
        if (!shape) return fmt::format("option '{}' is not understood", option);
        if (std::exchange(shaped, true)) return fmt::format("option '{}' is a second format", option);
        const bool rtscts = format.rtscts;
        format = *shape;
        format.rtscts = rtscts;
    }
    return {};
}

}  // namespace skyloop
