/// How land is used, from OpenStreetMap.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/core/result.hpp"
#include "base/geo/geodetic.hpp"

namespace skyloop::inline world {

/// An area of one use.
struct LandUseArea {
    std::string use;  ///< the tag, as "landuse=forest"
    std::vector<Geodetic> outer;
    std::vector<std::vector<Geodetic>> holes;
};

/// The areas that have one of some tags, in the order of the file's numbers: of several tags the first in `uses`.
/// .osm or .pbf, also compressed. Areas of which corners are missing, as at the edge of an extract, are left out. Fails
/// with `outside` when it cannot be opened, with `input` and FILE:LINE or the place when it is damaged, of another
/// format, or has no such area.
Result<std::vector<LandUseArea>> read_land_use(const std::filesystem::path& path,
                                               std::span<const std::string_view> uses);

}  // namespace skyloop::inline world
