/// What the numbers of a file are, by the name of their reference system.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "earth_map.hpp"

namespace skyloop {

struct CityFileSettings;

/// What a file's numbers are.
enum class CoordinateKind {
    geographic,  ///< longitude, latitude (degrees), height (m)
    projected,   ///< east, north, height of a map projection, m
    local        ///< metres from the frame's origin as they stand
};

/// A reference system and the order of its axes in the file.
struct ReferenceSystem {
    CoordinateKind kind = CoordinateKind::projected;
    bool north_first = false;       ///< latitude or northing come first
    std::string name;               ///< "EPSG:7415", as reference_system() reads it again
    bool named = true;              ///< false where `name` is a word of ours
    std::shared_ptr<EarthMap> map;  ///< absent for degrees of WGS 84, and where PROJ knows no such system
    std::optional<Error> unknown;   ///< why a named system has no map

    [[nodiscard]] bool has_sea_heights() const { return map && !map->vertical_system.empty(); }
    [[nodiscard]] bool lies_on_earth() const { return map || kind == CoordinateKind::geographic; }
};

/// Degrees of WGS 84, longitude first.
inline ReferenceSystem wgs84_degrees(std::string name) {
    return {CoordinateKind::geographic, false, std::move(name), true, {}, {}};
}
/// Numbers of which a file tells nothing.
inline ReferenceSystem unnamed_system(CoordinateKind kind, std::string name = "unnamed") {
    return {kind, false, std::move(name), false, {}, {}};
}

/// Reads "EPSG:4326", "urn:ogc:def:crs:EPSG::25832", "http://www.opengis.net/def/crs/EPSG/0/6697", compounds
/// ("EPSG:4326+5773", "urn:ogc:def:crs,crs:EPSG::4258,crs:EPSG::5783"), in any case, CRS84, the AdV's names of UTM, and
/// what else PROJ reads, such as WKT. Axes are in the registry's order for latitudes and longitudes, and for maps where
/// the name is an OGC URN or URL, as GDAL takes those of GML. Absent for an empty name.
std::optional<ReferenceSystem> reference_system(std::string_view name);

/// That of `file_crs` of the settings, else that which the file names.
std::optional<ReferenceSystem> reference_system_of_file(std::string_view name, const CityFileSettings& settings);

}  // namespace skyloop
