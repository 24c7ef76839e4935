/// What libosmium does not tell of the text of an .osm file. Both look at XML as far as it is well-formed.
/// The frame of an OpenStreetMap PBF file, looked at before libosmium reads what is in it.
#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <string_view>

#include "base/core/result.hpp"

namespace skyloop::inline world {

struct OsmDeletions {
    std::set<std::int64_t> nodes, ways, relations;
};

/// Objects with action="delete", as JOSM keeps them in its files (OpenStreetMap wiki, "JOSM file format").
OsmDeletions osm_deletions(std::string_view xml);

/// The first coordinate with an exponent that has no place on Earth, a part of `xml`: libosmium 2.19 overflows as it
/// multiplies, and takes what comes out for a place.
std::optional<std::string_view> wild_coordinate(std::string_view xml);

/// Whether a file is a row of whole blobs, each with its type and size (OpenStreetMap wiki, "PBF Format": a length of
/// four bytes, a BlobHeader of at most 64 kB, a Blob of at most 32 MB). Fails with `input`, naming file and byte: a
/// file that was cut in the middle is told as that. libosmium 2.18 compares the type of a header that has none.
Result<void> check_pbf_blobs(std::string_view bytes, std::string_view name);

}  // namespace skyloop::inline world
