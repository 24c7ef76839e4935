/// Where the library finds the data that belongs to it.
#pragma once

#include "run/emulator/data_folders.hpp"

namespace skyloop::inline run {

/// The folder that a caller names first, then those of find_data_folders(), beside the loaded library first.
/// @param named null: none
DataFolders library_data_folders(const char* named);

}  // namespace skyloop::inline run
