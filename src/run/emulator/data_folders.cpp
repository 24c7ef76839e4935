#include "run/emulator/data_folders.hpp"

#include <cstdlib>

namespace skyloop::inline run {
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

DataFolders find_data_folders(const std::filesystem::path& beside, const std::filesystem::path& installed) {
    DataFolders data;
    if (const char* named = std::getenv("SKYLOOP_DATA_DIR"); named && *named) data.folders.emplace_back(named);
    if (!beside.empty()) data.folders.push_back(beside);
    data.folders.push_back(installed);
    data.cache = cache_folder();
    return data;
}

}  // namespace skyloop::inline run
