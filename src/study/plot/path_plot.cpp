#include "study/plot/path_plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/geo/local_frame.hpp"
#include "detail/plan_view.hpp"
#include "detail/plot_style.hpp"

namespace skyloop::inline study {
namespace {

// What is drawn of a sample.
struct PathDot {
    double time = 0, height = 0, speed = 0;  // s, m, m/s
    Eigen::Vector2d place;                   // m east and north of the beginning
    bool breaks = false;                     // no line leads here
};

std::vector<PathDot> path_dots(std::span<const PathSample> samples) {
    std::vector<PathDot> dots;
    if (samples.empty()) return dots;
    const LocalFrame frame(samples.front().state.geodetic);
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const PathSample& sample = samples[i];
        PathDot dot{sample.time_s, sample.state.geodetic.height.above_ellipsoid.value(), sample.velocity_ned.norm(),
                    frame.to_enu(sample.state.position).vector().head<2>()};
        if (i > 0) {
            const PathSample& last = samples[i - 1];
            const double way = (sample.state.position - last.state.position).length().value();
            const double driven =
                (sample.time_s - last.time_s) * std::max(sample.velocity_ned.norm(), last.velocity_ned.norm());
            constexpr double least_jump_m = 5;
            dot.breaks = way > least_jump_m + 3 * driven;
        }
        dots.push_back(dot);
    }
    return dots;
}

// @param shape width for height of the picture, which it fills
Eigen::AlignedBox2d plan_box(std::span<const PathDot> dots, double shape) {
    constexpr double least_side_m = 2, margin_part = 0.06;
    Eigen::AlignedBox2d box(Eigen::Vector2d(0, 0));
    for (const PathDot& dot : dots)
        box.extend(dot.place);
    const double margin = std::max(least_side_m / 2, margin_part * box.sizes().maxCoeff());
    box.min().array() -= margin;
    box.max().array() += margin;
    const double wider = std::max(0.0, shape * box.sizes().y() - box.sizes().x()) / 2;
    const double higher = std::max(0.0, box.sizes().x() / shape - box.sizes().y()) / 2;
    box.min() -= Eigen::Vector2d(wider, higher);
    box.max() += Eigen::Vector2d(wider, higher);
    return box;
}

// A value against time.
struct TimePanel {
    std::string_view name, unit;
    double PathDot::*value;
    SvgPoint corner, size;
    double least = 0, most = 1, span = 1;  // of the value, and of the time in s

    [[nodiscard]] SvgPoint at(double time, double height) const {
        return {corner.x + time / span * size.x, corner.y + size.y * (1 - (height - least) / (most - least))};
    }
};

void fit_panel(TimePanel& panel, std::span<const PathDot> dots) {
    panel.least = panel.most = dots.front().*panel.value;
    for (const PathDot& dot : dots) {
        panel.least = std::min(panel.least, dot.*panel.value);
        panel.most = std::max(panel.most, dot.*panel.value);
    }
    constexpr double least_span = 1;
    const double margin = std::max(least_span / 2, 0.08 * (panel.most - panel.least));
    panel.least -= panel.least == 0 ? 0 : margin;
    panel.most += margin;
    panel.span = std::max(1e-3, dots.back().time);
}

void draw_panel_axes(SvgDocument& svg, const TimePanel& panel, bool with_time) {
    namespace style = plot_style;
    svg.rectangle(panel.corner, panel.size, 0, {.fill = style::panel, .stroke = style::grid});
    const double step = style::round_step(panel.most - panel.least, 4);
    for (double value = std::ceil(panel.least / step) * step; value <= panel.most; value += step) {
        const SvgPoint p = panel.at(0, value);
        svg.line(p, {panel.corner.x + panel.size.x, p.y}, {.stroke = style::faint_grid});
        style::note(svg, {p.x - 6, p.y}, fmt::format("{:g}", std::abs(value) < step / 2 ? 0 : value), 11, "end");
    }
    const double time_step = style::round_step(panel.span, 8);
    for (double t = 0; t <= panel.span * (1 + 1e-9); t += time_step) {
        const SvgPoint p = panel.at(t, panel.least);
        svg.line(p, {p.x, panel.corner.y}, {.stroke = style::faint_grid});
        if (with_time) style::note(svg, {p.x, p.y + 13}, fmt::format("{:g}", t), 11, "middle");
    }
    svg.text({.at = {panel.corner.x, panel.corner.y - 10},
              .text = fmt::format("{}, {}", panel.name, panel.unit),
              .size = 12,
              .bold = true});
    if (with_time)
        style::note(svg, {panel.corner.x + panel.size.x, panel.corner.y + panel.size.y + 28}, "time, s", 11, "end");
}

void draw_time_panel(SvgDocument& svg, TimePanel panel, std::span<const PathDot> dots, bool with_time) {
    fit_panel(panel, dots);
    svg.begin_group(panel.name);
    draw_panel_axes(svg, panel, with_time);
    SvgPath line;
    for (std::size_t i = 0; i < dots.size(); ++i) {
        const SvgPoint p = panel.at(dots[i].time, dots[i].*panel.value);
        if (i == 0 || dots[i].breaks)
            line.move_to(p);
        else
            line.line_to(p);
    }
    svg.path(line, {.stroke = plot_style::constellation_colour(Constellation::gps), .width = 1.6});
    svg.end_group();
}

constexpr int path_colours = 12;

// The lightest end of the ramp does not show on paper.
std::string path_colour(int k) {
    return plot_style::ramp_colour(plot_style::value_ramp, 0.85 * (k + 0.5) / path_colours);
}

int speed_class(const PathDot& dot, double fastest) {
    return fastest > 0 ? std::min(path_colours - 1, static_cast<int>(dot.speed / fastest * path_colours)) : 0;
}

// One path of lines for each class of speed: lines of one colour are one element of the picture.
void draw_way(SvgDocument& svg, const PlanView& view, std::span<const PathDot> dots, double fastest) {
    std::vector<SvgPath> paths(path_colours);
    int last_class = -1;
    for (std::size_t i = 1; i < dots.size(); ++i) {
        const int now = speed_class(dots[i], fastest);
        SvgPath& path = paths[static_cast<std::size_t>(now)];
        const bool goes_on = now == last_class && !dots[i].breaks;
        if (!goes_on) path.move_to(view.at(dots[dots[i].breaks ? i : i - 1].place));
        path.line_to(view.at(dots[i].place));
        last_class = dots[i].breaks ? -1 : now;
    }
    svg.begin_group("way");
    for (int k = 0; k < path_colours; ++k)
        if (const SvgPath& path = paths[static_cast<std::size_t>(k)]; !path.empty())
            svg.path(path, {.stroke = path_colour(k), .width = 2.4});
    svg.end_group();
}

void mark_ends(SvgDocument& svg, const PlanView& view, const PathDot& first, const PathDot& last) {
    namespace style = plot_style;
    const SvgPoint begins = view.at(first.place), ends = view.at(last.place);
    svg.circle(begins, 5, {.fill = style::line_of_sight, .stroke = style::paper, .width = 1.5});
    svg.rectangle({ends.x - 4.5, ends.y - 4.5}, {9, 9}, 0,
                  {.fill = style::blocked, .stroke = style::paper, .width = 1.5});
}

void draw_plan(SvgDocument& svg, std::span<const PathDot> dots, SvgPoint corner, SvgPoint size) {
    namespace style = plot_style;
    double fastest = 0;
    for (const PathDot& dot : dots)
        fastest = std::max(fastest, dot.speed);
    const PlanView view(plan_box(dots, size.x / size.y), corner, size);
    svg.begin_group("plan");
    svg.rectangle(view.corner(), view.size(), 0, {.fill = style::panel, .stroke = style::grid});
    draw_way(svg, view, dots, fastest);
    mark_ends(svg, view, dots.front(), dots.back());
    draw_scale_and_north(svg, view);
    svg.end_group();
    // The key of the colours, beside the title.
    const SvgPoint key{path_plot_width - 220, 34};
    svg.begin_group("speed key");
    for (int k = 0; k < path_colours; ++k)
        svg.rectangle({key.x + 8.0 * k, key.y - 4}, {8.5, 8}, 0, {.fill = path_colour(k)});
    style::note(svg, {key.x - 6, key.y}, "0", 11, "end");
    style::note(svg, {key.x + 8 * path_colours + 6, key.y}, fmt::format("{:.3g} m/s", fastest));
    svg.end_group();
}

}  // namespace

std::string path_plot_svg(std::span<const PathSample> samples, const std::string& title) {
    namespace style = plot_style;
    SvgDocument svg = style::blank_sheet({path_plot_width, path_plot_height}, title);
    svg.text({.at = {24, 34}, .text = title, .size = 16, .bold = true});
    const std::vector<PathDot> dots = path_dots(samples);
    if (dots.empty()) return svg.str();
    constexpr double left = 64, width = path_plot_width - left - 28;
    draw_plan(svg, dots, {24, 56}, {path_plot_width - 48, 470});
    draw_time_panel(svg, {"height", "m above the ellipsoid", &PathDot::height, {left, 572}, {width, 100}}, dots, false);
    draw_time_panel(svg, {"speed", "m/s", &PathDot::speed, {left, 712}, {width, 100}}, dots, true);
    return svg.str();
}

}  // namespace skyloop::inline study
