#include "study/plot/rate_plots.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "detail/axes_and_labels.hpp"
#include "detail/plot_style.hpp"

namespace skyloop::inline study {
namespace {

namespace style = plot_style;

constexpr double row_height = 23;
constexpr double row_text_size = 11.5;
constexpr double first_row_top = 20;
constexpr double below_rows = 52;

// The parts of a picture with rows: labels left, panel, a note right.
struct RowLayout {
    PanelArea panel;
    double width = 0, height = 0;
    [[nodiscard]] double y(std::size_t row) const { return panel.top + row_height * (static_cast<double>(row) + 0.5); }
};

template <class Row>
RowLayout row_layout(std::span<const Row> rows, double width, double right_margin) {
    double widest = 40;
    for (const Row& row : rows)
        widest = std::max(widest, style::text_width(row.label, row_text_size));
    RowLayout layout;
    layout.panel.left = std::min(widest, 0.36 * width) + 30;
    layout.panel.top = first_row_top;
    layout.panel.width = width - layout.panel.left - right_margin;
    layout.panel.height = row_height * static_cast<double>(rows.size());
    layout.width = width;
    layout.height = layout.panel.bottom() + below_rows;
    return layout;
}

void draw_row_label(SvgDocument& svg, const RowLayout& layout, const std::string& label, double y) {
    svg.text({.at = {layout.panel.left - 10, y},
              .text = fitting_text(label, layout.panel.left - 24, row_text_size),
              .size = row_text_size,
              .anchor = "end"});
}

void draw_row_note(SvgDocument& svg, const RowLayout& layout, const std::string& note, double y) {
    style::note(svg, {layout.panel.right() + 10, y}, note);
}

SvgDocument row_picture(const RowLayout& layout, const AxisScale& axis, const std::string& axis_name,
                        const std::string& title) {
    SvgDocument svg = style::blank_sheet({layout.width, layout.height}, title);
    svg.rectangle({layout.panel.left, layout.panel.top}, {layout.panel.width, layout.panel.height}, 0,
                  {.fill = style::panel});
    draw_bottom_axis(svg, layout.panel, axis, axis_name);
    return svg;
}

AxisScale percent_axis(std::span<const RateRow> rows) {
    double lowest = 1;
    for (const RateRow& row : rows)
        if (row.trials > 0) lowest = std::min(lowest, row.low);
    constexpr std::array<double, 4> begins{98, 90, 80, 50};
    for (const double begin : begins)
        if (100 * lowest >= begin) return axis_over(begin, 100, 5);
    return axis_over(0, 100, 5);
}

}  // namespace

SvgDocument rate_rows_plot(std::span<const RateRow> rows, const std::string& title, double width) {
    const RowLayout layout = row_layout(rows, width, 92);
    const AxisScale axis = percent_axis(rows);
    SvgDocument svg = row_picture(layout, axis, "passed, %", title);
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const RateRow& row = rows[i];
        const double y = layout.y(i);
        svg.begin_group("rate", fmt::format("{}: {} of {} passed", row.label, row.passed, row.trials));
        draw_row_label(svg, layout, row.label, y);
        draw_row_note(svg, layout, fmt::format("{} / {}", row.passed, row.trials), y);
        if (row.trials > 0) {
            const double left = layout.panel.x(axis, 100 * row.low);
            const double right = layout.panel.x(axis, 100 * row.high);
            svg.line({left, y}, {right, y}, {.stroke = style::series, .width = 2, .opacity = 0.55});
            for (const double end : {left, right})
                svg.line({end, y - 4}, {end, y + 4}, {.stroke = style::series, .width = 1.4, .opacity = 0.8});
            svg.circle({layout.panel.x(axis, 100 * row.share), y}, 4, {.fill = style::series});
        }
        svg.end_group();
    }
    return svg;
}

SvgDocument box_rows_plot(std::span<const BoxRow> rows, const std::string& axis_name, const std::string& title) {
    const RowLayout layout = row_layout(rows, level_plot_width, 58);
    double low = 0, high = 0;
    bool any = false;
    for (const BoxRow& row : rows) {
        if (row.count == 0) continue;
        low = any ? std::min(low, row.p5) : row.p5;
        high = any ? std::max(high, row.p95) : row.p95;
        any = true;
    }
    const AxisScale axis = axis_over(low, high + 0.03 * (high - low), 5);
    SvgDocument svg = row_picture(layout, axis, axis_name, title);
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const BoxRow& row = rows[i];
        const double y = layout.y(i);
        const auto x = [&](double value) { return layout.panel.x(axis, value); };
        svg.begin_group("box", fmt::format("{}: median {:.4g}, 5 % {:.4g}, 95 % {:.4g}, {} runs", row.label, row.median,
                                           row.p5, row.p95, row.count));
        draw_row_label(svg, layout, row.label, y);
        draw_row_note(svg, layout, fmt::format("n {}", row.count), y);
        if (row.count > 0) {
            svg.line({x(row.p5), y}, {x(row.p95), y}, {.stroke = style::series, .width = 1.4, .opacity = 0.7});
            svg.rectangle({x(row.p25), y - 6.5}, {std::max(1.0, x(row.p75) - x(row.p25)), 13}, 2,
                          {.fill = style::series, .opacity = 0.45});
            svg.line({x(row.median), y - 7.5}, {x(row.median), y + 7.5}, {.stroke = style::accent, .width = 2.2});
        }
        svg.end_group();
    }
    return svg;
}

namespace {

namespace style = plot_style;

constexpr double map_text_size = 11;
constexpr double cell_height = 30;
constexpr double tilt_deg = 40;
constexpr double longest_map_label = 130;
// On coloured cells, whose colours are the same on dark pages: not the ink that changes with the page.
constexpr std::string_view dark_figure = "#10161d", light_figure = "#fdfdfd";

struct MapLayout {
    double left = 0, top = 20, cell_width = 0, bottom = 0, height = 0;
    bool tilted = false;
};

double widest_label(const std::vector<std::string>& labels) {
    double widest = 0;
    for (const std::string& label : labels)
        widest = std::max(widest, style::text_width(label, map_text_size));
    return widest;
}

double cell_width(const RateMap& map, double left) {
    return (rate_map_width - left - 24) / static_cast<double>(std::max<std::size_t>(1, map.columns.size()));
}

MapLayout map_layout(const RateMap& map) {
    const double tilt = tilt_deg * std::numbers::pi / 180;
    const double columns = std::min(widest_label(map.columns), longest_map_label);
    MapLayout layout;
    layout.left = std::min(widest_label(map.rows), longest_map_label) + 50;
    layout.tilted = columns > cell_width(map, layout.left) - 6;
    // A tilted label ends below its cell and begins left of it, inside the sheet.
    if (layout.tilted) layout.left = std::max(layout.left, columns * std::cos(tilt) + 4);
    layout.cell_width = cell_width(map, layout.left);
    layout.bottom = layout.top + cell_height * static_cast<double>(map.rows.size());
    layout.height = layout.bottom + (layout.tilted ? columns * std::sin(tilt) + 16 : 22) + 70;
    return layout;
}

void draw_map_labels(SvgDocument& svg, const RateMap& map, const MapLayout& layout) {
    for (std::size_t i = 0; i < map.columns.size(); ++i) {
        const double x = layout.left + layout.cell_width * (static_cast<double>(i) + 0.5);
        svg.text({.at = {x + (layout.tilted ? 4 : 0), layout.bottom + (layout.tilted ? 10 : 13)},
                  .text = fitting_text(map.columns[i], longest_map_label, map_text_size),
                  .size = map_text_size,
                  .fill = style::faint_ink,
                  .anchor = layout.tilted ? "end" : "middle",
                  .rotation_deg = layout.tilted ? -tilt_deg : 0});
    }
    for (std::size_t i = 0; i < map.rows.size(); ++i)
        style::note(svg, {layout.left - 8, layout.bottom - cell_height * (static_cast<double>(i) + 0.5)},
                    fitting_text(map.rows[i], longest_map_label, map_text_size), map_text_size, "end");
    const double across = rate_map_width - layout.left - 24;
    style::axis_name(svg, {layout.left + across / 2, layout.height - 55}, fitting_text(map.column_axis, across, 12));
    style::axis_name(svg, {20, (layout.top + layout.bottom) / 2},
                     fitting_text(map.row_axis, std::max(60.0, layout.bottom - layout.top + 20), 12), -90);
}

// The colours begin at a round percentage at or below the lowest rate.
double lowest_colour(const RateMap& map) {
    double lowest = 1;
    for (const RateCell& cell : map.cells)
        if (cell.trials > 0)
            lowest = std::min(lowest, static_cast<double>(cell.passed) / static_cast<double>(cell.trials));
    return std::min(0.9, std::floor(lowest * 10) / 10);
}

std::string percent_figure(const RateCell& cell) {
    const double percent = 100 * static_cast<double>(cell.passed) / static_cast<double>(cell.trials);
    // Rounding must not turn nearly all into all.
    if (cell.passed < cell.trials && percent > 99.5) return ">99";
    if (cell.passed > 0 && percent < 0.5) return "<1";
    return fmt::format("{:.0f}", percent);
}

void draw_map_cells(SvgDocument& svg, const RateMap& map, const MapLayout& layout, double lowest) {
    for (std::size_t row = 0; row < map.rows.size(); ++row)
        for (std::size_t column = 0; column < map.columns.size(); ++column) {
            const RateCell& cell = map.cells[row * map.columns.size() + column];
            const double x = layout.left + layout.cell_width * static_cast<double>(column);
            const double y = layout.bottom - cell_height * static_cast<double>(row + 1);
            if (cell.trials == 0) {
                svg.rectangle({x + 0.7, y + 0.7}, {layout.cell_width - 1.4, cell_height - 1.4}, 2,
                              {.stroke = style::grid, .dash = "3 3"});
                continue;
            }
            const double share = static_cast<double>(cell.passed) / static_cast<double>(cell.trials);
            const double level = (share - lowest) / (1 - lowest);
            svg.begin_group("cell",
                            fmt::format("{}, {}: {} of {} passed, 95 % interval {:.1f} … {:.1f} %", map.columns[column],
                                        map.rows[row], cell.passed, cell.trials, 100 * cell.low, 100 * cell.high));
            svg.rectangle({x + 0.7, y + 0.7}, {layout.cell_width - 1.4, cell_height - 1.4}, 2,
                          {.fill = style::ramp_colour(style::value_ramp, level)});
            svg.text({.at = {x + layout.cell_width / 2, y + cell_height / 2},
                      .text = percent_figure(cell),
                      .size = map_text_size,
                      .fill = level > 0.55 ? dark_figure : light_figure,
                      .anchor = "middle"});
            svg.end_group();
        }
}

void draw_map_legend(SvgDocument& svg, const MapLayout& layout, double lowest) {
    constexpr int steps = 40;
    constexpr double width = 3.5;
    const double y = layout.height - 30;
    for (int i = 0; i < steps; ++i)
        svg.rectangle({layout.left + i * width, y}, {width + 0.2, 10}, 0,
                      {.fill = style::ramp_colour(style::value_ramp, (i + 0.5) / steps)});
    style::note(svg, {layout.left - 8, y + 5}, fmt::format("{:.0f}", 100 * lowest), map_text_size, "end");
    style::note(svg, {layout.left + steps * width + 8, y + 5}, "100 % passed", map_text_size);
}

}  // namespace

SvgDocument rate_map_plot(const RateMap& map) {
    const MapLayout layout = map_layout(map);
    SvgDocument svg = style::blank_sheet({rate_map_width, layout.height}, map.title);
    if (map.cells.size() != map.rows.size() * map.columns.size() || map.cells.empty()) return svg;
    const double lowest = lowest_colour(map);
    draw_map_cells(svg, map, layout, lowest);
    draw_map_labels(svg, map, layout);
    draw_map_legend(svg, layout, lowest);
    return svg;
}

}  // namespace skyloop::inline study
