/// Cities from files.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/core/result.hpp"
#include "base/geo/geoid.hpp"
#include "world/scene/city_model.hpp"

namespace skyloop::inline world {

/// Which axis of a file points where: three of x y z, each with an optional minus, for east, north and up. "x,y,z" is
/// the usual one; "x,-z,y" glTF and other models with y up; "y,x,z" the left-handed levels of Unreal Engine (x north).
struct FileAxes {
    std::array<int, 3> axis{0, 1, 2};  ///< of the file for east, north, up
    std::array<double, 3> sign{1, 1, 1};

    /// Reads "x,y,z" and its kin. Fails with `usage` and what was found.
    static Result<FileAxes> parse(std::string_view text);
};

/// What of a map lies at the origin of a city's frame.
struct MapAnchor {
    std::string system;           ///< "EPSG:7415", or a word where the file names none
    bool named = true;            ///< false for such a word
    double east = 0, north = 0;   ///< of the map, m
    std::optional<double> level;  ///< of the ground in its heights, m; absent after outlines, which have none
};

/// What the heights of a file that lies on the Earth count from.
enum class CityHeights {
    as_told,    ///< by its reference system: the sea where that names heights of its own, else the ellipsoid
    sea_level,  ///< the geoid
    ellipsoid
};

/// How a file is to be read.
struct CityFileSettings {
    /// Where the frame lies. When it is absent, files with places on the Earth take the middle of what they hold; local
    /// ones, and those of a map that PROJ does not know, lie at 0° N 0° E, the latter with a warning.
    std::optional<Geodetic> origin;
    bool origin_is_guess = false;     ///< for what warnings say
    std::optional<MapAnchor> anchor;  ///< of a file of the same scene that was read before, beside which this one lies
    /// In place of the reference system that a file names or leaves out: whatever PROJ reads, such as
    /// "EPSG:25832+7837", or "local": metres of no map. A GeoTIFF's own goes first. Empty: as told.
    std::string file_crs;
    CityHeights heights = CityHeights::as_told;
    const Geoid* geoid = nullptr;  ///< without one heights above the sea are taken as they stand
    /// Which place of a mesh lies at the frame's origin, in units and axes of the file: meshes in coordinates of a map.
    Eigen::Vector3d file_origin = Eigen::Vector3d::Zero();
    std::optional<FileAxes> axes;             ///< absent: as the format says
    double metres_per_unit = 1;               ///< 0.01 for levels in centimetres
    std::string material = "concrete";        ///< of triangles of which the file tells none
    double default_height = 9;                ///< of footprints without height or levels, m
    double metres_per_level = 3;              ///< OpenStreetMap
    std::size_t most_triangles = 50'000'000;  ///< a file with more is refused with an estimate of its memory
    std::size_t memory_limit = 0;             ///< of the scene, bytes: no file may hold more; 0: none
};

/// Fails with `usage` and what is wrong with a value of CityFileSettings::file_crs.
Result<void> check_file_crs(std::string_view name);

/// A file that a city names and that was read with it.
struct CityCompanion {
    std::string name;          ///< from the folder of the city's file
    std::uint64_t digest = 0;  ///< of its bytes
};

/// What was read, and what was not.
struct CityFile {
    CityModel model;
    std::string format;                     ///< "obj", "cityjson", …
    std::size_t buildings = 0;              ///< where the format tells them apart
    std::size_t dropped = 0;                ///< facets or footprints that could not be used
    std::vector<std::string> warnings;      ///< one clear line each: what was dropped and why, doubtful units
    std::vector<CityCompanion> companions;  ///< in the order of their names
    std::optional<MapAnchor> anchor;        ///< of files in a map projection, and of meshes whose file_origin is such
};

/// Reads a city by the ending of its name: .obj .ply .gltf .glb .geojson .json (CityJSON, CityJSONSeq or
/// GeoJSON) .jsonl (CityJSONSeq) .osm .pbf .gml (CityGML) .xml (Mitsuba scene, with the .ply it names; CityGML;
/// OpenStreetMap) .asc .tif .tiff (height grids), each also compressed (.gz .Z .bz2 .xz .zst), or with what it names in
/// a zip or tar archive; a folder with one Mitsuba scene. Files that a scene or a .gltf names are read from its own
/// folder alone. What doubts_about() says is among the warnings.
///
/// Fails with `outside` when it cannot be opened, with `input` and FILE:LINE or the place when it is damaged, cut or
/// empty.
Result<CityFile> read_city(const std::filesystem::path& path, const CityFileSettings& settings);

/// The same from memory; `name` is for messages. None opens another file.
///
/// Where a format of facets tells no kinds: a facet whose normal's up component is at most half its length is wall;
/// else ground when its object, group or material is named so ("ground", "terrain", "Plane"), and roof otherwise. Roofs
/// within 0.5 m of the lowest corner of all are ground when together they cover a quarter of the city's box and
/// something stands 2 m above them. Materials go by their names ("itu_concrete", "Glass.003").
Result<CityFile> parse_obj(std::string_view text, std::string_view name, const CityFileSettings& settings);
Result<CityFile> parse_ply(std::string_view bytes, std::string_view name, const CityFileSettings& settings);
Result<CityFile> parse_gltf(std::string_view bytes, std::string_view name, const CityFileSettings& settings);
Result<CityFile> parse_geojson(std::string_view text, std::string_view name, const CityFileSettings& settings);
Result<CityFile> parse_cityjson(std::string_view text, std::string_view name, const CityFileSettings& settings);
/// CityJSONSeq: a CityJSON and a CityJSONFeature a line.
Result<CityFile> parse_cityjson_sequence(std::string_view text, std::string_view name,
                                         const CityFileSettings& settings);
Result<CityFile> parse_citygml(std::string_view text, std::string_view name, const CityFileSettings& settings);
/// OpenStreetMap, XML or PBF as `format` says ("osm", "osm.pbf").
Result<CityFile> parse_osm(std::string_view bytes, std::string_view format, std::string_view name,
                           const CityFileSettings& settings);

/// A zip or tar archive, not compressed, with one city and the files that it names. Of several, an .xml is passed over
/// beside a city of another format, and .obj and .ply beside an .xml.
Result<CityFile> parse_city_archive(std::string_view bytes, std::string_view name, const CityFileSettings& settings);

/// A height grid (ESRI ASCII, .asc) as ground. Cells are geographic degrees when they fit on the globe, are at most
/// 0.1° wide and all together 6°, heights then metres above the ellipsoid unless `heights` says another. Metres farther
/// than 100 km from 0, 0 are places of a map, that of `anchor` where there is one; else both are metres from the
/// frame's origin. `metres_per_unit` and `origin` apply; `metres_per_unit` to heights alone where cells are degrees.
Result<CityFile> parse_height_grid(std::string_view text, std::string_view name, const CityFileSettings& settings);

/// A GeoTIFF (OGC 19-008) as ground: the first image of one sample a pixel, whole numbers or floating ones, in strips
/// or tiles. The place is that of its tie point and scale, or of its matrix; the reference system that of its keys or
/// of `file_crs`; GDAL's no-data value is no height. `metres_per_unit` is that of heights.
Result<CityFile> parse_geotiff(std::string_view bytes, std::string_view name, const CityFileSettings& settings);

/// What is doubtful about a city as a whole: a few metres or a hundred kilometres wide, no more than 3 m tall or more
/// than 1500, far from its origin, without walls, walls deep below ground. Empty for most.
std::vector<std::string> doubts_about(const CityModel& city);

}  // namespace skyloop::inline world
