#include <fmt/format.h>

#include <array>

#include "base/core/spelling.hpp"
#include "detail/scenario_keys.hpp"
#include "world/propagation/fresnel.hpp"

namespace skyloop {
namespace {

void read_scene_files(TableReader& table, SceneEntry& scene, const std::filesystem::path& folder) {
    std::vector<std::string> files;
    table.text_or_texts("buildings", files);
    for (const std::string& file : files) {
        if (file.empty()) table.mistake("buildings", "is an empty text; expected a file, or \"demo\"");
        scene.buildings.push_back(file == demo_scene_name ? std::filesystem::path(file) : folder / file);
    }
    if (table.has("terrain")) {
        std::string file;
        table.text("terrain", file);
        if (file.empty()) table.mistake("terrain", "is an empty text; expected a height grid (.asc)");
        scene.terrain = folder / file;
    }
    table.needs_one_of({"buildings", "terrain"},
                       "has neither buildings nor terrain; expected buildings = \"FILE\" or \"demo\"");
}

void read_surface_material(TableReader& table, std::string& material) {
    std::vector<std::string_view> names;
    for (const SurfaceMaterial& known : surface_materials())
        names.push_back(known.name);
    if (const auto index = table.choice("material", names, material)) material = names[*index];
}

// How coordinates and heights of the files are to be understood.
void read_file_keys(TableReader& table, CityFileSettings& reading) {
    if (const auto place = table.numbers("file_origin", 3, {reading.file_origin.data(), 3}))
        reading.file_origin = Eigen::Map<const Eigen::Vector3d>(place->data());
    if (table.has("axes")) {
        std::string text = "x,y,z";  // stays where the value is no text, which has been told
        table.text("axes", text);
        const auto axes = FileAxes::parse(text);
        if (axes)
            reading.axes = *axes;
        else
            table.mistake("axes", axes.error().message);
    }
    if (table.has("heights")) {
        constexpr std::array<std::string_view, 2> names{"sea_level", "ellipsoid"};
        if (const auto index = table.choice("heights", names, names[0]))
            reading.heights = *index == 0 ? CityHeights::sea_level : CityHeights::ellipsoid;
    }
    table.number("unit_m", reading.metres_per_unit, {1e-6, 1e6});
    read_surface_material(table, reading.material);
    table.number("default_height_m", reading.default_height, {0.1, 1000});
    table.number("metres_per_level", reading.metres_per_level, {0.1, 100});
}

void read_path_keys(TableReader& table, SceneEntry& scene) {
    if (table.has("reflections")) {
        int most = 1;
        table.integer("reflections", most, {1, 16});
        scene.reflections = most;
    }
    table.boolean("roofs_reflect", scene.roofs_reflect);
    if (table.has("ground_reflects")) {
        bool reflects = true;
        table.boolean("ground_reflects", reflects);
        scene.ground_reflects = reflects;
    }
    table.boolean("diffraction", scene.diffraction);
    table.boolean("foliage", scene.foliage);
    table.integer("rays", scene.rays, {0, 1 << 22});
    if (table.has("threads")) {
        int threads = 0;
        table.integer("threads", threads, {0, 64});
        scene.threads = threads;
    }
    table.integer("memory_limit_mb", scene.memory_limit_mb, {0, 1 << 24});
    table.boolean("cache", scene.cache);
}

}  // namespace

void read_scene_keys(TableReader& table, SceneEntry& scene, const std::filesystem::path& folder) {
    read_scene_files(table, scene, folder);
    scene.reading.origin = table.place("origin");
    scene.origin_told_at = table.told_at("origin");
    read_file_keys(table, scene.reading);
    read_path_keys(table, scene);
}

}  // namespace skyloop
