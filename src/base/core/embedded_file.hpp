/// Files inside the program; tools/cmake/EmbedFiles.cmake puts them there.
#pragma once

#include <span>
#include <string_view>

namespace skyloop::inline base {

struct EmbeddedFile {
    std::string_view name;
    std::string_view content;
};

}  // namespace skyloop::inline base
