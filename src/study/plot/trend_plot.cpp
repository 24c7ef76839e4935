#include "study/plot/trend_plot.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "detail/axis_scale.hpp"
#include "detail/plot_style.hpp"

namespace skyloop {
namespace {

namespace style = plot_style;

constexpr PanelArea trend_area{78, 20, 352, 212};

std::vector<double> sorted_heights(const std::vector<SvgPoint>& dots) {
    std::vector<double> heights;
    for (const SvgPoint& dot : dots)
        heights.push_back(dot.y);
    std::sort(heights.begin(), heights.end());
    return heights;
}

// Drawn is every k-th dot of those in the order of the plan, which has nothing to do with their values.
std::size_t draw_trend_dots(SvgDocument& svg, const TrendPlot& plot, const AxisScale& across, const AxisScale& upward) {
    const std::size_t stride = std::max<std::size_t>(1, (plot.dots.size() + most_trend_dots - 1) / most_trend_dots);
    std::size_t drawn = 0;
    SvgPath dots;
    for (std::size_t i = 0; i < plot.dots.size(); i += stride) {
        ++drawn;
        if (plot.dots[i].y > upward.to || plot.dots[i].y < upward.from) continue;
        const SvgPoint p{trend_area.x(across, plot.dots[i].x), trend_area.y(upward, plot.dots[i].y)};
        dots.move_to(p).line_to(p);
    }
    svg.begin_group("runs");
    svg.path(dots, {.stroke = style::series, .width = 3, .opacity = 0.4});
    svg.end_group();
    return drawn;
}

void draw_trend_ranges(SvgDocument& svg, const TrendPlot& plot, const AxisScale& across, const AxisScale& upward) {
    svg.begin_group("ranges", "median, 5th and 95th percentile");
    for (const TrendRange& range : plot.ranges) {
        const double left = trend_area.x(across, range.low);
        const double right = std::max(left + 3, trend_area.x(across, range.high));
        const double top = trend_area.y(upward, range.p95), bottom = trend_area.y(upward, range.p5);
        svg.rectangle({left, top}, {right - left, std::max(0.5, bottom - top)}, 0,
                      {.fill = style::accent, .opacity = 0.13});
        const double y = trend_area.y(upward, range.median);
        svg.line({left, y}, {right, y}, {.stroke = style::accent, .width = 2.2});
    }
    svg.end_group();
}

}  // namespace

SvgDocument trend_plot(const TrendPlot& plot) {
    SvgDocument svg(trend_plot_width, trend_plot_height, plot.title);
    style::draw_sheet(svg, {trend_plot_width, trend_plot_height});
    if (plot.dots.empty()) return svg;
    const std::vector<double> heights = sorted_heights(plot.dots);
    const ShownRange range = shown_range(heights);
    const auto [first, last] = std::minmax_element(plot.dots.begin(), plot.dots.end(),
                                                   [](const SvgPoint& a, const SvgPoint& b) { return a.x < b.x; });
    const AxisScale across = axis_over(first->x, last->x, 6);
    const AxisScale upward = axis_over(range.low, range.high, 6);
    svg.rectangle({trend_area.left, trend_area.top}, {trend_area.width, trend_area.height}, 0, {.fill = style::panel});
    draw_bottom_axis(svg, trend_area, across, plot.x_axis);
    draw_left_axis(svg, trend_area, upward, plot.y_axis);
    draw_trend_ranges(svg, plot, across, upward);
    const std::size_t drawn = draw_trend_dots(svg, plot, across, upward);
    std::string note = outside_words(range, heights);
    if (drawn < plot.dots.size())
        note = fmt::format("{} of {} runs drawn{}{}", drawn, plot.dots.size(), note.empty() ? "" : "; ", note);
    if (!note.empty())
        svg.text({.at = {trend_plot_width - 20, trend_area.bottom() + 53},
                  .text = note,
                  .size = 10.5,
                  .fill = style::faint_ink,
                  .anchor = "end"});
    return svg;
}

}  // namespace skyloop
