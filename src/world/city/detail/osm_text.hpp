/// What libosmium does not tell of the text of an .osm file. Both look at XML as far as it is well-formed.
#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <string_view>

namespace skyloop {

struct OsmDeletions {
    std::set<std::int64_t> nodes, ways, relations;
};

/// Objects with action="delete", as JOSM keeps them in its files (OpenStreetMap wiki, "JOSM file format").
OsmDeletions osm_deletions(std::string_view xml);

/// The first coordinate with an exponent that has no place on Earth, a part of `xml`: libosmium 2.19 overflows as it
/// multiplies, and takes what comes out for a place.
std::optional<std::string_view> wild_coordinate(std::string_view xml);

}  // namespace skyloop
