#include "study/plot/scatter_plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include "detail/plot_style.hpp"
#include "detail/scatter_panel.hpp"

namespace skyloop::inline study {
namespace {

namespace style = plot_style;

constexpr std::string_view candidate_colour = "#1f5fbf";
constexpr std::string_view reference_colour = "#0a8f72";

ScatterPanel scatter_panel(const ScatterCloud& cloud, std::string_view colour, int place, ErrorQuantity quantity) {
    return {cloud,
            colour,
            panel_left + place * (panel_width + panel_gap),
            sample_statistics(cloud.errors.east),
            sample_statistics(cloud.errors.north),
            sample_statistics(cloud.errors.horizontal),
            quantity,
            sample_statistics(error_values(cloud.errors, quantity))};
}

// Metres east or north that the figures of a cloud reach, its circle and its ellipse.
double figures_reach(const ScatterPanel& panel) {
    if (!panel.horizontal) return 0;
    const ErrorEllipse ellipse = error_ellipse_95(panel.cloud.errors.east, panel.cloud.errors.north);
    return std::max(panel.horizontal->p95, std::hypot(panel.east->mean, panel.north->mean) + ellipse.major);
}

// Metres from the middle of a panel to its edge: all dots but the wildest one in 500 of either cloud, and the figures
// unless a wild fix has made them many times larger than the dots.
double scatter_reach(const ScatterPanel& a, const ScatterPanel& b) {
    double reach = 0.01;
    for (const ScatterPanel* panel : {&a, &b}) {
        std::vector<double> largest;
        for (std::size_t i = 0; i < panel->cloud.errors.east.size(); ++i)
            largest.push_back(std::max(std::abs(panel->cloud.errors.east[i]), std::abs(panel->cloud.errors.north[i])));
        reach = std::max(reach, all_but_wildest(std::move(largest)));
    }
    const double figures = std::max(figures_reach(a), figures_reach(b));
    return 1.05 * (figures < 2 * reach ? std::max(reach, figures) : reach);
}

void draw_cloud_axes(SvgDocument& svg, const ScatterPanel& panel, double reach) {
    const double scale = cloud_size / 2 / reach;
    const SvgPoint centre{panel.left + cloud_size / 2, cloud_top + cloud_size / 2};
    svg.rectangle({panel.left, cloud_top}, {cloud_size, cloud_size}, 0, {.fill = style::panel, .stroke = style::grid});
    const double step = style::round_step(2 * reach, 8);
    for (double t = -std::floor(reach / step) * step; t <= reach * (1 + 1e-9); t += step) {
        const std::string_view colour = std::abs(t) < step / 1000 ? style::grid : style::faint_grid;
        const double x = centre.x + t * scale;
        const double y = centre.y - t * scale;
        svg.line({x, cloud_top}, {x, cloud_top + cloud_size}, {.stroke = colour});
        svg.line({panel.left, y}, {panel.left + cloud_size, y}, {.stroke = colour});
        style::note(svg, {x, cloud_top + cloud_size + 13}, scatter_tick(t, step), 11, "middle");
        style::note(svg, {panel.left - 7, y}, scatter_tick(t, step), 11, "end");
    }
    style::axis_name(svg, {centre.x, cloud_top + cloud_size + 32}, "east error, m");
    style::axis_name(svg, {panel.left - 40, centre.y}, "north error, m", -90);
}

// At most this many dots: more hide each other and make the file large.
constexpr std::size_t most_dots = 4000;

// Draws the dots and returns how many of all fixes lie outside the panel.
std::size_t draw_dots(SvgDocument& svg, const ScatterPanel& panel, double reach) {
    const double scale = cloud_size / 2 / reach;
    const SvgPoint centre{panel.left + cloud_size / 2, cloud_top + cloud_size / 2};
    const std::vector<double>& east = panel.cloud.errors.east;
    const std::vector<double>& north = panel.cloud.errors.north;
    const std::size_t stride = std::max<std::size_t>(1, (east.size() + most_dots - 1) / most_dots);
    std::size_t outside = 0;
    SvgPath dots;
    for (std::size_t i = 0; i < east.size(); ++i) {
        if (std::max(std::abs(east[i]), std::abs(north[i])) > reach) {
            ++outside;
            continue;
        }
        if (i % stride != 0) continue;
        // A line of no length with round ends is a dot, in a third of the bytes of a circle.
        const SvgPoint p{centre.x + east[i] * scale, centre.y - north[i] * scale};
        dots.move_to(p).line_to(p);
    }
    svg.begin_group("fixes");
    svg.path(dots, {.stroke = panel.colour, .width = 2.6, .opacity = 0.45});
    svg.end_group();
    return outside;
}

void draw_cloud_figures(SvgDocument& svg, const ScatterPanel& panel, double reach) {
    if (!panel.east || !panel.horizontal) return;
    const double scale = cloud_size / 2 / reach;
    const SvgPoint centre{panel.left + cloud_size / 2, cloud_top + cloud_size / 2};
    const SvgPoint mean{centre.x + panel.east->mean * scale, centre.y - panel.north->mean * scale};
    const ErrorEllipse ellipse = error_ellipse_95(panel.cloud.errors.east, panel.cloud.errors.north);
    svg.begin_group("mean", "mean and 95 %");
    // What would not fit into the panel is left out rather than drawn over its neighbours.
    if (panel.horizontal->p95 <= reach)
        svg.circle(centre, panel.horizontal->p95 * scale, {.stroke = style::ink, .width = 1.3, .dash = "6 4"});
    if (std::hypot(panel.east->mean, panel.north->mean) + ellipse.major <= reach)
        svg.ellipse(mean, {ellipse.major * scale, ellipse.minor * scale}, ellipse.azimuth.deg() - 90,
                    {.stroke = style::accent, .width = 1.6});
    if (std::max(std::abs(panel.east->mean), std::abs(panel.north->mean)) <= reach)
        for (const auto& [colour, width] : {std::pair(style::paper, 5.0), std::pair(style::accent, 2.4)}) {
            svg.line({mean.x - 8, mean.y}, {mean.x + 8, mean.y}, {.stroke = colour, .width = width});
            svg.line({mean.x, mean.y - 8}, {mean.x, mean.y + 8}, {.stroke = colour, .width = width});
        }
    svg.end_group();
}

// The end of a long file name, which tells more than its start; cut between characters.
std::string shortened(const std::string& name) {
    constexpr std::size_t longest_name = 42;
    if (name.size() <= longest_name) return name;
    std::size_t start = name.size() - longest_name;
    while (start < name.size() && (name[start] & 0xC0) == 0x80)
        ++start;
    return std::string("…").append(name.substr(start));
}

void draw_cloud(SvgDocument& svg, const ScatterPanel& panel, double reach) {
    const std::string name = shortened(panel.cloud.name);
    svg.begin_group("cloud", panel.cloud.name);
    svg.circle({panel.left + 6, cloud_top - 16}, 5.5, {.fill = panel.colour});
    svg.text({.at = {panel.left + 18, cloud_top - 16}, .text = name, .size = 13, .bold = true});
    draw_cloud_axes(svg, panel, reach);
    const std::size_t outside = draw_dots(svg, panel, reach);
    draw_cloud_figures(svg, panel, reach);
    std::string count = fmt::format("{} fixes", panel.cloud.errors.east.size());
    if (outside > 0) count += fmt::format(", {} outside", outside);
    svg.text({.at = {panel.left + cloud_size - 8, cloud_top + 14},
              .text = count,
              .size = 11,
              .fill = style::faint_ink,
              .anchor = "end",
              .halo = style::panel});
    svg.end_group();
}

std::string article_caption(const ScatterPanel& a, const ScatterPanel& b) {
    const std::string quantity = error_axis_name(a.quantity);
    if (!a.chosen || !b.chosen) return quantity + ": no percentage can be given";
    const auto percent = comparison_percent(*a.chosen, *b.chosen);
    if (!percent || percent->mean_near_zero)
        return quantity + ": no percentage can be given, the mean of the reference is near zero";
    return fmt::format("{}: {} (mean differs by {:.1f} %, std by {:.1f} %)", quantity, percent->text(),
                       percent->mean_part, percent->std_part);
}

std::string distance_caption(const ScatterPanel& a, const ScatterPanel& b) {
    const auto distance =
        distribution_distance(error_values(a.cloud.errors, a.quantity), error_values(b.cloud.errors, b.quantity));
    if (!distance) return {};
    return fmt::format("distance of the distributions: total variation {:.3f}, Kolmogorov–Smirnov {:.3f}",
                       distance->total_variation, distance->kolmogorov_smirnov);
}

void draw_scatter_heading(SvgDocument& svg, const ScatterPanel& a, const ScatterPanel& b) {
    svg.text({.at = {28, 32}, .text = "Position errors", .size = 17, .bold = true});
    style::note(svg, {28, 57}, article_caption(a, b), 12.5);
    style::note(svg, {28, 77}, distance_caption(a, b), 12.5);
    constexpr double right = scatter_plot_width - 28;
    const auto entry = [&](double y, const SvgStyle& line, const char* label) {
        svg.line({right - 196, y}, {right - 168, y}, line);
        style::note(svg, {right - 160, y}, label, 11.5);
    };
    entry(30, {.stroke = style::accent, .width = 1.6}, "mean and 95 % ellipse");
    entry(50, {.stroke = style::ink, .width = 1.6, .dash = "6 4"}, "95 % of the errors");
    entry(70, {.stroke = b.colour, .width = 1.4, .opacity = 0.8}, "outline: the other file");
}

}  // namespace

ErrorEllipse error_ellipse_95(std::span<const double> east, std::span<const double> north) {
    const auto e = sample_statistics(east);
    const auto n = sample_statistics(north);
    if (!e || !n || e->n < 2 || e->n != n->n) return {};
    double sum = 0;
    for (std::size_t i = 0; i < e->n; ++i)
        sum += (east[i] - e->mean) * (north[i] - n->mean);
    const double covariance = sum / static_cast<double>(e->n - 1);
    const double middle = (e->std * e->std + n->std * n->std) / 2;
    const double spread = std::hypot((n->std * n->std - e->std * e->std) / 2, covariance);
    const double k = std::sqrt(-2 * std::log(0.05));
    double azimuth = std::atan2(2 * covariance, n->std * n->std - e->std * e->std) / 2;
    if (azimuth < 0) azimuth += std::numbers::pi;
    return {k * std::sqrt(middle + spread), k * std::sqrt(std::max(0.0, middle - spread)), Angle::radians(azimuth)};
}

std::string scatter_plot_svg(const ScatterCloud& candidate, const ScatterCloud& reference, ErrorQuantity quantity) {
    const ScatterPanel a = scatter_panel(candidate, candidate_colour, 0, quantity);
    const ScatterPanel b = scatter_panel(reference, reference_colour, 1, quantity);
    const double reach = scatter_reach(a, b);
    SvgDocument svg = style::blank_sheet({scatter_plot_width, scatter_plot_height},
                                         fmt::format("Position errors: {}, {}", candidate.name, reference.name));
    draw_scatter_heading(svg, a, b);
    draw_cloud(svg, a, reach);
    draw_cloud(svg, b, reach);
    draw_error_histograms(svg, a, b, reach);
    return svg.str();
}

}  // namespace skyloop::inline study
