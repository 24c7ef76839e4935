/// What GeoJSON and OpenStreetMap have in common: outlines with tags.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "place_on_earth.hpp"
#include "world/city/city_file.hpp"
#include "world/city/footprint.hpp"

namespace skyloop::inline world {

using OutlineTags = std::map<std::string, std::string, std::less<>>;

/// What stands on an outline. Keys as in OpenStreetMap's "Simple 3D Buildings" and the names that other makers use.
struct OutlineUse {
    enum class Kind { none, building, part, trees, land } kind = Kind::none;
    std::optional<double> top;  ///< m above the ground; absent where no tag tells it
    double base = 0;            ///< m above the ground
    bool canopy = false;        ///< a roof without walls
    std::string material;       ///< empty where no tag tells it
    std::string land;           ///< how land is used, as "landuse=meadow"
};
/// What an outline is whose tags name neither a building nor a wood.
enum class UnnamedOutline {
    nothing,     ///< OpenStreetMap names all
    tall_house,  ///< a building where the tags tell a height and are of no other thing: beside ones that are named
    house        ///< a building unless the tags are of another thing and tell no height
};
OutlineUse outline_use(const OutlineTags& tags, const CityFileSettings& settings, UnnamedOutline unnamed);
/// Of what an outline does not tell takes what another does: a part from its building, an area from its border.
void inherit(OutlineUse& use, const OutlineUse& from);
/// True when tags tell buildings from other things.
bool tells_buildings(const OutlineTags& tags);

/// A length: "12", "12.5 m", "12,5", "40 ft", "39'6\"", the first of "12;14"; m. Absent for what is none or no height
/// of a thing, 0 … 1000 m.
std::optional<double> length_of_tag(std::string_view text);

/// An outline in the file's coordinates.
struct Outline {
    Footprint footprint;
    OutlineUse use;
};

/// A file's outlines, and what could not be read of them.
struct Outlines {
    std::vector<Outline> outlines;
    ReferenceSystem system;
    std::size_t dropped = 0;  ///< outlines without area or with wrong or missing corners
    std::vector<std::string> warnings;
};

/// What an outline of OpenStreetMap is, by its tags.
using OutlineUseOf = std::function<OutlineUse(const OutlineTags&)>;

/// The outlines of a file of OpenStreetMap that are something: degrees. Fails as parse_osm().
Result<Outlines> read_osm_outlines(std::string_view bytes, std::string_view format, std::string_view name,
                                   const OutlineUseOf& use_of);

void turn_longitudes(Footprint& footprint, LongitudeTurn& turn);

/// Places outlines and raises houses on them: the ground is level with the origin. Parts that cover at least half of a
/// building's outline replace it; what they do not tell of height and material is the building's. Wide woods become
/// several prisms, so that they follow the Earth. Buildings without a height are `settings.default_height` tall, woods
/// 12 m, of which the lowest quarter are trunks.
Result<CityFile> city_of_outlines(Outlines read, std::string_view format, std::string_view name,
                                  const CityFileSettings& settings);

}  // namespace skyloop::inline world
