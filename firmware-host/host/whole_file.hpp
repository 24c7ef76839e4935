/// Files that a command writes at once.
#pragma once

#include <filesystem>
#include <string_view>

#include "base/core/result.hpp"

namespace skyloop::host {

/// Writes a file that is made anew. @return why not all of it is there, with its name
Result<void> write_whole_file(const std::filesystem::path& path, std::string_view text);

}  // namespace skyloop::host
