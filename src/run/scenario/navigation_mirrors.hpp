/// The file of mirrors that publish navigation files.
#pragma once

#include <filesystem>
#include <span>
#include <string_view>
#include <vector>

#include "base/core/result.hpp"
#include "world/broadcast/daily_navigation.hpp"

namespace skyloop::inline run {

/// Reads a list of mirrors: tables [[mirror]] with `name` and `addresses`. Fails with `input`: a line per mistake.
/// @param name of the file, for messages
Result<std::vector<NavigationMirror>> read_navigation_mirrors(std::string_view toml_text, std::string_view name);

/// The mirrors of navigation_mirrors.toml in the first of the folders that has it. Fails with `outside` where none has,
/// and as above.
Result<std::vector<NavigationMirror>> find_navigation_mirrors(std::span<const std::filesystem::path> folders);

}  // namespace skyloop::inline run
