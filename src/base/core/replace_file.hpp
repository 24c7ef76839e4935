/// Writing small files whole or not at all.
#pragma once

#include <filesystem>
#include <string_view>

#include "base/core/result.hpp"

namespace skyloop {

/// Puts `content` into a file in one step: whoever reads meets the old file or the whole new one, also where several
/// write it at once or the program is killed. Of a link it is the file that the link leads to; a device or a pipe is
/// written to. Fails with `outside`; then the old file stands as it was, and nothing is left beside it.
Result<void> replace_file(const std::filesystem::path& path, std::string_view content);

/// Whether replace_file() can be done, as far as its folder tells, for who writes much later. Fails as that does;
/// changes nothing.
Result<void> check_replaceable(const std::filesystem::path& path);

}  // namespace skyloop
