/// The page, as files inside the program.
#pragma once

#include <span>
#include <string_view>

namespace skyloop {

struct PageFile {
    std::string_view path;  ///< "/index.html"
    std::string_view content;
};

/// Those of src/run/control/page, by path. Written by tools/cmake/EmbedPage.cmake.
std::span<const PageFile> page_files();

}  // namespace skyloop
