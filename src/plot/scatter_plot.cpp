#include "skyloop/plot/scatter_plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include "plot_style.hpp"

namespace skyloop {
namespace {

namespace style = plot_style;

constexpr double panel_width = 400;
constexpr double panel_left = 68;
constexpr double panel_gap = 56;
constexpr double cloud_top = 104;
constexpr double cloud_size = 400;
constexpr double histogram_top = 580;
constexpr double histogram_height = 130;
constexpr std::string_view candidate_colour = "#1f5fbf";
constexpr std::string_view reference_colour = "#0a8f72";

// A cloud with what is drawn of it.
struct ScatterPanel {
    const ScatterCloud& cloud;
    std::string_view colour;
    double left = 0;
    std::optional<SampleStatistics> east, north, horizontal;
};

ScatterPanel scatter_panel(const ScatterCloud& cloud, std::string_view colour, int place) {
    return {cloud,
            colour,
            panel_left + place * (panel_width + panel_gap),
            sample_statistics(cloud.errors.east),
            sample_statistics(cloud.errors.north),
            sample_statistics(cloud.errors.horizontal)};
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
        if (largest.empty()) continue;
        const std::size_t place = largest.size() - 1 - largest.size() / 500;
        std::nth_element(largest.begin(), largest.begin() + static_cast<std::ptrdiff_t>(place), largest.end());
        reach = std::max(reach, largest[place]);
    }
    const double figures = std::max(figures_reach(a), figures_reach(b));
    return 1.05 * (figures < 2 * reach ? std::max(reach, figures) : reach);
}

std::string scatter_tick(double value, double step) {
    const int decimals = std::clamp(static_cast<int>(std::ceil(-std::log10(step) - 1e-9)), 0, 9);
    return fmt::format("{:.{}f}", std::abs(value) < step / 1000 ? 0.0 : value, decimals);
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
        svg.text({.at = {x, cloud_top + cloud_size + 13},
                  .text = scatter_tick(t, step),
                  .size = 11,
                  .fill = style::faint_ink,
                  .anchor = "middle"});
        svg.text({.at = {panel.left - 7, y},
                  .text = scatter_tick(t, step),
                  .size = 11,
                  .fill = style::faint_ink,
                  .anchor = "end"});
    }
    svg.text({.at = {centre.x, cloud_top + cloud_size + 32}, .text = "east error, m", .size = 12, .anchor = "middle"});
    svg.text({.at = {panel.left - 40, centre.y},
              .text = "north error, m",
              .size = 12,
              .anchor = "middle",
              .rotation_deg = -90});
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
    constexpr std::size_t longest_name = 46;
    if (name.size() <= longest_name) return name;
    std::size_t start = name.size() - longest_name;
    while (start < name.size() && (name[start] & 0xC0) == 0x80)
        ++start;
    return "…" + name.substr(start);
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

struct HistogramScale {
    double bin = 0;  ///< metres
    int bins = 0;
    double most = 0;  ///< the largest share of a bin in either cloud, percent
    [[nodiscard]] double pixels_per_percent() const { return histogram_height / (1.08 * most); }
};

std::vector<double> bin_shares(const ScatterPanel& panel, const HistogramScale& scale) {
    std::vector<double> shares(static_cast<std::size_t>(scale.bins));
    for (const double r : panel.cloud.errors.horizontal)
        if (r < scale.bin * scale.bins) shares[static_cast<std::size_t>(r / scale.bin)] += 1;
    for (double& share : shares)
        share *= 100 / static_cast<double>(std::max<std::size_t>(1, panel.cloud.errors.horizontal.size()));
    return shares;
}

HistogramScale histogram_scale(const ScatterPanel& a, const ScatterPanel& b, double reach) {
    HistogramScale scale;
    scale.bin = style::round_step(reach, 40);
    scale.bins = std::max(1, static_cast<int>(std::ceil(reach / scale.bin)));
    for (const ScatterPanel* panel : {&a, &b})
        for (const double share : bin_shares(*panel, scale))
            scale.most = std::max(scale.most, share);
    scale.most = std::max(scale.most, 1e-3);
    return scale;
}

void draw_histogram_axes(SvgDocument& svg, const ScatterPanel& panel, const HistogramScale& scale) {
    const double extent = scale.bin * scale.bins;
    const double bottom = histogram_top + histogram_height;
    const double step_y = style::round_step(1.08 * scale.most, 6);
    for (double share = 0; share <= 1.08 * scale.most; share += step_y) {
        const double y = bottom - share * scale.pixels_per_percent();
        svg.line({panel.left, y}, {panel.left + panel_width, y}, {.stroke = style::faint_grid});
        svg.text({.at = {panel.left - 7, y},
                  .text = scatter_tick(share, step_y),
                  .size = 11,
                  .fill = style::faint_ink,
                  .anchor = "end"});
    }
    const double step = style::round_step(extent, 8);
    for (double t = 0; t <= extent * (1 + 1e-9); t += step)
        svg.text({.at = {panel.left + t / extent * panel_width, bottom + 13},
                  .text = scatter_tick(t, step),
                  .size = 11,
                  .fill = style::faint_ink,
                  .anchor = "middle"});
    svg.text({.at = {panel.left + panel_width / 2, bottom + 32},
              .text = "horizontal error, m",
              .size = 12,
              .anchor = "middle"});
    svg.text({.at = {panel.left - 40, bottom - histogram_height / 2},
              .text = "fixes, %",
              .size = 12,
              .anchor = "middle",
              .rotation_deg = -90});
}

void draw_histogram(SvgDocument& svg, const ScatterPanel& panel, const HistogramScale& scale) {
    const double extent = scale.bin * scale.bins;
    const double width = panel_width / scale.bins;
    const double bottom = histogram_top + histogram_height;
    svg.begin_group("histogram", "horizontal radial error");
    draw_histogram_axes(svg, panel, scale);
    const std::vector<double> shares = bin_shares(panel, scale);
    for (std::size_t i = 0; i < shares.size(); ++i) {
        const double height = shares[i] * scale.pixels_per_percent();
        if (shares[i] > 0)
            svg.rectangle({panel.left + static_cast<double>(i) * width + 0.4, bottom - height}, {width - 0.8, height},
                          0, {.fill = panel.colour, .opacity = 0.75});
    }
    svg.line({panel.left, bottom}, {panel.left + panel_width, bottom}, {.stroke = style::faint_ink});
    if (panel.horizontal) {
        const auto place = [&](double metres) { return panel.left + std::min(metres / extent, 1.0) * panel_width; };
        const double mean = place(panel.horizontal->mean);
        const double p95 = place(panel.horizontal->p95);
        svg.line({mean, bottom}, {mean, histogram_top - 2}, {.stroke = style::accent, .width = 1.8});
        svg.line({p95, bottom}, {p95, histogram_top - 2}, {.stroke = style::ink, .width = 1.3, .dash = "6 4"});
    }
    svg.end_group();
}

void draw_horizontal_figures(SvgDocument& svg, const ScatterPanel& panel) {
    if (!panel.horizontal) return;
    svg.text({.at = {panel.left, histogram_top - 16},
              .text = fmt::format("mean {:.2f} m,  std {:.2f} m,  95 % {:.2f} m", panel.horizontal->mean,
                                  panel.horizontal->std, panel.horizontal->p95),
              .size = 12.5,
              .bold = true});
}

void draw_scatter_heading(SvgDocument& svg, const ScatterPanel& a, const ScatterPanel& b) {
    svg.text({.at = {28, 32}, .text = "Horizontal position errors", .size = 17, .bold = true});
    std::string text = "no percentage can be given";
    if (a.horizontal && b.horizontal)
        if (const auto percent = comparison_percent(*a.horizontal, *b.horizontal))
            text = fmt::format(
                "difference {:.1f} %, agreement {:.1f} % (mean differs by {:.1f} %, standard deviation by {:.1f} %)",
                percent->difference, 100 - percent->difference, percent->mean_part, percent->std_part);
    svg.text({.at = {28, 56}, .text = text, .size = 12.5, .fill = style::faint_ink});
    constexpr double right = scatter_plot_width - 28;
    const auto entry = [&](double y, std::string_view colour, std::string_view dash, const char* label) {
        svg.line({right - 190, y}, {right - 162, y}, {.stroke = colour, .width = 1.6, .dash = dash});
        svg.text({.at = {right - 154, y}, .text = label, .size = 11.5, .fill = style::faint_ink});
    };
    entry(28, style::accent, "", "mean and 95 % ellipse");
    entry(48, style::ink, "6 4", "95 % of the errors");
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

std::string scatter_plot_svg(const ScatterCloud& candidate, const ScatterCloud& reference) {
    const ScatterPanel a = scatter_panel(candidate, candidate_colour, 0);
    const ScatterPanel b = scatter_panel(reference, reference_colour, 1);
    const double reach = scatter_reach(a, b);
    const HistogramScale histogram = histogram_scale(a, b, reach);
    SvgDocument svg(scatter_plot_width, scatter_plot_height,
                    "Horizontal position errors: " + candidate.name + ", " + reference.name);
    style::draw_sheet(svg, {scatter_plot_width, scatter_plot_height});
    draw_scatter_heading(svg, a, b);
    for (const ScatterPanel* panel : {&a, &b}) {
        draw_cloud(svg, *panel, reach);
        draw_histogram(svg, *panel, histogram);
        draw_horizontal_figures(svg, *panel);
    }
    return svg.str();
}

}  // namespace skyloop
