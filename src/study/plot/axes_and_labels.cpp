#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "detail/axes_and_labels.hpp"
#include "detail/plot_style.hpp"

namespace skyloop::inline study {
namespace {

namespace style = plot_style;

constexpr double tick_size = 11;

std::string short_number(double value) { return fmt::format("{:.4g}", value); }

}  // namespace

double AxisScale::place(double value) const { return std::clamp((value - from) / (to - from), 0.0, 1.0); }

std::vector<double> AxisScale::marks() const {
    std::vector<double> list;
    constexpr double most = 50;  // never reached; a bound all the same
    const double first = std::ceil(from / step - 1e-9);
    for (double i = 0; i < most && (first + i) * step <= to + step * 1e-9; ++i)
        list.push_back((first + i) * step);
    return list;
}

std::string AxisScale::label(double mark) const {
    constexpr double largest_plain = 1e6, smallest_plain = 1e-6;
    const double largest = std::max(std::abs(from), std::abs(to));
    if (std::abs(mark) < step / 1000) return "0";
    if (largest < largest_plain && step >= smallest_plain)
        return fmt::format("{:.{}f}", mark, std::clamp(static_cast<int>(std::ceil(-std::log10(step) - 1e-9)), 0, 9));
    const int digits = std::clamp(static_cast<int>(std::ceil(std::log10(largest / step) - 1e-9)) + 1, 1, 12);
    return fmt::format("{:.{}g}", mark, digits);
}

AxisScale axis_over(double low, double high, int most) {
    constexpr double equal = 1e-9;  // of the numbers' size: below, marks would not differ
    constexpr double zero_is_near = 0.35;
    const double size = std::max(std::abs(low), std::abs(high));
    if (!(high - low > equal * size)) {
        const double room = size > 0 ? 0.1 * size : 1;
        low -= room;
        high += room;
    } else if (low >= 0 && low < zero_is_near * high) {
        low = 0;
    }
    return {low, high, style::round_step(high - low, most, 0)};
}

ShownRange shown_range(std::span<const double> sorted) {
    if (sorted.empty()) return {};
    constexpr double far = 10;
    const double lower = sorted[sorted.size() / 4];
    const double upper = sorted[sorted.size() * 3 / 4];
    ShownRange range{sorted.front(), sorted.back(), 0, 0};
    if (!(upper > lower)) return range;
    const double least = lower - far * (upper - lower), most = upper + far * (upper - lower);
    const auto first = std::lower_bound(sorted.begin(), sorted.end(), least);
    const auto last = std::upper_bound(sorted.begin(), sorted.end(), most);
    range.below = static_cast<std::size_t>(first - sorted.begin());
    range.above = static_cast<std::size_t>(sorted.end() - last);
    return {*first, *(last - 1), range.below, range.above};
}

std::string outside_words(const ShownRange& range, std::span<const double> sorted) {
    const std::size_t count = range.below + range.above;
    if (count == 0) return {};
    std::string text = fmt::format("{} of {} beyond the axis", count, sorted.size());
    if (range.below > 0) text += ", down to " + short_number(sorted.front());
    if (range.above > 0) text += ", up to " + short_number(sorted.back());
    return text;
}

void draw_bottom_axis(SvgDocument& svg, const PanelArea& area, const AxisScale& axis, const std::string& name) {
    for (const double mark : axis.marks()) {
        const double x = area.x(axis, mark);
        svg.line({x, area.top}, {x, area.bottom()}, {.stroke = style::faint_grid});
        style::note(svg, {x, area.bottom() + 14}, axis.label(mark), tick_size, "middle");
    }
    if (!name.empty())
        style::axis_name(svg, {area.left + area.width / 2, area.bottom() + 33},
                         fitting_text(name, area.width + 40, 12));
}

void draw_left_axis(SvgDocument& svg, const PanelArea& area, const AxisScale& axis, const std::string& name) {
    double widest = 0;
    for (const double mark : axis.marks()) {
        const double y = area.y(axis, mark);
        svg.line({area.left, y}, {area.right(), y}, {.stroke = style::faint_grid});
        style::note(svg, {area.left - 7, y}, axis.label(mark), tick_size, "end");
        widest = std::max(widest, style::text_width(axis.label(mark), tick_size));
    }
    if (!name.empty())
        style::axis_name(svg, {area.left - widest - 19, area.top + area.height / 2},
                         fitting_text(name, area.height + 40, 12), -90);
}

std::string fitting_text(const std::string& text, double width, double size) {
    if (style::text_width(text, size) <= width) return text;
    std::string cut = text;
    while (!cut.empty() && style::text_width(cut, size) + size > width) {
        while (!cut.empty() && (static_cast<unsigned char>(cut.back()) & 0xC0U) == 0x80U)
            cut.pop_back();
        if (!cut.empty()) cut.pop_back();
    }
    return cut + "…";
}

namespace {

double overlap(const LabelBox& a, const LabelBox& b) {
    const double w = std::min(a.left + a.width, b.left + b.width) - std::max(a.left, b.left);
    const double h = std::min(a.top + a.height, b.top + b.height) - std::max(a.top, b.top);
    return w > 0 && h > 0 ? w * h : 0;
}

}  // namespace

void LabelPlacement::keep_inside(SvgPoint centre, double radius) {
    centre_ = centre;
    reach_ = radius;
}

double LabelPlacement::cost(const LabelBox& box) const {
    double sum = 0;
    for (const LabelBox& other : taken_)
        sum += overlap(box, other);
    if (reach_ > 0) {
        const SvgPoint c = box.centre();
        const double corner =
            std::hypot(std::abs(c.x - centre_.x) + box.width / 2, std::abs(c.y - centre_.y) + box.height / 2);
        sum += 20 * std::max(0.0, corner - reach_);
    }
    return sum;
}

LabelBox LabelPlacement::place(SvgPoint mark, double radius, SvgPoint size) {
    // Right and left read best, then above and below, then the corners; each also a little further off.
    constexpr std::array<SvgPoint, 8> sides{
        {{1, 0}, {-1, 0}, {0, -1}, {0, 1}, {0.8, -0.8}, {-0.8, -0.8}, {0.8, 0.8}, {-0.8, 0.8}}};
    constexpr double cost_of_next_side = 0.5;
    LabelBox best;
    double best_cost = std::numeric_limits<double>::max();
    double preference = 0;
    for (const double gap : {3.0, 9.0})
        for (const SvgPoint side : sides) {
            const SvgPoint c{mark.x + side.x * (radius + gap + size.x / 2),
                             mark.y + side.y * (radius + gap + size.y / 2)};
            const LabelBox box{c.x - size.x / 2, c.y - size.y / 2, size.x, size.y};
            const double total = cost(box) + preference;
            preference += cost_of_next_side;
            if (total >= best_cost) continue;
            best_cost = total;
            best = box;
        }
    taken_.push_back(best);
    return best;
}

}  // namespace skyloop::inline study
