/// Parts of a command line.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace skyloop::firmware {

/// Characters of a command from which on it is refused (invented; the longest of any client named in the sources has
/// 60).
inline constexpr std::size_t too_long_command = 240;

/// Words in capitals; commas separate them as blanks do ("rtcm1077,com1,1").
std::vector<std::string> unicore_words(std::string_view line);

}  // namespace skyloop::firmware
