#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <set>
#include <utility>

#include "base/core/files.hpp"
#include "base/core/json.hpp"
#include "commands.hpp"
#include "data_folders.hpp"
#include "file_streams.hpp"
#include "messages.hpp"
#include "run/emulator/assembly.hpp"
#include "run/emulator/load_scene.hpp"
#include "run_options.hpp"
#include "study/analysis/scene_sky.hpp"
#include "study/plot/scene_plot.hpp"
#include "study/plot/sky_plot.hpp"

namespace skyloop::host {
namespace {

struct SceneOptions {
    std::string file, at, origin, file_origin, file_crs, axes, svg, sky_svg;
    double unit_m = 1;
    bool json = false;
    Verbosity verbosity;
};

/// A place in the scene and what surrounds it.
struct SceneViewpoint {
    Geodetic place;
    Eigen::Vector3d antenna;  ///< in the scene's frame, m
    std::optional<double> ground;
    bool enclosed = false;
    SkyMask mask;
};

/// All that the command has to tell.
struct SceneReport {
    JoinedCity city;
    std::shared_ptr<const UrbanScene> scene;
    std::optional<SceneViewpoint> viewpoint;
};

// X,Y,Z of the file.
Result<Eigen::Vector3d> parse_file_origin(const std::string& text) {
    Eigen::Vector3d place;
    const char* at = text.data();
    const char* const end = at + text.size();
    for (Eigen::Index i = 0; i < 3; ++i) {
        const auto [rest, error] = std::from_chars(at, end, place[i]);
        const bool ends = i == 2 ? rest == end : rest != end && *rest == ',';
        if (error != std::errc() || !std::isfinite(place[i]) || !ends)
            return fail(ErrorCode::usage,
                        fmt::format("--file-origin {}: expected X,Y,Z of the file, such as 392118,5820064,35", text));
        if (i < 2) at = rest + 1;
    }
    return place;
}

Result<SceneEntry> scene_entry(const SceneOptions& options) {
    SceneEntry entry;
    entry.buildings = {options.file};
    if (!(options.unit_m >= 1e-6 && options.unit_m <= 1e6))
        return fail(ErrorCode::usage,
                    fmt::format("--unit-m {}: expected metres from 0.000001 to 1000000", options.unit_m));
    entry.reading.metres_per_unit = options.unit_m;
    if (!options.origin.empty()) {
        const auto origin = parse_place(options.origin, "--origin");
        if (!origin) return fail(origin.error());
        entry.reading.origin = *origin;
    }
    if (!options.file_origin.empty()) {
        const auto place = parse_file_origin(options.file_origin);
        if (!place) return fail(place.error());
        entry.reading.file_origin = *place;
    }
    if (!options.file_crs.empty()) {
        if (const auto known = check_file_crs(options.file_crs); !known)
            return fail(known.error().code, fmt::format("--file-crs: {}", known.error().message));
        entry.reading.file_crs = options.file_crs;
    }
    if (!options.axes.empty()) {
        const auto axes = FileAxes::parse(options.axes);
        if (!axes) return fail(ErrorCode::usage, fmt::format("--axes {}: {}", options.axes, axes.error().message));
        entry.reading.axes = *axes;
    }
    if (!options.sky_svg.empty() && options.at.empty())
        return fail(ErrorCode::usage, "--sky-svg needs a place: expected --at LAT,LON[,HEIGHT]");
    return entry;
}

// A place without a height is that of an antenna above the ground there.
SceneViewpoint viewpoint_at(Geodetic place, bool has_height, const UrbanScene& scene) {
    SceneViewpoint view;
    view.antenna = scene.frame().to_enu(to_ecef(place)).vector();
    view.ground = scene.ground_at(view.antenna.x(), view.antenna.y());
    if (!has_height) {
        view.antenna.z() = scene.foot_at(view.antenna.x(), view.antenna.y()) + antenna_above_scene.value();
        place = to_geodetic(scene.frame().to_ecef(Position<Enu>(view.antenna.x(), view.antenna.y(), view.antenna.z())));
    }
    view.place = place;
    const Eigen::Vector3d free_place = scene.above_surface(view.antenna);
    view.enclosed = sees_no_sky(scene, free_place);
    view.mask = sky_mask(scene, free_place);
    return view;
}

// Without --origin a model lies where it says. One that says nothing is taken to --at, the demo always; what tells no
// height of its ground stays at height 0.
void place_guessed(JoinedCity& city, const Geodetic& at, bool has_height) {
    const std::string &format = city.formats.front(), &name = city.names.front();
    const Geodetic& origin = city.model.origin;
    if (lies_nowhere(city)) {
        city.model.origin = below_antenna(at);
        if (format != demo_scene_name)
            city.warnings.push_back(
                fmt::format("{} does not say where it lies; its origin is taken to be {} m below --at; "
                            "--origin tells another",
                            name, antenna_above_scene.value()));
    } else if (has_height && !city.model.grounded.empty()) {
        city.warnings.push_back(
            fmt::format("{} does not say how high its ground lies; it is taken to be at height {:g}; "
                        "--origin LAT,LON,HEIGHT tells another",
                        name, origin.height.above_ellipsoid.value()));
    }
}

Result<SceneReport> report_of(const SceneOptions& options) {
    const auto entry = scene_entry(options);
    if (!entry) return fail(entry.error());
    std::optional<Geodetic> at;
    if (!options.at.empty()) {
        const auto place = parse_place(options.at);
        if (!place) return fail(place.error());
        at = *place;
    }
    const bool has_height = std::ranges::count(options.at, ',') > 1;
    std::vector<std::string> unknown_geoid;  // is told by the files where it matters
    const auto geoid = find_geoid(data_folders(), unknown_geoid);
    auto city = read_scene_files(*entry, std::nullopt, CityCache{data_folders().cache}, geoid.get());
    if (!city) return fail(city.error());
    if (at && !entry->reading.origin) place_guessed(*city, *at, has_height);
    const SceneSettings settings{SceneSettings().merge_tolerance, entry->memory_limit_mb << 20};
    auto scene = UrbanScene::build(city->model, settings);
    if (!scene) return fail(scene.error().code, fmt::format("{}: {}", options.file, scene.error().message));
    SceneReport report{std::move(*city), std::move(*scene), std::nullopt};
    if (at) report.viewpoint = viewpoint_at(*at, has_height, *report.scene);
    return report;
}

// Those that triangles are made of, in the order of the model.
std::vector<std::string> used_materials(const CityModel& model) {
    std::set<std::size_t> used;
    for (const CityTriangle& triangle : model.triangles)
        used.insert(triangle.material);
    std::vector<std::string> names;
    for (const std::size_t index : used)
        names.push_back(model.materials.at(index));
    return names;
}

std::string place_text(const Geodetic& place) {
    return fmt::format("{:.7f}, {:.7f}, {:.2f}", place.latitude.deg(), place.longitude.deg(),
                       place.height.above_ellipsoid.value());
}

void print_viewpoint(const SceneViewpoint& view) {
    fmt::print("at          {}: east {:.1f}, north {:.1f}, up {:.1f} m\n", place_text(view.place), view.antenna.x(),
               view.antenna.y(), view.antenna.z());
    if (view.ground) fmt::print("            {:.1f} m above the ground\n", view.antenna.z() - *view.ground);
    if (view.enclosed)
        fmt::print("            inside a building or below the ground: nothing arrives there\n");
    else
        fmt::print("            {:.0f} % of the sky is open\n", 100 * view.mask.open_share());
}

void print_report(const SceneReport& report) {
    const SceneStatistics& s = report.scene->statistics();
    fmt::print("format      {}{}\n", fmt::join(report.city.formats, ", "),
               report.city.from_cache ? ", from the cache" : "");
    fmt::print("origin      {}\n", place_text(report.scene->frame().origin()));
    fmt::print("triangles   {}: wall {}, roof {}, ground {}\n", s.triangles, s.triangles_of_kind[0],
               s.triangles_of_kind[1], s.triangles_of_kind[2]);
    fmt::print("planes      {}\n", s.planes);
    fmt::print("extent      east {:.1f} to {:.1f}, north {:.1f} to {:.1f}, up {:.1f} to {:.1f} m\n", s.lowest.x(),
               s.highest.x(), s.lowest.y(), s.highest.y(), s.lowest.z(), s.highest.z());
    if (report.city.buildings > 0) fmt::print("buildings   {}\n", report.city.buildings);
    fmt::print("materials   {}\n", fmt::join(used_materials(report.city.model), ", "));
    if (!report.scene->foliage().empty()) fmt::print("trees       {} volumes\n", report.scene->foliage().size());
    fmt::print("memory      {:.1f} MB\n", static_cast<double>(s.memory) * 1e-6);
    fmt::print("left out    {} that could not be used, {} without area, {} with a corner that is no number\n",
               report.city.dropped, s.degenerate, s.not_finite);
    if (report.viewpoint) print_viewpoint(*report.viewpoint);
}

Json place_json(const Geodetic& place) {
    return {place.latitude.deg(), place.longitude.deg(), place.height.above_ellipsoid.value()};
}

Json viewpoint_json(const SceneViewpoint& view) {
    Json at{{"place", place_json(view.place)},
            {"east_m", view.antenna.x()},
            {"north_m", view.antenna.y()},
            {"up_m", view.antenna.z()}};
    at["above_ground_m"] = view.ground ? Json(view.antenna.z() - *view.ground) : Json(nullptr);
    at["enclosed"] = view.enclosed;
    at["open_sky"] = view.mask.open_share();
    return at;
}

void print_json(const SceneReport& report) {
    const SceneStatistics& s = report.scene->statistics();
    Json out{
        {"files", report.city.names},
        {"formats", report.city.formats},
        {"origin", place_json(report.scene->frame().origin())},
        {"triangles", s.triangles},
        {"wall_triangles", s.triangles_of_kind[0]},
        {"roof_triangles", s.triangles_of_kind[1]},
        {"ground_triangles", s.triangles_of_kind[2]},
        {"planes", s.planes},
        {"lowest_m", {s.lowest.x(), s.lowest.y(), s.lowest.z()}},
        {"highest_m", {s.highest.x(), s.highest.y(), s.highest.z()}},
        {"buildings", report.city.buildings},
        {"materials", used_materials(report.city.model)},
        {"foliage_volumes", report.scene->foliage().size()},
        {"memory_bytes", s.memory},
        {"dropped", report.city.dropped},
        {"without_area", s.degenerate},
        {"not_finite", s.not_finite},
        {"warnings", report.city.warnings},
    };
    if (report.viewpoint) out["at"] = viewpoint_json(*report.viewpoint);
    fmt::print("{}\n", json_text(out, 2));
}

Result<void> write_pictures(const SceneOptions& options, const SceneReport& report) {
    if (!options.svg.empty()) {
        ScenePlot plot;
        plot.title = fmt::format("{}", fmt::join(report.city.names, " + "));
        if (report.viewpoint) plot.observer = report.viewpoint->antenna;
        if (const auto written = write_whole_file(options.svg, scene_plot_svg(*report.scene, plot)); !written)
            return written;
    }
    if (options.sky_svg.empty()) return {};
    SkyPlot plot;
    plot.place = report.viewpoint->place;
    plot.title = report.city.names.front();
    plot.obstruction = report.viewpoint->mask;
    return write_whole_file(options.sky_svg, sky_plot_svg(plot));
}

Result<void> check_pictures(const SceneOptions& options) {
    for (const auto& [option, file] : {std::pair{"--svg", &options.svg}, {"--sky-svg", &options.sky_svg}})
        if (const auto spared = check_spares(option, *file, {options.file}); !spared) return spared;
    const auto place = [](const std::string& file) { return std::filesystem::absolute(file).lexically_normal(); };
    if (!options.svg.empty() && !options.sky_svg.empty() && place(options.svg) == place(options.sky_svg))
        return fail(ErrorCode::usage,
                    fmt::format("--sky-svg {}: is where --svg goes; expected another file", options.sky_svg));
    return {};
}

int show_scene(const SceneOptions& options) {
    const Messages messages(options.verbosity);
    if (const auto fine = check_pictures(options); !fine) return messages.error(fine.error());
    const auto report = report_of(options);
    if (!report) return messages.error(report.error());
    messages.warnings(report->city.warnings);
    if (const auto written = write_pictures(options, *report); !written) return messages.error(written.error());
    if (options.json)
        print_json(*report);
    else
        print_report(*report);
    return 0;
}

}  // namespace

Action add_scene_command(CLI::App& app) {
    CLI::App* command = app.add_subcommand("scene", "What a city model holds; top view and sky visibility as SVG");
    auto options = std::make_shared<SceneOptions>();
    command->add_option("FILE", options->file, "City model, or demo")->required();
    command->add_option("--at", options->at,
                        "A place in it: LAT,LON[,HEIGHT]; without a height 1.5 m above the ground");
    command->add_option("--origin", options->origin, "Where the origin of its coordinates lies: LAT,LON[,HEIGHT]");
    command->add_option("--file-origin", options->file_origin,
                        "Which place of a mesh lies at the origin, in units and axes of the file: X,Y,Z");
    command->add_option("--file-crs", options->file_crs,
                        "Reference system of its coordinates, in place of what it names: EPSG:25832; local: none");
    command->add_option("--axes", options->axes, "Axes of the file for east, north and up: x,y,z; Unreal: y,x,z");
    command->add_option("--unit-m", options->unit_m, "Metres of one unit of the file, default 1");
    command->add_option("--svg", options->svg, "File for a top view");
    command->add_option("--sky-svg", options->sky_svg, "File for the sky as seen from --at");
    command->add_flag("--json", options->json, "JSON instead of text");
    add_verbosity_options(*command, options->verbosity);
    return [options] { return show_scene(*options); };
}

}  // namespace skyloop::host
