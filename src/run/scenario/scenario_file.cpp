#include "run/scenario/scenario_file.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "base/core/files.hpp"
#include "base/core/words.hpp"
#include "base/time/utc_time.hpp"
#include "detail/scenario_keys.hpp"
#include "world/propagation/reflection.hpp"

namespace skyloop::inline run {
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
    table.number("scattering", scene.scattering, {0, 1},
                 "modern: amplitude that rough walls scatter of what falls on them; 0: none");
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

namespace {

void read_run_keys(TableReader& run, RunSettings& settings) {
    const auto start = run.utc("start", {"when the run begins: ISO 8601 in UTC, or \"now\"",
                                         "now; with navigation files when their satellites first suffice for a fix"});
    if (start == "now") {
        settings.start_now = true;
    } else if (start) {
        const auto utc = parse_instant(*start);
        if (utc)
            settings.start = to_gps_time(*utc, LeapSeconds::announced());
        else
            run.mistake("start", utc.error().message + ", or \"now\"");
    }
    run.quantity("duration_s", settings.duration, {std::numeric_limits<double>::min(), longest_run_s},
                 {"length of the run", "until stopped"});
    run.integer("seed", settings.seed, NumberRange::not_negative(),
                "the same scenario, seed and inputs give the same bytes");
    run.integer("sky_seed", settings.sky_seed, NumberRange::not_negative(),
                {"of orbits, clocks, air and surroundings: the same for runs under one sky", "seed"});
    run.integer("receiver_seed", settings.receiver_seed, NumberRange::not_negative(),
                {"of the receivers' clocks, noise and multipath", "seed"});
    run.number("speed", settings.speed, {1e-3, 1e6}, "`skyloop run` only: simulated seconds per second");
}

void read_files(TableReader& sky, std::string_view key, std::vector<std::filesystem::path>& paths,
                const std::filesystem::path& folder, KeyText text) {
    std::vector<std::string> files;
    sky.text_or_texts(key, files, text);
    for (const std::string& file : files) {
        if (file.empty()) sky.mistake(key, "is empty; expected the path of a file");
        paths.push_back(folder / file);
    }
}

void read_precise_files(TableReader& sky, PreciseFiles& files, const std::filesystem::path& folder) {
    read_files(sky, "orbits", files.orbits, folder,
               {"SP3 files, packed too: where the satellites of `navigation` really are, and what their clocks show",
                "the records are the truth"});
    read_files(sky, "clocks", files.clocks, folder,
               {"RINEX clock files, packed too: the clocks of `orbits`", "those of the SP3 files"});
    read_files(sky, "biases", files.biases, folder,
               {"SINEX BIAS files (.BIA, .BSX), packed too: by how much each code of a satellite is late",
                "the group delays of the records"});
    sky.file_path("antennas", folder, files.antennas,
                  {"ANTEX file, packed too: where satellites and `antenna_type` of receivers have their phase centres",
                   "signals leave from the centre of mass"});
    if (!files.orbits.empty()) return;
    for (const char* key : {"clocks", "biases", "antennas"})
        if (sky.has(key)) sky.mistake(key, "comes beside the orbits that it belongs to; expected sky.orbits, too");
}

void read_osnma(TableReader& sky, SkySettings& settings) {
    sky.boolean("osnma", settings.osnma,
                "Galileo's E1-B pages are authenticated by OSNMA with test keys, which the recording's folder tells");
    OsnmaEvents& events = settings.osnma_events;
    constexpr NumberRange times{0, longest_run_s};
    sky.where(settings.osnma, "with osnma = true", [&] {
        sky.quantity(
            "osnma_new_key_s", events.new_key, times,
            {"when the second public key signs, after the start; announced a quarter of an hour before", "never"});
        sky.quantity(
            "osnma_new_chain_s", events.new_chain, times,
            {"when the second chain goes on; announced as the end of the first a quarter of an hour before", "never"});
        sky.quantity("osnma_revoked_chain_s", events.revoked_chain, times,
                     {"when the chain is revoked; the second serves a quarter of an hour later", "never"});
        sky.quantity(
            "osnma_revoked_key_s", events.revoked_key, times,
            {"when public key and chain are revoked; the second ones serve a quarter of an hour later", "never"});
        sky.quantity("osnma_alert_s", events.alert, times,
                     {"from when on the alert message is all that is sent", "never"});
    });
    if (sky.recording()) return;
    std::string_view first;
    for (const std::string_view key :
         {"osnma_new_key_s", "osnma_new_chain_s", "osnma_revoked_chain_s", "osnma_revoked_key_s", "osnma_alert_s"}) {
        if (!sky.has(key)) continue;
        if (!first.empty())
            sky.mistake(key, fmt::format("is there beside {}; expected one change of OSNMA's keys", first));
        first = key;
    }
}

void read_sky_keys(TableReader& sky, SkySettings& settings, const std::filesystem::path& folder) {
    read_files(
        sky, "navigation", settings.navigation, folder,
        {"navigation files: RINEX 2, 3 or 4, YUMA or SEM almanac, packed too; \"auto\": the file of the start's day "
         "that `skyloop fetch-nav` has put into the cache, else the nominal sky",
         "nominal sky"});
    const auto named_auto =
        std::find(settings.navigation.begin(), settings.navigation.end(), folder / automatic_navigation_word);
    settings.automatic_navigation = named_auto != settings.navigation.end();
    if (settings.automatic_navigation && settings.navigation.size() > 1)
        sky.mistake("navigation", "has files beside \"auto\"; expected either");
    if (settings.automatic_navigation) settings.navigation.clear();
    read_precise_files(sky, settings.precise, folder);
    sky.boolean("rebase_navigation", settings.rebase_navigation,
                "move the data by whole days to the start time, keeping its time of day");
    read_constellation_list(sky, "constellations", settings.constellations,
                            {"which systems of the data send", "all; gps and qzss for sensor models"});
    sky.degrees("elevation_mask_deg", settings.elevation_mask, {0, 90},
                {"elevation mask: a satellite exactly at it is used", "the board's; 5 for sensor models"});
    sky.word("ephemeris_rule", {{"forward", EphemerisRule::forward}, {"nearest", EphemerisRule::nearest}},
             settings.ephemeris_rule,
             {"the newest healthy record that is not of the future, or the nearest one", "by the model"});
    sky.quantity("ephemeris_validity_s", settings.ephemeris_validity, {1, 14 * 86400.0},
                 {"largest age of any record", "by the system"});
    read_osnma(sky, settings);
}

// What a run may be refused for when it is put together.
void remember_places(TableReader& table, std::string_view name, ToldPlaces& told_at) {
    for (const std::string& key : table.keys())
        told_at[fmt::format("{}.{}", name, key)] = table.told_at(key);
}

bool is_live(const TrajectorySettings& trajectory) { return std::holds_alternative<LiveSettings>(trajectory); }

// A source gives places on the Earth, or metres of a map of its own.
void refuse_idle_frame(TableReader& top) {
    if (top.has("frame"))
        top.mistake("frame",
                    "has no effect on a live trajectory; expected no [frame], and trajectory.origin where the "
                    "source gives local metres");
}

bool is_all_live(const Scenario& scenario) {
    const auto& receivers = scenario.receivers;
    return std::all_of(receivers.begin(), receivers.end(), [&](const ReceiverEntry& receiver) {
        return is_live(receiver.trajectory.value_or(scenario.trajectory));
    });
}

}  // namespace

std::string told_place(const Scenario& scenario, std::string_view key, std::string_view otherwise) {
    const auto place = scenario.told_at.find(key);
    return place != scenario.told_at.end() ? place->second : fmt::format("{}: ", otherwise);
}

void read_top_keys(TableReader& top, Scenario& scenario, const std::filesystem::path& folder) {
    top.table("run", "when, how long, how fast", [&](TableReader& t) {
        read_run_keys(t, scenario.run);
        remember_places(t, "run", scenario.told_at);
    });
    top.table("sky", "which satellites there are", [&](TableReader& t) {
        read_sky_keys(t, scenario.sky, folder);
        remember_places(t, "sky", scenario.told_at);
    });
    const TrajectoryContext context{read_frame(top), folder};
    if (auto path = read_trajectory_keys(top, {"where the vehicle is", "fixed, in Odessa"}, context, scenario.warnings))
        scenario.trajectory = std::move(*path);
    top.table("model", "how a fix is made", [&](TableReader& t) { read_model_keys(t, scenario.model, folder); });
    read_surroundings(top, scenario, folder);
    top.table("atmosphere", "clouds and rain; and the air of the sensor models", [&](TableReader& t) {
        read_atmosphere_keys(t, scenario, folder);
        scenario.atmosphere_keys = t.keys();
        remember_places(t, "atmosphere", scenario.told_at);
    });
    top.table("scene", "buildings and ground around the antenna", [&](TableReader& t) {
        read_scene_keys(t, scenario.scene, folder);
        remember_places(t, "scene", scenario.told_at);
    });
    read_receivers(top, scenario, context);
    if (is_all_live(scenario)) refuse_idle_frame(top);
    read_outputs(top, scenario);
    read_caster(top, scenario);
    read_timeline(top, scenario);
    read_expectations(top, scenario);
    read_campaign(top, scenario.campaign);
}

void read_constellation_list(TableReader& table, const char* key, std::vector<Constellation>& constellations,
                             KeyText text) {
    const auto found = table.choices(key, constellation_names, text);
    if (!found) return;
    constellations.clear();
    for (const std::size_t index : *found)
        constellations.push_back(static_cast<Constellation>(index));
}

Result<Scenario> read_scenario_file(const std::filesystem::path& file) {
    ScenarioReading reading = read_file_with_mistakes(file, {});
    if (reading.mistakes) return fail(*reading.mistakes);
    return std::move(reading.scenario);
}

Result<TrajectorySettings> read_trajectory_file(const std::filesystem::path& file, std::vector<std::string>& warnings,
                                                std::span<const ScenarioChange> changes) {
    const auto text = read_text_file(file);
    if (!text) return fail(text.error());
    std::optional<TrajectorySettings> trajectory;
    const auto read_keys = [&](TableReader& top) {
        if (!top.has("trajectory")) top.mistake_here("no [trajectory] table in this file");
        trajectory = read_trajectory_keys(top, {}, {read_frame(top), file.parent_path()}, warnings);
        if (trajectory && is_live(*trajectory)) refuse_idle_frame(top);
    };
    const auto change = [&](toml::table& table, MistakeList& mistakes) { apply_changes(table, mistakes, changes); };
    const auto read = read_toml(*text, file.string(), read_keys, change);
    if (!read) return fail(read.error());
    return trajectory.value_or(FixedSettings{});
}

}  // namespace skyloop::inline run
