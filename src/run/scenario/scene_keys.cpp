#include <fmt/format.h>

#include "base/core/spelling.hpp"
#include "detail/scenario_keys.hpp"
#include "world/propagation/fresnel.hpp"

namespace skyloop {
namespace {

void read_scene_files(TableReader& table, SceneEntry& scene, const std::filesystem::path& folder) {
    std::vector<std::string> files;
    table.text_or_texts("buildings", files,
                        {"city models (.obj .ply .gltf .glb .geojson .json .osm .pbf .gml .xml), or \"demo\"", "none"});
    for (const std::string& file : files) {
        if (file.empty()) table.mistake("buildings", "is an empty text; expected a file, or \"demo\"");
        scene.buildings.push_back(file == demo_scene_name ? std::filesystem::path(file) : folder / file);
    }
    if (table.has("terrain")) {
        std::string file;
        table.text("terrain", file, {"height grid (.asc .tif) that becomes ground", "none"});
        if (file.empty()) table.mistake("terrain", "is an empty text; expected a height grid (.asc, .tif)");
        scene.terrain = folder / file;
    }
    table.needs_one_of({"buildings", "terrain"},
                       "has neither buildings nor terrain; expected buildings = \"FILE\" or \"demo\"");
}

void read_surface_material(TableReader& table, std::string& material) {
    std::vector<std::string_view> names;
    for (const SurfaceMaterial& known : surface_materials())
        names.push_back(known.name);
    if (const auto index = table.choice("material", names, "of surfaces that have none in the file", material))
        material = names[*index];
}

// How coordinates and heights of the files are to be understood.
void read_file_keys(TableReader& table, CityFileSettings& reading) {
    if (const auto place = table.numbers(
            "file_origin", 3,
            "x, y, z of a mesh that lie at the origin, in units and axes of the file; for coordinates of a map",
            {reading.file_origin.data(), 3}))
        reading.file_origin = Eigen::Map<const Eigen::Vector3d>(place->data());
    if (table.has("axes")) {
        std::string text = "x,y,z";  // stays where the value is no text, which has been told
        table.text(
            "axes", text,
            {"the file's axes that point east, north and up: \"x,y,z\", \"x,-z,y\", \"y,x,z\"", "as the format says"});
        const auto axes = FileAxes::parse(text);
        if (axes)
            reading.axes = *axes;
        else
            table.mistake("axes", axes.error().message);
    }
    if (table.has("file_crs")) {
        std::string name = "local";  // stays where the value is no text
        table.text("file_crs", name,
                   {"reference system of the files where they name none or a wrong one: \"EPSG:25832\", \"EPSG:7415\"; "
                    "\"local\": metres of no map",
                    "as the files say"});
        if (const auto known = check_file_crs(name); known)
            reading.file_crs = name;
        else
            table.mistake("file_crs", known.error().message);
    }
    table.word("heights", {{"sea_level", CityHeights::sea_level}, {"ellipsoid", CityHeights::ellipsoid}},
               reading.heights,
               {"what the heights of files on the Earth count from", "as the file's system says, else the ellipsoid"});
    table.number("unit_m", reading.metres_per_unit, {1e-6, 1e6},
                 "length of one unit of the file; 0.01 for centimetres");
    read_surface_material(table, reading.material);
    table.number("default_height_m", reading.default_height, {0.1, 1000}, "of outlines without height or levels");
    table.number("metres_per_level", reading.metres_per_level, {0.1, 100}, "m, of outlines with levels");
}

void read_path_keys(TableReader& table, SceneEntry& scene) {
    table.integer("reflections", scene.reflections, {1, 16}, {"most of one path", "16; modern 3"});
    table.boolean("roofs_reflect", scene.roofs_reflect, "roofs besides walls");
    table.boolean("ground_reflects", scene.ground_reflects, {"ground besides walls", "modern alone"});
    table.boolean("diffraction", scene.diffraction, "modern: rays around edges");
    table.boolean("foliage", scene.foliage, "modern: the trees of the model weaken what passes them");
    table.integer("rays", scene.rays, {0, 1 << 22}, "of a search over the whole hemisphere; 0: by the epoch rate");
    table.integer(
        "threads", scene.threads, {0, 64},
        {"of each receiver, that search beside the loop; the bytes do not depend on it", "1; led by a program 0"});
    table.integer("memory_limit_mb", scene.memory_limit_mb, {0, 1 << 24},
                  "a scene that would take more is refused, and so is a file of it that unpacks to more; 0: no limit");
    table.boolean("cache", scene.cache, "keep models that take time to read for the next run");
}

}  // namespace

void read_scene_keys(TableReader& table, SceneEntry& scene, const std::filesystem::path& folder) {
    read_scene_files(table, scene, folder);
    scene.reading.origin = table.place(
        "origin", {"of the files' frame: latitude, longitude, height", "1.5 m below the start, where that is known"});
    scene.origin_told_at = table.told_at("origin");
    read_file_keys(table, scene.reading);
    read_path_keys(table, scene);
}

}  // namespace skyloop
