#include "world/city/land_use.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "base/core/files.hpp"
#include "base/core/words.hpp"
#include "detail/companion_files.hpp"
#include "detail/outlines.hpp"

namespace skyloop::inline world {
namespace {

bool has_tag(const OutlineTags& tags, std::string_view use) {
    const std::size_t sign = use.find('=');
    const auto found = tags.find(use.substr(0, sign));
    return found != tags.end() && found->second == use.substr(sign + 1);
}

std::vector<Geodetic> corners_of(const std::vector<Eigen::Vector2d>& ring) {
    std::vector<Geodetic> corners;
    for (const Eigen::Vector2d& corner : ring)
        corners.push_back(Geodetic::degrees(corner.y(), corner.x(), 0));
    return corners;
}

}  // namespace

Result<LandUse> read_land_use(const std::filesystem::path& path, std::span<const std::string_view> uses) {
    const std::string name = lower_case(path.filename().string());
    const bool packed = name.find(".pbf") != std::string::npos;
    if (!packed && name.find(".osm") == std::string::npos)
        return fail(
            ErrorCode::input,
            fmt::format("{}: is no file of OpenStreetMap by its name; expected .osm or .osm.pbf", path.string()));
    const auto bytes = read_uncompressed(path, most_city_bytes({}));
    if (!bytes) return fail(bytes.error());
    const auto use_of = [&](const OutlineTags& tags) {
        OutlineUse use;
        for (const std::string_view one : uses)
            if (use.land.empty() && has_tag(tags, one)) use.land = one;
        if (!use.land.empty()) use.kind = OutlineUse::Kind::land;
        return use;
    };
    const auto read = read_osm_outlines(*bytes, packed ? "osm.pbf" : "osm", path.string(), use_of);
    if (!read) return fail(read.error());
    std::vector<LandUseArea> areas;
    for (const Outline& outline : read->outlines) {
        areas.push_back({outline.use.land, corners_of(outline.footprint.outer), {}});
        for (const auto& hole : outline.footprint.holes)
            areas.back().holes.push_back(corners_of(hole));
    }
    if (areas.empty() && read->dropped > 0)
        return fail(ErrorCode::input,
                    fmt::format("{}: of its {} areas of a known use none has all its corners in the file",
                                path.string(), read->dropped));
    if (areas.empty())
        return fail(ErrorCode::input, fmt::format("{}: has no area of a known use; expected one, as {}", path.string(),
                                                  fmt::join(uses.first(std::min<std::size_t>(uses.size(), 3)), ", ")));
    return LandUse{std::move(areas), read->dropped};
}

}  // namespace skyloop::inline world
