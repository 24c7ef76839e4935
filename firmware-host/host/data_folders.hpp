/// Where the program finds its own data.
#pragma once

#include "run/emulator/assembly.hpp"

namespace skyloop::host {

/// In this order: $SKYLOOP_DATA_DIR, share/skyloop beside the folder of the running program, the installation's folder.
/// Its cache is skyloop in $XDG_CACHE_HOME, else in ~/.cache.
DataFolders data_folders();

}  // namespace skyloop::host
