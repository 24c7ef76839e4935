/// What may be said of a serial line behind its name.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "base/core/line_format.hpp"

namespace skyloop {

inline constexpr std::uint32_t lowest_baud = 50, highest_baud = 12'000'000;  // bit/s

/// A speed in bit/s, from lowest_baud to highest_baud; nothing for anything else.
std::optional<std::uint32_t> read_baud(std::string_view text);
/// Reads "8N1", "rtscts" or both, with a comma between, into `format`. Gives nothing when all was understood; else what
/// is wrong, for a sentence.
std::string read_line_options(std::string_view text, SerialFormat& format);

}  // namespace skyloop
