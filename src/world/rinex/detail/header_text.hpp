/// Header lines of RINEX files that are written.
#pragma once

#include <string>
#include <string_view>

#include "base/time/gps_time.hpp"

namespace skyloop::rinex {

/// A header line: content in columns 1-60, label in 61-80, and its end.
std::string header_line(std::string_view content, std::string_view label);

/// The text in exactly `width` columns, cut or filled with spaces; what is not printable ASCII becomes '?'.
std::string in_columns(std::string_view text, std::size_t width);

/// PGM / RUN BY / DATE; the date is that of `time` in UTC, so that the same run gives the same bytes on any day.
std::string program_line(std::string_view program, GpsTime time);

}  // namespace skyloop::rinex
