/// The files that a run reads, in one list for all who must know them.
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "run/emulator/data_folders.hpp"
#include "run/scenario/scenario.hpp"

namespace skyloop {

/// A file that decides what a run does.
struct InputFile {
    std::filesystem::path path;
    /// Its bytes go into scenario_digest(). Those of others are in it already, with the scenario's text or the scene,
    /// or are what clients said, which is in none.
    bool in_digest = true;
};

/// Every file that the scenario, its options and its receivers name, in an order that is the same each time. Some need
/// not be there. Files that these name themselves, such as the materials of a mesh, are not among them.
/// @param repeat a recording whose clients' bytes are heard again
std::vector<InputFile> input_files(const Scenario& scenario, const DataFolders& data,
                                   const std::optional<std::filesystem::path>& repeat = std::nullopt);

}  // namespace skyloop
