#include "detail/header_text.hpp"

#include <fmt/format.h>

#include "base/time/utc_time.hpp"

namespace skyloop::rinex {

std::string header_line(std::string_view content, std::string_view label) {
    return fmt::format("{:<60}{:<20}\n", content, label);
}

std::string in_columns(std::string_view text, std::size_t width) {
    std::string result(width, ' ');
    for (std::size_t i = 0; i < width && i < text.size(); ++i)
        result[i] = text[i] >= ' ' && text[i] <= '~' ? text[i] : '?';
    return result;
}

std::string program_line(std::string_view program, GpsTime time) {
    const UtcTime utc = to_utc(time, LeapSeconds::announced());
    return header_line(in_columns(program, 20) + std::string(20, ' ') +
                           fmt::format("{:04}{:02}{:02} {:02}{:02}{:02} UTC", utc.year, utc.month, utc.day, utc.hour,
                                       utc.minute, utc.second),
                       "PGM / RUN BY / DATE");
}

}  // namespace skyloop::rinex
