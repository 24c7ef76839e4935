#include "study/plot/metric_plots.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "detail/axes_and_labels.hpp"
#include "detail/plot_style.hpp"

namespace skyloop::inline study {
namespace {

namespace style = plot_style;

constexpr PanelArea histogram_area{66, 44, 374, 196};
constexpr PanelArea steps_area{524, 44, 374, 196};

struct ValueBins {
    double from = 0, width = 1;
    std::vector<double> shares;  // percent
    [[nodiscard]] double to() const { return from + width * static_cast<double>(shares.size()); }
};

bool all_whole(std::span<const double> sorted) {
    return std::all_of(sorted.begin(), sorted.end(), [](double v) { return v == std::floor(v); });
}

// Freedman and Diaconis's width, 2·IQR·n^(−1/3), made round; 8 to 60 bins.
double round_bin_width(std::span<const double> sorted, const AxisScale& axis) {
    const double span = axis.to - axis.from;
    const double quartiles = sorted[sorted.size() * 3 / 4] - sorted[sorted.size() / 4];
    const double advised = 2 * quartiles / std::cbrt(static_cast<double>(sorted.size()));
    const double wanted = std::clamp(advised, span / 60, span / 8);
    return axis_over(0, wanted * 10, 10).step;
}

ValueBins value_bins(std::span<const double> sorted, const ShownRange& range, AxisScale& axis) {
    constexpr double most_whole_bins = 60;
    ValueBins bins;
    double count = 0;
    if (all_whole(sorted) && range.high - range.low < most_whole_bins) {
        bins.from = range.low - 0.5;
        count = range.high - range.low + 1;
        axis.from = std::min(axis.from, bins.from);
    } else {
        bins.width = round_bin_width(sorted, axis);
        bins.from = std::floor(std::max(range.low, axis.from) / bins.width) * bins.width;
        // Numbers so large that their bins cannot be told apart are equal already for the axis.
        count = std::clamp(std::floor((range.high - bins.from) / bins.width) + 1, 1.0, 200.0);
    }
    bins.shares.resize(static_cast<std::size_t>(count));
    for (const double value : sorted) {
        if (value < range.low || value > range.high) continue;
        const double place = std::clamp(std::floor((value - bins.from) / bins.width), 0.0, count - 1);
        bins.shares[static_cast<std::size_t>(place)] += 100 / static_cast<double>(sorted.size());
    }
    axis.from = std::min(axis.from, bins.from);
    axis.to = std::max(axis.to, bins.to());
    return bins;
}

void draw_value_histogram(SvgDocument& svg, const DistributionPlot& plot, const AxisScale& axis,
                          const ValueBins& bins) {
    const PanelArea& area = histogram_area;
    const double highest = *std::max_element(bins.shares.begin(), bins.shares.end());
    const AxisScale upward = axis_over(0, 1.06 * highest, 5);
    svg.begin_group("histogram", plot.axis);
    svg.rectangle({area.left, area.top}, {area.width, area.height}, 0, {.fill = style::panel});
    draw_bottom_axis(svg, area, axis, plot.axis);
    draw_left_axis(svg, area, upward, "runs, %");
    for (std::size_t i = 0; i < bins.shares.size(); ++i) {
        if (bins.shares[i] <= 0) continue;
        const double begin = bins.from + bins.width * static_cast<double>(i);
        const double left = area.x(axis, begin), right = area.x(axis, begin + bins.width);
        const double y = area.y(upward, bins.shares[i]);
        const double gap = right - left > 3 ? 0.4 : 0;
        svg.rectangle({left + gap, y}, {right - left - 2 * gap, area.bottom() - y}, 0,
                      {.fill = style::series, .opacity = 0.62});
    }
    svg.line({area.left, area.bottom()}, {area.right(), area.bottom()}, {.stroke = style::faint_ink});
    for (const MarkedPercentile& mark : plot.percentiles) {
        const bool median = mark.share == 0.5;
        if ((!median && mark.share != 0.95) || mark.value > axis.to || mark.value < axis.from) continue;
        const double x = area.x(axis, mark.value);
        svg.line(
            {x, area.bottom()}, {x, area.top},
            {.stroke = median ? style::accent : style::ink, .width = median ? 1.8 : 1.3, .dash = median ? "" : "6 4"});
    }
    svg.end_group();
}

// The distribution function at some of its steps: value and share, first and last always among them.
std::vector<SvgPoint> drawn_steps(std::span<const double> sorted) {
    std::vector<SvgPoint> steps;
    const std::size_t n = sorted.size();
    const std::size_t count = std::min(n, most_distribution_steps);
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t rank = count == 1 ? 0 : i * (n - 1) / (count - 1);
        steps.push_back({sorted[rank], static_cast<double>(rank + 1) / static_cast<double>(n)});
    }
    return steps;
}

// The outline of the function moved up or down by `shift`, from left to right.
std::vector<SvgPoint> step_outline(const std::vector<SvgPoint>& steps, const AxisScale& axis, double shift) {
    const PanelArea& area = steps_area;
    const AxisScale upward{0, 1, 0.25};
    std::vector<SvgPoint> outline;
    double share = std::max(0.0, shift);
    outline.push_back({area.left, area.y(upward, share)});
    for (const SvgPoint& step : steps) {
        if (step.x > axis.to) break;
        const double x = area.x(axis, step.x);
        outline.push_back({x, area.y(upward, share)});
        share = step.y + shift;
        outline.push_back({x, area.y(upward, share)});
    }
    outline.push_back({area.right(), area.y(upward, share)});
    return outline;
}

SvgPath line_through(const std::vector<SvgPoint>& points) {
    SvgPath path;
    for (const SvgPoint& point : points)
        path.empty() ? path.move_to(point) : path.line_to(point);
    return path;
}

void draw_marked_percentiles(SvgDocument& svg, const DistributionPlot& plot, const AxisScale& axis) {
    const PanelArea& area = steps_area;
    const AxisScale upward{0, 1, 0.25};
    for (const MarkedPercentile& mark : plot.percentiles) {
        const double y = area.y(upward, mark.share);
        const double left = mark.low ? area.x(axis, *mark.low) : area.left;
        const double right = mark.high ? area.x(axis, *mark.high) : area.right();
        svg.line({left, y}, {right, y}, {.stroke = style::accent, .width = 2});
        for (const auto& [end, x] : {std::pair(mark.low, left), std::pair(mark.high, right)})
            if (end && *end <= axis.to && *end >= axis.from)
                svg.line({x, y - 3.5}, {x, y + 3.5}, {.stroke = style::accent, .width = 1.4});
        if (mark.value <= axis.to && mark.value >= axis.from)
            svg.circle({area.x(axis, mark.value), y}, 3, {.fill = style::accent});
    }
}

void draw_distribution_function(SvgDocument& svg, const DistributionPlot& plot, const AxisScale& axis) {
    const PanelArea& area = steps_area;
    svg.begin_group("distribution", "share of runs with at most this value");
    svg.rectangle({area.left, area.top}, {area.width, area.height}, 0, {.fill = style::panel});
    draw_bottom_axis(svg, area, axis, plot.axis);
    draw_left_axis(svg, area, {0, 100, 25}, "runs with at most this, %");
    const std::vector<SvgPoint> steps = drawn_steps(plot.sorted);
    std::vector<SvgPoint> around = step_outline(steps, axis, plot.band);
    const std::vector<SvgPoint> lower = step_outline(steps, axis, -plot.band);
    around.insert(around.end(), lower.rbegin(), lower.rend());
    svg.path(line_through(around).close(), {.fill = style::series, .opacity = 0.16});
    svg.path(line_through(step_outline(steps, axis, 0)), {.stroke = style::series, .width = 1.6});
    draw_marked_percentiles(svg, plot, axis);
    svg.line({area.left, area.bottom()}, {area.right(), area.bottom()}, {.stroke = style::faint_ink});
    svg.end_group();
}

void draw_distribution_legend(SvgDocument& svg, const DistributionPlot& plot, const ShownRange& range) {
    constexpr double y = 24;
    const auto entry = [&](double x, const SvgStyle& line, const char* label) {
        svg.line({x, y}, {x + 24, y}, line);
        style::note(svg, {x + 30, y}, label, 11.5);
    };
    entry(66, {.stroke = style::accent, .width = 1.8}, "median");
    entry(156, {.stroke = style::ink, .width = 1.3, .dash = "6 4"}, "95th percentile");
    entry(524, {.stroke = style::series, .width = 9, .opacity = 0.25}, "95 % band");
    entry(630, {.stroke = style::accent, .width = 2}, "95 % intervals of p5, p50, p95, p99");
    std::string note = outside_words(range, plot.sorted);
    if (plot.sorted.size() > most_distribution_steps)
        note += fmt::format("{}function drawn at {} of its {} steps", note.empty() ? "" : "; ", most_distribution_steps,
                            plot.sorted.size());
    if (!note.empty()) style::note(svg, {distribution_plot_width - 22, steps_area.bottom() + 51}, note, 10.5, "end");
}

}  // namespace

SvgDocument distribution_plot(const DistributionPlot& plot) {
    SvgDocument svg =
        style::blank_sheet({distribution_plot_width, distribution_plot_height}, "Distribution of " + plot.axis);
    if (plot.sorted.empty()) return svg;
    const ShownRange range = shown_range(plot.sorted);
    AxisScale axis = axis_over(range.low, range.high, 7);
    const ValueBins bins = value_bins(plot.sorted, range, axis);
    draw_distribution_legend(svg, plot, range);
    draw_value_histogram(svg, plot, axis, bins);
    draw_distribution_function(svg, plot, axis);
    return svg;
}

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
    SvgDocument svg = style::blank_sheet({trend_plot_width, trend_plot_height}, plot.title);
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
    if (!note.empty()) style::note(svg, {trend_plot_width - 20, trend_area.bottom() + 53}, note, 10.5, "end");
    return svg;
}

}  // namespace skyloop::inline study
