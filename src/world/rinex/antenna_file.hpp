/// ANTEX files: phase centres of antennas.
#pragma once

#include <filesystem>
#include <string_view>

#include "base/core/result.hpp"
#include "world/gnss/antenna_calibration.hpp"

namespace skyloop::inline world {

/// Reads an ANTEX file of version 1.3 or 1.4 (M. Rothacher and R. Schmid, "ANTEX: The Antenna Exchange Format", 15 Sep
/// 2010) with absolute calibrations: offsets and variations of satellites and of receivers' antennas; their deviations
/// are passed over, and so are variations of satellites by azimuth. Of a receiver's antenna the one whose calibration
/// is of the type counts, not those of single pieces (with a serial number). Fails with `input` when the text is of
/// another kind, holds relative calibrations, or a line cannot be read.
/// @param name of the file, for messages
Result<AntennaCatalogue> read_antennas(std::string_view text, std::string_view name);

/// The same for a file, packed or not. Fails as read_text_file and read_antennas do.
Result<AntennaCatalogue> read_antenna_file(const std::filesystem::path& path);

}  // namespace skyloop::inline world
