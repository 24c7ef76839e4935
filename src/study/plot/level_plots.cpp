#include "study/plot/level_plots.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "detail/axis_scale.hpp"
#include "detail/plot_style.hpp"

namespace skyloop {
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
    svg.text({.at = {layout.panel.right() + 10, y}, .text = note, .size = 11, .fill = style::faint_ink});
}

SvgDocument row_picture(const RowLayout& layout, const AxisScale& axis, const std::string& axis_name,
                        const std::string& title) {
    SvgDocument svg(layout.width, layout.height, title);
    style::draw_sheet(svg, {layout.width, layout.height});
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

}  // namespace skyloop
