/// Files that are read and must not be written over.
#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

#include "base/core/result.hpp"

namespace skyloop {

/// Fails with `usage` where a file to write is one of those that are read, also by a link: what was recorded there
/// would be lost. @param writer what messages call it: "--out"
Result<void> check_spares(std::string_view writer, const std::filesystem::path& out,
                          const std::vector<std::filesystem::path>& inputs);

}  // namespace skyloop
