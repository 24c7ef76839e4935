#include "study/plot/coverage_plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "base/time/utc_time.hpp"
#include "detail/colour_ramp.hpp"
#include "detail/plan_view.hpp"
#include "detail/plot_style.hpp"

namespace skyloop {
namespace {

namespace style = plot_style;

constexpr SvgPoint coverage_corner{30, 76};
constexpr SvgPoint coverage_size{760, 740};
constexpr int coverage_levels = 24;
constexpr int most_drawn_cells = 500;  // a side

// How a quantity is called and shown.
struct CoverageScale {
    std::string_view title, unit;
    double low = 0, high = 1;
    bool low_is_good = false;
};

CoverageScale coverage_scale(CoverageQuantity quantity) {
    switch (quantity) {
        case CoverageQuantity::line_of_sight:
            return {"Satellites in line of sight, mean", "", 0, 12};
        case CoverageQuantity::satellites:
            return {"Satellites direct or reflected, mean", "", 0, 12};
        case CoverageQuantity::hdop:
            return {"HDOP, median", "", 0.5, 5, true};
        case CoverageQuantity::fix:
            return {"Time with four satellites or more in line of sight", " %", 0, 100};
        case CoverageQuantity::error:
            return {"Horizontal error by reflections, mean", " m", 0, 50, true};
    }
    return {};
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
        svg.text({.at = {at.x + k * coverage_levels * width / 4, at.y + 18},
                  .text = fmt::format("{}{:.3g}{}", k == 4 && scale.low_is_good ? "≥ " : "",
                                      scale.low + (scale.high - scale.low) * k / 4, scale.unit),
                  .size = 11,
                  .fill = style::faint_ink,
                  .anchor = k == 0 ? "start" : "middle"});
    svg.rectangle({420, at.y - 8}, {14, 14}, 0, {.fill = style::faint_grid, .stroke = style::grid});
    svg.text({.at = {440, at.y}, .text = "no value, or inside a building", .size = 11, .fill = style::faint_ink});
    svg.end_group();
}

std::string coverage_subtitle(const CoverageMap& map) {
    const auto time = [](GpsTime t) {
        std::string text = format_utc(to_utc(t, LeapSeconds::announced()), 0);
        text.replace(text.find('T'), 1, " ").pop_back();
        return text;
    };
    return fmt::format("{} … {} UTC, {} epochs   ·   {} × {} cells of {:.3g} × {:.3g} m", time(map.start),
                       time(map.end), map.epochs, map.grid.columns, map.grid.rows, map.grid.width() / map.grid.columns,
                       map.grid.height() / map.grid.rows);
}

}  // namespace

std::optional<double> coverage_value(const CoverageCell& cell, CoverageQuantity quantity) {
    if (!cell.figures) return std::nullopt;
    switch (quantity) {
        case CoverageQuantity::line_of_sight:
            return cell.figures->line_of_sight;
        case CoverageQuantity::satellites:
            return cell.figures->tracked();
        case CoverageQuantity::hdop:
            return cell.figures->hdop;
        case CoverageQuantity::fix:
            return 100 * cell.figures->line_of_sight_fix_share;
        case CoverageQuantity::error:
            return cell.figures->reflection_error;
    }
    return std::nullopt;
}

std::string coverage_plot_svg(const CoverageMap& map, CoverageQuantity quantity, const UrbanScene* scene) {
    const std::string title(coverage_scale(quantity).title);
    SvgDocument svg(coverage_plot_width, coverage_plot_height, title);
    style::draw_sheet(svg, {coverage_plot_width, coverage_plot_height});
    svg.text({.at = {30, 30}, .text = title, .size = 17, .bold = true});
    svg.text({.at = {30, 54}, .text = coverage_subtitle(map), .size = 12, .fill = style::faint_ink});
    const PlanView view(coverage_area(map), coverage_corner, coverage_size);
    draw_cells(svg, map, quantity, view);
    if (scene) draw_city(svg, *scene, view, false);
    draw_scale_and_north(svg, view);
    draw_value_bar(svg, fitted_scale(map, quantity));
    return svg.str();
}

}  // namespace skyloop
