/// The page, as files inside the program.
#pragma once

#include <span>

#include "base/core/embedded_file.hpp"

namespace skyloop {

/// Those of src/run/control/page, by name.
std::span<const EmbeddedFile> page_files();

}  // namespace skyloop
