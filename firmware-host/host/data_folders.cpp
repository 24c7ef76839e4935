#include "data_folders.hpp"

#include <cstdlib>
#include <system_error>

namespace skyloop::host {

namespace {

// As the XDG base directory specification says: a relative path there does not count.
std::filesystem::path cache_folder() {
    if (const char* named = std::getenv("XDG_CACHE_HOME"); named && *named == '/')
        return std::filesystem::path(named) / "skyloop";
    if (const char* home = std::getenv("HOME"); home && *home == '/')
        return std::filesystem::path(home) / ".cache" / "skyloop";
    return {};
}

}  // namespace

DataFolders data_folders() {
    namespace fs = std::filesystem;
    DataFolders data;
    if (const char* named = std::getenv("SKYLOOP_DATA_DIR"); named && *named) data.folders.emplace_back(named);
    std::error_code none;
    const fs::path program = fs::read_symlink("/proc/self/exe", none);
    if (!none) data.folders.push_back(program.parent_path().parent_path() / "share" / "skyloop");
    data.folders.emplace_back(SKYLOOP_INSTALLED_DATA);
    data.cache = cache_folder();
    return data;
}

}  // namespace skyloop::host
