/// Where the program's own data lies.
#pragma once

#include <filesystem>
#include <vector>

namespace skyloop::inline run {

/// Folders that may hold boards/ and geoids/, the first that has a thing wins.
struct DataFolders {
    std::vector<std::filesystem::path> folders;
    std::filesystem::path cache{};  ///< where cities are kept that take time to read; empty: nowhere
};

/// In this order: $SKYLOOP_DATA_DIR, the two that are given. The cache is skyloop in $XDG_CACHE_HOME, else in ~/.cache.
/// @param beside of the running program or library; empty: not known
/// @param installed where the installation was told to put it
DataFolders find_data_folders(const std::filesystem::path& beside, const std::filesystem::path& installed);

}  // namespace skyloop::inline run
