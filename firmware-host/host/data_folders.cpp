#include "data_folders.hpp"

#include <system_error>

namespace skyloop::host {

DataFolders data_folders() {
    std::error_code none;
    const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", none);
    const std::filesystem::path beside =
        none ? std::filesystem::path() : program.parent_path().parent_path() / "share" / "skyloop";
    return find_data_folders(beside, SKYLOOP_INSTALLED_DATA);
}

}  // namespace skyloop::host
