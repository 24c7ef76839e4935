/// SP3 files of precise orbits and clocks.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "base/core/result.hpp"
#include "world/gnss/precise_orbits.hpp"

namespace skyloop::inline world {

/// What an SP3 file holds.
struct PreciseOrbitFile {
    PreciseOrbits orbits;
    char version = 'c';               ///< 'a' … 'd'
    std::string time_system = "GPS";  ///< as the file names it
    int epochs = 0;
    int positions = 0;         ///< rows with a position
    int without_position = 0;  ///< rows whose position is given as unknown
    int other_vehicles = 0;    ///< rows of satellites of no navigation system
};

/// Reads the text of an SP3-a, -b, -c or -d file (NGS and IGS, "The extended standard product 3 orbit format"):
/// positions and clocks; velocities and accuracies are passed over. Times become GPST. Fails with `input` when the text
/// is of another kind, a line cannot be read, or there are fewer than two epochs.
/// @param name of the file, for messages
Result<PreciseOrbitFile> read_precise_orbits(std::string_view text, std::string_view name);

/// The same for a file, packed or not. Fails as read_text_file and read_precise_orbits do.
Result<PreciseOrbitFile> read_precise_orbit_file(const std::filesystem::path& path);

}  // namespace skyloop::inline world
