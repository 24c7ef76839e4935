/// Where the program finds its own data.
#pragma once

#include "skyloop/emulator/assembly.hpp"

namespace skyloop::host {

/// In this order: $SKYLOOP_DATA_DIR, share/skyloop beside the folder of the running program, the installation's folder.
DataFolders data_folders();

/// The folders of receiver boards among them.
std::vector<std::filesystem::path> board_folders(const DataFolders& data);

}  // namespace skyloop::host
