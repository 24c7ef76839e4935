/// What an editor has marked as deleted in a file of OpenStreetMap.
#pragma once

#include <cstdint>
#include <set>
#include <string_view>

namespace skyloop {

struct OsmDeletions {
    std::set<std::int64_t> nodes, ways, relations;
};

/// Objects with action="delete", as JOSM keeps them in its files (OpenStreetMap wiki, "JOSM file format"), which
/// libosmium does not tell. Looks at XML as far as it is well-formed.
OsmDeletions osm_deletions(std::string_view xml);

}  // namespace skyloop
