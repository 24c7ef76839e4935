/// The files that a recording consists of, and what may happen to those that are in its folder already.
/// The files that a run reads, in one list for all who must know them.
#pragma once

#include <filesystem>
#include <optional>
#include <string_view>
#include <vector>

#include "base/core/result.hpp"
#include "run/emulator/data_folders.hpp"
#include "run/emulator/wires.hpp"
#include "run/scenario/scenario.hpp"

namespace skyloop::inline run {

/// Where the recording of a receiver lies: the first one's in the folder itself, the others' in receiver1 and so on.
std::filesystem::path recording_of(const std::filesystem::path& folder, std::size_t receiver);

/// Whether a recording may have a file of this name: fixes.csv, port0.out, …
bool is_recorded_name(std::string_view name);

/// Whether a run has been recorded there: it has left its run.json.
bool holds_recording(const std::filesystem::path& folder);

/// Takes away the recordings of receivers from this one on, which a former run with more of them has left. What else
/// lies in their folders stays.
void remove_recordings_from(const std::filesystem::path& folder, std::size_t receiver);

/// What a run must not write over.
struct SparedFiles {
    std::vector<std::filesystem::path> inputs;  ///< that it reads
    std::size_t receivers = 1;                  ///< that it records
};

/// Fails with `usage` when a recording in this folder would take the place of a file that the run reads.
Result<void> spare_inputs(const SparedFiles& spared_files, const std::filesystem::path& folder);

/// Fails with `usage` where bytes would go into a file that the run reads, its scenario among them, or into one that
/// belongs to its recording. @param folder of the recording; nothing without one
Result<void> spare_inputs_and_recording(const std::vector<WireEnd>& ends, const SparedFiles& spared_files,
                                        const std::optional<std::filesystem::path>& folder);

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

}  // namespace skyloop::inline run
