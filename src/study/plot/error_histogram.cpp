#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "detail/plot_style.hpp"
#include "detail/scatter_panel.hpp"

namespace skyloop::inline study {
namespace {

namespace style = plot_style;

bool has_sign(ErrorQuantity quantity) {
    return quantity == ErrorQuantity::east || quantity == ErrorQuantity::north || quantity == ErrorQuantity::up;
}

struct HistogramScale {
    double from = 0;  ///< metres
    double bin = 0;   ///< metres
    int bins = 0;
    double most = 0;  ///< the largest share of a bin in either cloud, percent

    [[nodiscard]] double to() const { return from + bin * bins; }
    [[nodiscard]] double pixels_per_percent() const { return histogram_height / (1.08 * most); }
    /// Where an error stands across a panel, 0 … 1; errors beyond an end stand at that end.
    [[nodiscard]] double place(double metres) const { return std::clamp((metres - from) / (to() - from), 0.0, 1.0); }
};

std::vector<double> bin_shares(const ScatterPanel& panel, const HistogramScale& scale) {
    const std::vector<double>& values = error_values(panel.cloud.errors, panel.quantity);
    std::vector<double> shares(static_cast<std::size_t>(scale.bins));
    for (const double v : values)
        if (v >= scale.from && v < scale.to())
            shares[std::min(static_cast<std::size_t>((v - scale.from) / scale.bin), shares.size() - 1)] += 1;
    for (double& share : shares)
        share *= 100 / static_cast<double>(std::max<std::size_t>(1, values.size()));
    return shares;
}

// Metres that all values but one in 500 of either cloud lie within.
double values_reach(const ScatterPanel& a, const ScatterPanel& b) {
    double reach = 0.01;
    for (const ScatterPanel* panel : {&a, &b}) {
        std::vector<double> sizes;
        for (const double v : error_values(panel->cloud.errors, panel->quantity))
            sizes.push_back(std::abs(v));
        reach = std::max(reach, all_but_wildest(std::move(sizes)));
    }
    return reach;
}

HistogramScale histogram_scale(const ScatterPanel& a, const ScatterPanel& b, double cloud_reach) {
    HistogramScale scale;
    const bool sign = has_sign(a.quantity);
    const double reach = a.quantity == ErrorQuantity::horizontal ? cloud_reach : 1.05 * values_reach(a, b);
    scale.bin = style::round_step(reach, sign ? 25 : 40);
    scale.bins = std::max(1, static_cast<int>(std::ceil(reach / scale.bin)));
    if (sign) {
        scale.from = -scale.bin * scale.bins;
        scale.bins *= 2;
    }
    for (const ScatterPanel* panel : {&a, &b})
        for (const double share : bin_shares(*panel, scale))
            scale.most = std::max(scale.most, share);
    scale.most = std::max(scale.most, 1e-3);
    return scale;
}

void draw_histogram_axes(SvgDocument& svg, const ScatterPanel& panel, const HistogramScale& scale) {
    const double bottom = histogram_top + histogram_height;
    const double step_y = style::round_step(1.08 * scale.most, 6);
    for (double share = 0; share <= 1.08 * scale.most; share += step_y) {
        const double y = bottom - share * scale.pixels_per_percent();
        svg.line({panel.left, y}, {panel.left + panel_width, y}, {.stroke = style::faint_grid});
        style::note(svg, {panel.left - 7, y}, scatter_tick(share, step_y), 11, "end");
    }
    const double extent = scale.to() - scale.from;
    const double step = style::round_step(extent, 8);
    for (double t = std::ceil(scale.from / step - 1e-9) * step; t <= scale.to() + extent * 1e-9; t += step)
        style::note(svg, {panel.left + scale.place(t) * panel_width, bottom + 13}, scatter_tick(t, step), 11, "middle");
    style::axis_name(svg, {panel.left + panel_width / 2, bottom + 32}, error_axis_name(panel.quantity) + ", m");
    style::axis_name(svg, {panel.left - 40, bottom - histogram_height / 2}, "fixes, %", -90);
}

// The shape of the other cloud's histogram, so that the eye need not cross the gap between the panels.
void draw_outline(SvgDocument& svg, double left, const ScatterPanel& other, const HistogramScale& scale) {
    const std::vector<double> shares = bin_shares(other, scale);
    const double width = panel_width / scale.bins;
    const double bottom = histogram_top + histogram_height;
    SvgPath outline;
    outline.move_to({left, bottom});
    for (std::size_t i = 0; i < shares.size(); ++i) {
        const double y = bottom - shares[i] * scale.pixels_per_percent();
        outline.line_to({left + static_cast<double>(i) * width, y});
        outline.line_to({left + static_cast<double>(i + 1) * width, y});
    }
    outline.line_to({left + panel_width, bottom});
    svg.path(outline, {.stroke = other.colour, .width = 1.4, .opacity = 0.8});
}

void draw_histogram(SvgDocument& svg, const ScatterPanel& panel, const ScatterPanel& other,
                    const HistogramScale& scale) {
    const double width = panel_width / scale.bins;
    const double bottom = histogram_top + histogram_height;
    svg.begin_group("histogram", error_axis_name(panel.quantity));
    draw_histogram_axes(svg, panel, scale);
    const std::vector<double> shares = bin_shares(panel, scale);
    for (std::size_t i = 0; i < shares.size(); ++i) {
        const double height = shares[i] * scale.pixels_per_percent();
        if (shares[i] > 0)
            svg.rectangle({panel.left + static_cast<double>(i) * width + 0.4, bottom - height}, {width - 0.8, height},
                          0, {.fill = panel.colour, .opacity = 0.62});
    }
    if (other.chosen) draw_outline(svg, panel.left, other, scale);
    svg.line({panel.left, bottom}, {panel.left + panel_width, bottom}, {.stroke = style::faint_ink});
    if (panel.chosen) {
        const double mean = panel.left + scale.place(panel.chosen->mean) * panel_width;
        svg.line({mean, bottom}, {mean, histogram_top - 2}, {.stroke = style::accent, .width = 1.8});
        if (!has_sign(panel.quantity)) {
            const double p95 = panel.left + scale.place(panel.chosen->p95) * panel_width;
            svg.line({p95, bottom}, {p95, histogram_top - 2}, {.stroke = style::ink, .width = 1.3, .dash = "6 4"});
        }
    }
    svg.end_group();
}

void draw_histogram_figures(SvgDocument& svg, const ScatterPanel& panel) {
    if (!panel.chosen) return;
    std::string text = fmt::format("mean {:.2f} m,  std {:.2f} m",
                                   std::abs(panel.chosen->mean) < 0.005 ? 0.0 : panel.chosen->mean, panel.chosen->std);
    if (!has_sign(panel.quantity))
        text += fmt::format(",  50 % {:.2f} m,  95 % {:.2f} m", panel.chosen->median, panel.chosen->p95);
    svg.text({.at = {panel.left, histogram_top - 16}, .text = text, .size = 12.5, .bold = true});
}

}  // namespace

double all_but_wildest(std::vector<double> sizes) {
    if (sizes.empty()) return 0;
    const std::size_t place = sizes.size() - 1 - sizes.size() / 500;
    std::nth_element(sizes.begin(), sizes.begin() + static_cast<std::ptrdiff_t>(place), sizes.end());
    return sizes[place];
}

std::string scatter_tick(double value, double step) {
    const int decimals = std::clamp(static_cast<int>(std::ceil(-std::log10(step) - 1e-9)), 0, 9);
    return fmt::format("{:.{}f}", std::abs(value) < step / 1000 ? 0.0 : value, decimals);
}

std::string error_axis_name(ErrorQuantity quantity) {
    return quantity == ErrorQuantity::spatial ? "3D error" : std::string(error_quantity_name(quantity)) + " error";
}

void draw_error_histograms(SvgDocument& svg, const ScatterPanel& a, const ScatterPanel& b, double reach) {
    const HistogramScale scale = histogram_scale(a, b, reach);
    for (const auto& [panel, other] : {std::pair(&a, &b), std::pair(&b, &a)}) {
        draw_histogram(svg, *panel, *other, scale);
        draw_histogram_figures(svg, *panel);
    }
}

}  // namespace skyloop::inline study
