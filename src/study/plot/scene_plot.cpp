#include "study/plot/scene_plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "detail/colour_ramp.hpp"
#include "detail/label_placement.hpp"
#include "detail/plan_view.hpp"
#include "detail/plot_style.hpp"

namespace skyloop {
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
    svg.text({.at = {at.x + steps * width + 8, at.y},
              .text = fmt::format("0 … {:.0f} m above ground", highest),
              .size = 11.5,
              .fill = style::faint_ink});
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
        svg.text({.at = {x + 28, y}, .text = word, .size = 11.5, .fill = style::faint_ink});
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
    SvgDocument svg(scene_plot_width, scene_plot_height, title);
    style::draw_sheet(svg, {scene_plot_width, scene_plot_height});
    svg.text({.at = {30, 30}, .text = title, .size = 17, .bold = true});
    svg.text({.at = {30, 54},
              .text = plot.subtitle.empty() ? scene_summary(scene) : plot.subtitle,
              .size = 12,
              .fill = style::faint_ink});
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

}  // namespace skyloop
