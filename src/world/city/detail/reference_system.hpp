/// What the numbers of a file are, by the name of their reference system.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace skyloop {

/// What a file's numbers are.
enum class CoordinateKind {
    geographic,  ///< longitude, latitude (degrees), height (m)
    projected,   ///< east, north, height of a map projection, m
    local        ///< metres from the frame's origin as they stand
};

/// The kind of a named reference system and the order of its axes.
struct ReferenceSystem {
    CoordinateKind kind = CoordinateKind::projected;
    bool latitude_first = false;
    std::string name;         ///< for messages: "EPSG:7415"
    std::optional<int> code;  ///< of EPSG, of the horizontal part of a compound where that is told
    bool named = true;        ///< false where `name` is a word of ours
    bool sea_level = false;   ///< its heights count from the sea, or nearly so: all vertical systems are taken for that
};

/// Reads "EPSG:4326", "urn:ogc:def:crs:EPSG::25832", "http://www.opengis.net/def/crs/EPSG/0/6697", the first part of
/// compounds ("EPSG:4326+5773", "urn:ogc:def:crs,crs:EPSG::4258,crs:EPSG::5783"), in any case, CRS84 and the AdV's
/// names of UTM; anything else counts as projected. A second part names heights. Absent for an empty name.
std::optional<ReferenceSystem> reference_system(std::string_view name);

}  // namespace skyloop
