/// Cities that take time to read are kept as they were understood, for the next time.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "world/city/city_file.hpp"

namespace skyloop::inline world {

/// Where cities are kept, and which.
struct CityCache {
    std::filesystem::path folder;  ///< made when it is needed; empty: none are kept
    double worth_seconds = 0.25;   ///< what took less to read, on the steady clock, is not kept
};

/// A city and what it was read from.
struct CityReading {
    CityFile file;
    std::uint64_t digest = 0;  ///< of the bytes of the file and of those that it names
    bool from_cache = false;
};

/// As read_city(), but from the cache when it holds what these bytes and settings give; what was read is kept there. A
/// damaged, cut or foreign file in the cache is replaced; a cache that cannot be written is none. Fails as read_city().
Result<CityReading> read_city(const std::filesystem::path& path, const CityFileSettings& settings,
                              const CityCache& cache);

/// The file in the cache's folder that is for a city file, whatever that holds.
std::filesystem::path cached_city_path(const std::filesystem::path& path, const CityCache& cache);

/// What a cache file holds. @param key of source and settings
std::string encode_city(const CityFile& file, std::uint64_t key);
/// Nothing for bytes that are not what encode_city() made with this key on a machine of this kind.
std::optional<CityFile> decode_city(std::string_view bytes, std::uint64_t key);

}  // namespace skyloop::inline world
