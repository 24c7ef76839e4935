/// Files that another file names.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>

#include "world/city/city_file.hpp"

namespace skyloop::inline world {

/// Bytes, after decompression, of which a city may hold so many in one file: 4 GiB, 50 million triangles as text, or as
/// many as its scene may take.
inline std::size_t most_city_bytes(const CityFileSettings& settings) {
    constexpr std::size_t most = std::size_t{4} << 30;
    return settings.memory_limit == 0 ? most : std::min(most, settings.memory_limit);
}

/// Gives the content of a file by its name inside the folder of the one that names it (name_inside() has been asked).
/// Fails when there is none.
using CompanionFiles = std::function<Result<std::string>(const std::string& inside)>;

/// The file that a path to a city means: itself, or the one scene of a folder. Fails when that holds none or several.
Result<std::filesystem::path> file_of_city(const std::filesystem::path& path);

/// Of a file's bytes as they stand on the disk.
Result<std::uint64_t> digest_of_file(const std::filesystem::path& path);

/// A Mitsuba scene (version 2 and 3): the shapes of kind "ply" that it names, their to_world transform, and
/// materials by the identity of their bsdf; z is up. Shapes of other kinds are dropped with a warning.
Result<CityFile> parse_mitsuba(std::string_view xml, std::string_view name, const CityFileSettings& settings,
                               const CompanionFiles& companions);

/// parse_gltf() with buffers in files beside it.
Result<CityFile> parse_gltf_with(std::string_view bytes, std::string_view name, const CityFileSettings& settings,
                                 const CompanionFiles& companions);

}  // namespace skyloop::inline world
