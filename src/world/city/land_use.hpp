/// How land is used, from OpenStreetMap.
#pragma once

#include <cstddef>
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

struct LandUse {
    std::vector<LandUseArea> areas;
    std::size_t cut = 0;  ///< areas that were left out: corners of them are not in the file, as at an extract's edge
};

/// The areas that have one of some tags, in the order of the file's numbers: of several tags the first in `uses`.
/// .osm or .pbf, also compressed. Fails with `outside` when it cannot be opened, with `input` and FILE:LINE or the
/// place when it is damaged, of another format, or has no such area.
Result<LandUse> read_land_use(const std::filesystem::path& path, std::span<const std::string_view> uses);

}  // namespace skyloop::inline world
