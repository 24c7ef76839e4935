/// What is known of boards and adapters, as files (boards/autopilots/*.toml, boards/adapters/*.toml; every key in
/// boards/README.md).
#pragma once

#include <filesystem>
#include <span>
#include <string_view>
#include <vector>

#include "base/core/result.hpp"
#include "wire/devices/device_profile.hpp"

namespace skyloop {

/// Reads the TOML text of one device file.
/// @param name what messages call the file
/// Fails with `input`: a line per mistake, with file, line, column and key, what was found and what was expected.
Result<std::vector<DeviceProfile>> read_devices(std::string_view toml_text, std::string_view name);

/// The devices of all files in `autopilots/` and `adapters/` of the directories, in the order of the files' names. A
/// file hides those of the same name in later directories. None where there are no files. Fails with `input`: as
/// read_devices(), or two devices of one name or that nothing tells apart; with `outside` when a file cannot be read.
Result<std::vector<DeviceProfile>> load_devices(std::span<const std::filesystem::path> directories);

}  // namespace skyloop
