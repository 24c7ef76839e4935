/// IONEX files: maps of the ionosphere's electron content.
#pragma once

#include <filesystem>
#include <string_view>

#include "base/core/result.hpp"
#include "base/time/utc_time.hpp"
#include "world/gnss/shell_ionosphere.hpp"

namespace skyloop::inline world {

/// Reads the two-dimensional TEC maps of an IONEX 1.0 or 1.1 text; maps of RMS and height are passed over. Epochs are
/// UT and taken as UTC.
/// Fails with `input` and one line FILE:LINE when the text is of another kind, has a map whose grid, epoch or values
/// differ from what its header says, has no map, or ends within one.
/// @param name of the file, for messages
Result<IonosphereMaps> read_ionex(std::string_view text, std::string_view name,
                                  const LeapSeconds& leap_seconds = LeapSeconds::announced());

/// The same for a file, packed or not. Fails as read_text_file and read_ionex do.
Result<IonosphereMaps> read_ionex_file(const std::filesystem::path& path);

}  // namespace skyloop::inline world
