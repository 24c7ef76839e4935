#include "data_folders.hpp"

#include <cstdlib>
#include <system_error>

namespace skyloop::host {

DataFolders data_folders() {
    namespace fs = std::filesystem;
    DataFolders data;
    if (const char* named = std::getenv("SKYLOOP_DATA_DIR"); named && *named) data.folders.emplace_back(named);
    std::error_code none;
    const fs::path program = fs::read_symlink("/proc/self/exe", none);
    if (!none) data.folders.push_back(program.parent_path().parent_path() / "share" / "skyloop");
    data.folders.emplace_back(SKYLOOP_INSTALLED_DATA);
    return data;
}

}  // namespace skyloop::host
