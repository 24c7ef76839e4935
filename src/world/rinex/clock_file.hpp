/// RINEX clock files: clocks of satellites that were computed afterwards.
#pragma once

#include <filesystem>
#include <string_view>

#include "base/core/result.hpp"
#include "world/gnss/precise_orbits.hpp"

namespace skyloop::inline world {

/// Reads the records AS of a RINEX clock file, version 2 or 3 (J. Ray and W. Gurtner, "RINEX extensions to handle clock
/// information", revisions 3.00 to 3.04); records of stations, discontinuities and the like are passed over. Times
/// become GPST. Fails with `input` when the text is of another kind, a line cannot be read, times of a satellite do not
/// ascend, or no satellite has two clocks.
/// @param name of the file, for messages
Result<PreciseClocks> read_clocks(std::string_view text, std::string_view name);

/// The same for a file, packed or not. Fails as read_text_file and read_clocks do.
Result<PreciseClocks> read_clock_file(const std::filesystem::path& path);

}  // namespace skyloop::inline world
