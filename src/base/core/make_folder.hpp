/// Making folders, or saying why not.
#pragma once

#include <filesystem>

#include "base/core/result.hpp"

namespace skyloop {

/// Makes a folder and those above it, where they are not there yet. Tells whether it was made now. Fails with
/// `outside`.
Result<bool> make_folder(const std::filesystem::path& folder);

}  // namespace skyloop
