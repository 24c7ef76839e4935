#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <utility>

#include "base/core/number_text.hpp"
#include "base/core/words.hpp"
#include "detail/line_settings.hpp"

namespace skyloop::inline wire {
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

namespace {

struct SpeedCode {
    std::uint32_t baud;
    tcflag_t code;
};
constexpr std::array<SpeedCode, 10> speed_codes{{{4800, B4800},
                                                 {9600, B9600},
                                                 {19200, B19200},
                                                 {38400, B38400},
                                                 {57600, B57600},
                                                 {115200, B115200},
                                                 {230400, B230400},
                                                 {460800, B460800},
                                                 {921600, B921600},
                                                 {1000000, B1000000}}};

tcflag_t speed_code(std::uint32_t baud) {
    for (const SpeedCode& s : speed_codes)
        if (s.baud == baud) return s.code;
    return BOTHER;
}

constexpr tcflag_t format_bits = CSIZE | PARENB | PARODD | CSTOPB | CRTSCTS;

tcflag_t bits_of(const SerialFormat& format) {
    tcflag_t bits = format.data_bits == 7 ? CS7 : CS8;
    if (format.parity != Parity::none) bits |= PARENB;
    if (format.parity == Parity::odd) bits |= PARODD;
    if (format.stop_bits == 2) bits |= CSTOPB;
    if (format.rtscts) bits |= CRTSCTS;
    return bits;
}

}  // namespace

void make_raw(termios2& settings) {
    settings.c_iflag = 0;
    settings.c_oflag = 0;
    settings.c_lflag = 0;
    settings.c_cflag = (settings.c_cflag & ~static_cast<tcflag_t>(CSIZE | PARENB)) | CS8 | CREAD | CLOCAL;
    settings.c_cc[VMIN] = 1;
    settings.c_cc[VTIME] = 0;
}

void put_speed(termios2& settings, std::uint32_t baud) {
    settings.c_cflag &= ~static_cast<tcflag_t>(CBAUD | (CBAUD << IBSHIFT));
    settings.c_cflag |= speed_code(baud);
    settings.c_ispeed = settings.c_ospeed = baud;
}

void put_format(termios2& settings, const SerialFormat& format) {
    settings.c_cflag = (settings.c_cflag & ~format_bits) | bits_of(format);
}

bool has_format(const termios2& settings, const SerialFormat& format) {
    return (settings.c_cflag & format_bits) == bits_of(format);
}

}  // namespace skyloop::inline wire
