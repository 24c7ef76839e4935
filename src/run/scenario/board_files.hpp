/// Receiver profiles as files (boards/receivers/*.toml; every key in boards/README.md).
///
/// What is known of boards and adapters, as files (boards/autopilots/*.toml, boards/adapters/*.toml; every key in
/// boards/README.md).
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/core/result.hpp"
#include "firmware/core/board_profile.hpp"
#include "wire/devices/device_profile.hpp"

namespace skyloop::inline run {

/// Reads the TOML text of one receiver profile.
/// @param name what messages call the file, "boards/receivers/ublox-m8.toml"; its stem is the profile's name
/// @param directories as of find_board_file(), for the board that this one extends; its own folder comes before them
/// Fails with `input`: the sentence names file, line, column and key, what was found and what was expected.
Result<firmware::BoardProfile> read_board(std::string_view toml_text, std::string_view name,
                                          std::span<const std::filesystem::path> directories = {});

/// Whether a name is the path of a board's file: it ends in ".toml".
bool is_board_path(std::string_view name);

/// Where the profile of this name lies: `receivers/<name>.toml` in the first of `directories` that has one; of a
/// path (is_board_path()) that file; of an alias, in letters of any case, the file that names it. Nothing for an
/// unknown name.
std::optional<std::filesystem::path> find_board_file(std::string_view name,
                                                     std::span<const std::filesystem::path> directories);

/// The profile of this name, from that file. Fails with `usage` for an unknown name, listing the nearest and the known
/// ones.
Result<firmware::BoardProfile> find_board(std::string_view name, std::span<const std::filesystem::path> directories);

/// The names of all profiles in `directories`, sorted, each once.
std::vector<std::string> list_boards(std::span<const std::filesystem::path> directories);

/// Reads the TOML text of one device file.
/// @param name what messages call the file
/// Fails with `input`: a line per mistake, with file, line, column and key, what was found and what was expected.
Result<std::vector<DeviceProfile>> read_devices(std::string_view toml_text, std::string_view name);

/// The devices of all files in `autopilots/` and `adapters/` of the directories, in the order of the files' names. A
/// file hides those of the same name in later directories. None where there are no files. Fails with `input`: as
/// read_devices(), or two devices of one name or that nothing tells apart; with `outside` when a file cannot be read.
Result<std::vector<DeviceProfile>> load_devices(std::span<const std::filesystem::path> directories);

}  // namespace skyloop::inline run
