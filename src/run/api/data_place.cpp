#include "detail/data_place.hpp"

#include <dlfcn.h>

#include <system_error>

namespace skyloop::inline run {
namespace {

// Something of the library's own: a function that it shows may be taken for one of the program's.
constexpr char inside = 0;

// The data as it lies beside the library, wherever both were moved to together.
std::filesystem::path beside_library() {
    Dl_info found{};
    if (::dladdr(&inside, &found) == 0 || found.dli_fname == nullptr) return {};
    std::error_code none;
    const std::filesystem::path library = std::filesystem::canonical(found.dli_fname, none);
    if (none) return {};
    return (library.parent_path() / SKYLOOP_DATA_FROM_LIBRARY).lexically_normal();
}

}  // namespace

DataFolders library_data_folders(const char* named) {
    DataFolders data = find_data_folders(beside_library(), SKYLOOP_INSTALLED_DATA);
    if (named != nullptr && *named != '\0') data.folders.insert(data.folders.begin(), named);
    return data;
}

}  // namespace skyloop::inline run
