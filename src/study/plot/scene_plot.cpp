#include "study/plot/scene_plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include "detail/axes_and_labels.hpp"
#include "detail/plan_view.hpp"
#include "detail/plot_style.hpp"

namespace skyloop::inline study {
namespace {

namespace style = plot_style;

constexpr SvgPoint scene_corner{30, 76};
constexpr SvgPoint scene_size{760, 740};

std::string scene_summary(const UrbanScene& scene) {
    const SceneStatistics& s = scene.statistics();
    const Eigen::Vector3d size = s.highest - s.lowest;
    return fmt::format("{:.0f} × {:.0f} m, {:.0f} m high   ·   {} triangles, {} planes", size.x(), size.y(), size.z(),
                       s.triangles, s.planes);
}

// One straight piece, cut at the border of the picture; false when it lies outside.
bool draw_piece(SvgDocument& svg, const PlanView& view, std::array<Eigen::Vector2d, 2> ends, const SvgStyle& style) {
    if (!clip_line(ends[0], ends[1], view.area())) return false;
    svg.line(view.at(ends[0]), view.at(ends[1]), style);
    return true;
}

// From the antenna over the points of reflection to the border. @returns where the line ends
std::optional<SvgPoint> draw_ray(SvgDocument& svg, const PlanView& view, const Eigen::Vector3d& antenna,
                                 const ScenePlotRay& ray) {
    const bool blocked = ray.reception == Reception::blocked;
    const SvgStyle line{.stroke = style::reception_colour(ray.reception),
                        .width = blocked ? 1.0 : 1.6,
                        .opacity = blocked ? 0.5 : 0.9,
                        .dash = blocked ? "3 4" : ""};
    Eigen::Vector2d from = antenna.head<2>();
    for (const Eigen::Vector3d& point : ray.points) {
        draw_piece(svg, view, {from, point.head<2>()}, line);
        from = point.head<2>();
        if (view.area().contains(from)) svg.circle(view.at(from), 2.6, {.fill = line.stroke});
    }
    // Long enough to leave the picture, unless the satellite stands in the zenith.
    const double reach = 2 * view.area().sizes().norm();
    Eigen::Vector2d to = from + reach * ray.departure.head<2>();
    if (!clip_line(from, to, view.area())) return std::nullopt;
    svg.line(view.at(from), view.at(to), line);
    return view.at(to);
}

void draw_rays(SvgDocument& svg, const PlanView& view, const ScenePlot& plot) {
    LabelPlacement labels;
    const Eigen::Vector3d& antenna = *plot.observer;
    for (const Reception kind : {Reception::blocked, Reception::line_of_sight, Reception::reflected})
        for (const ScenePlotRay& ray : plot.rays) {
            if (ray.reception != kind) continue;
            const std::string name = to_string(ray.id);
            svg.begin_group("ray", fmt::format("{}: {}", name, style::reception_word(kind)));
            if (const auto end = draw_ray(svg, view, antenna, ray)) {
                constexpr double size = 11;
                const LabelBox box = labels.place(*end, 3, {style::text_width(name, size), size});
                svg.text({.at = box.centre(),
                          .text = name,
                          .size = size,
                          .fill = style::reception_colour(kind),
                          .anchor = "middle",
                          .bold = kind != Reception::blocked,
                          .halo = style::paper});
            }
            svg.end_group();
        }
    if (!view.area().contains(Eigen::Vector2d(antenna.head<2>()))) return;
    svg.circle(view.at(antenna), 6, {.fill = style::accent, .stroke = style::paper, .width = 2});
}

void draw_height_legend(SvgDocument& svg, double highest) {
    constexpr int steps = 16;
    constexpr double width = 9;
    const SvgPoint at{30, 856};
    svg.begin_group("heights");
    for (int k = 0; k < steps; ++k)
        svg.rectangle({at.x + k * width, at.y - 6}, {width + 0.3, 12}, 0,
                      {.fill = style::ramp_colour(style::height_ramp, k / (steps - 1.0))});
    style::note(svg, {at.x + steps * width + 8, at.y}, fmt::format("0 … {:.0f} m above ground", highest), 11.5);
    svg.end_group();
}

void draw_ray_legend(SvgDocument& svg) {
    double x = 400;
    constexpr double y = 856;
    for (const Reception kind : {Reception::line_of_sight, Reception::reflected, Reception::blocked}) {
        const std::string word(style::reception_word(kind));
        svg.line(
            {x, y}, {x + 22, y},
            {.stroke = style::reception_colour(kind), .width = 2, .dash = kind == Reception::blocked ? "3 4" : ""});
        style::note(svg, {x + 28, y}, word, 11.5);
        x += 28 + style::text_width(word, 11.5) + 14;
    }
}

}  // namespace

ScenePlotRay scene_plot_ray(const SceneReception& reception, const SceneSatellite& satellite,
                            const Eigen::Vector3d& antenna) {
    ScenePlotRay ray{satellite.id, reception.reception(), {}, (satellite.position - antenna).normalized()};
    if (ray.reception != Reception::reflected) return ray;
    ray.points = reception.paths.front().points;
    if (!ray.points.empty()) ray.departure = (satellite.position - ray.points.back()).normalized();
    return ray;
}

Eigen::AlignedBox2d scene_plot_area(const Eigen::Vector3d& middle, double radius) {
    const Eigen::Vector2d half(radius, radius);
    return {Eigen::Vector2d(middle.head<2>() - half), Eigen::Vector2d(middle.head<2>() + half)};
}

std::string scene_plot_svg(const UrbanScene& scene, const ScenePlot& plot) {
    const std::string title = plot.title.empty() ? "City from above" : plot.title;
    SvgDocument svg = style::titled_sheet({scene_plot_width, scene_plot_height}, {30, 30}, title,
                                          plot.subtitle.empty() ? scene_summary(scene) : plot.subtitle);
    const PlanView view(plot.area.value_or(ground_box(scene)), scene_corner, scene_size);
    const double highest = draw_city(svg, scene, view);
    if (plot.observer) draw_rays(svg, view, plot);
    draw_scale_and_north(svg, view);
    svg.begin_group("legend");
    draw_height_legend(svg, highest);
    if (!plot.rays.empty()) draw_ray_legend(svg);
    svg.end_group();
    return svg.str();
}

namespace {

namespace style = plot_style;

constexpr SvgPoint coverage_corner{30, 76};
constexpr SvgPoint coverage_size{760, 740};
constexpr int coverage_levels = 24;
constexpr int most_drawn_cells = 500;  // a side

// What a quantity is, how it is called and shown.
struct CoverageScale {
    std::optional<double> (*value)(const CoverageFigures&);
    std::string_view title, unit;
    double low = 0, high = 1;
    bool low_is_good = false;
};

// In the order of CoverageQuantity.
constexpr std::array<CoverageScale, 5> coverage_scales{
    {{[](const auto& f) { return std::optional(f.line_of_sight); }, "Satellites in line of sight, mean", "", 0, 12},
     {[](const auto& f) { return std::optional(f.tracked()); }, "Satellites direct or reflected, mean", "", 0, 12},
     {[](const auto& f) { return f.hdop; }, "HDOP, median", "", 0.5, 5, true},
     {[](const auto& f) { return std::optional(100 * f.line_of_sight_fix_share); },
      "Time with four satellites or more in line of sight", " %", 0, 100},
     {[](const auto& f) { return f.reflection_error; }, "Horizontal error by reflections, mean", " m", 0, 50, true}}};

constexpr const CoverageScale& coverage_scale(CoverageQuantity quantity) {
    return coverage_scales[static_cast<std::size_t>(quantity)];
}

// The ends of counts follow what is there, so that open skies and deep canyons both show their differences.
CoverageScale fitted_scale(const CoverageMap& map, CoverageQuantity quantity) {
    CoverageScale scale = coverage_scale(quantity);
    if (quantity != CoverageQuantity::line_of_sight && quantity != CoverageQuantity::satellites) return scale;
    double highest = 1;
    for (const CoverageCell& cell : map.cells)
        highest = std::max(highest, coverage_value(cell, quantity).value_or(0));
    scale.high = std::ceil(highest);
    return scale;
}

int coverage_level(const std::optional<double>& value, const CoverageScale& scale) {
    if (!value) return -1;
    const double share = std::clamp((*value - scale.low) / (scale.high - scale.low), 0.0, 1.0);
    const int level = std::min(static_cast<int>(share * coverage_levels), coverage_levels - 1);
    return scale.low_is_good ? coverage_levels - 1 - level : level;
}

std::string coverage_colour(int level) {
    return style::ramp_colour(style::value_ramp, static_cast<double>(level) / (coverage_levels - 1));
}

Eigen::AlignedBox2d coverage_area(const CoverageMap& map) {
    const Eigen::Vector2d half(map.grid.width() / map.grid.columns / 2, map.grid.height() / map.grid.rows / 2);
    Eigen::AlignedBox2d box;
    for (const CoverageCell& cell : map.cells) {
        box.extend(Eigen::Vector2d(cell.position.head<2>() - half));
        box.extend(Eigen::Vector2d(cell.position.head<2>() + half));
    }
    return box;
}

// Which cells are drawn, and how large.
struct CoverageRaster {
    int stride = 1;
    double width = 0, height = 0;             // of a drawn cell, pixels
    std::function<int(int, int)> level_at{};  // colour of a column and row; below 0: none
};

// Runs of one colour in a row of cells, added to that colour's path.
void add_row(std::array<SvgPath, coverage_levels>& paths, const CoverageMap& map, int row, const CoverageRaster& raster,
             const PlanView& view) {
    for (int begin = 0, end = 0; begin < map.grid.columns; begin = end) {
        const int level = raster.level_at(begin, row);
        int last = begin;
        for (end = begin; end < map.grid.columns && raster.level_at(end, row) == level; end += raster.stride)
            last = end;
        if (level < 0) continue;
        SvgPoint from = view.at(map.at(begin, row).position), to = view.at(map.at(last, row).position);
        from.x -= raster.width / 2;
        to.x += raster.width / 2;
        paths[static_cast<std::size_t>(level)].move_to(from).line_to(to);
    }
}

void draw_cells(SvgDocument& svg, const CoverageMap& map, CoverageQuantity quantity, const PlanView& view) {
    const CoverageScale scale = fitted_scale(map, quantity);
    CoverageRaster raster;
    raster.stride = (std::max(map.grid.columns, map.grid.rows) + most_drawn_cells - 1) / most_drawn_cells;
    raster.width = map.grid.width() / map.grid.columns * view.pixels_per_metre() * raster.stride;
    raster.height = map.grid.height() / map.grid.rows * view.pixels_per_metre() * raster.stride;
    raster.level_at = [&](int column, int row) {
        return coverage_level(coverage_value(map.at(column, row), quantity), scale);
    };
    std::array<SvgPath, coverage_levels> paths;
    for (int row = 0; row < map.grid.rows; row += raster.stride)
        add_row(paths, map, row, raster, view);
    svg.begin_group("cells");
    svg.rectangle(view.corner(), view.size(), 0, {.fill = style::faint_grid});
    for (int level = 0; level < coverage_levels; ++level)
        if (const SvgPath& path = paths[static_cast<std::size_t>(level)]; !path.empty())
            svg.runs(path, coverage_colour(level), raster.height + 0.3);
    svg.end_group();
}

void draw_value_bar(SvgDocument& svg, const CoverageScale& scale) {
    constexpr double width = 14;
    const SvgPoint at{30, 850};
    svg.begin_group("scale_of_values");
    for (int k = 0; k < coverage_levels; ++k)
        svg.rectangle({at.x + k * width, at.y - 8}, {width + 0.3, 14}, 0,
                      {.fill = coverage_colour(scale.low_is_good ? coverage_levels - 1 - k : k)});
    for (int k = 0; k <= 4; ++k)
        style::note(svg, {at.x + k * coverage_levels * width / 4, at.y + 18},
                    fmt::format("{}{:.3g}{}", k == 4 && scale.low_is_good ? "≥ " : "",
                                scale.low + (scale.high - scale.low) * k / 4, scale.unit),
                    11, k == 0 ? "start" : "middle");
    svg.rectangle({420, at.y - 8}, {14, 14}, 0, {.fill = style::faint_grid, .stroke = style::grid});
    style::note(svg, {440, at.y}, "no value, or inside a building");
    svg.end_group();
}

std::string coverage_subtitle(const CoverageMap& map) {
    return fmt::format("{} … {} UTC, {} epochs   ·   {} × {} cells of {:.3g} × {:.3g} m", style::utc_words(map.start),
                       style::utc_words(map.end), map.epochs, map.grid.columns, map.grid.rows,
                       map.grid.width() / map.grid.columns, map.grid.height() / map.grid.rows);
}

}  // namespace

std::optional<double> coverage_value(const CoverageCell& cell, CoverageQuantity quantity) {
    return cell.figures ? coverage_scale(quantity).value(*cell.figures) : std::nullopt;
}

std::string coverage_plot_svg(const CoverageMap& map, CoverageQuantity quantity, const UrbanScene* scene) {
    const std::string title(coverage_scale(quantity).title);
    SvgDocument svg =
        style::titled_sheet({coverage_plot_width, coverage_plot_height}, {30, 30}, title, coverage_subtitle(map));
    const PlanView view(coverage_area(map), coverage_corner, coverage_size);
    draw_cells(svg, map, quantity, view);
    if (scene) draw_city(svg, *scene, view, false);
    draw_scale_and_north(svg, view);
    draw_value_bar(svg, fitted_scale(map, quantity));
    return svg.str();
}

}  // namespace skyloop::inline study
