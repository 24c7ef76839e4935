#include "detail/plan_view.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "detail/plot_style.hpp"

namespace skyloop {

PlanView::PlanView(const Eigen::AlignedBox2d& area, SvgPoint corner, SvgPoint size)
    : area_(area),
      corner_(corner),
      scale_(std::min(size.x / std::max(area.sizes().x(), 1e-3), size.y / std::max(area.sizes().y(), 1e-3))) {}

SvgPoint PlanView::at(const Eigen::Vector2d& place) const {
    return {corner_.x + (place.x() - area_.min().x()) * scale_, corner_.y + (area_.max().y() - place.y()) * scale_};
}

std::vector<Eigen::Vector2d> clipped_polygon(std::vector<Eigen::Vector2d> polygon, const Eigen::AlignedBox2d& box) {
    for (int side = 0; side < 4 && !polygon.empty(); ++side) {
        const int axis = side / 2;
        const double sign = side % 2 == 0 ? 1 : -1;
        const double edge = side % 2 == 0 ? box.max()[axis] : box.min()[axis];
        const auto beyond = [&](const Eigen::Vector2d& p) { return sign * (p[axis] - edge); };
        std::vector<Eigen::Vector2d> kept;
        for (std::size_t i = 0; i < polygon.size(); ++i) {
            const Eigen::Vector2d& a = polygon[i];
            const Eigen::Vector2d& b = polygon[(i + 1) % polygon.size()];
            if (beyond(a) <= 0) kept.push_back(a);
            if ((beyond(a) < 0 && beyond(b) > 0) || (beyond(a) > 0 && beyond(b) < 0))
                kept.emplace_back(a + (b - a) * (beyond(a) / (beyond(a) - beyond(b))));
        }
        polygon = std::move(kept);
    }
    return polygon;
}

bool clip_line(Eigen::Vector2d& from, Eigen::Vector2d& to, const Eigen::AlignedBox2d& box) {
    const Eigen::Vector2d along = to - from;
    double first = 0, last = 1;
    for (int axis = 0; axis < 2; ++axis) {
        const double low = box.min()[axis] - from[axis];
        const double high = box.max()[axis] - from[axis];
        if (along[axis] == 0) {
            if (low > 0 || high < 0) return false;
            continue;
        }
        first = std::max(first, std::min(low / along[axis], high / along[axis]));
        last = std::min(last, std::max(low / along[axis], high / along[axis]));
    }
    if (!(first <= last)) return false;
    const Eigen::Vector2d start = from;
    from = start + first * along;
    to = start + last * along;
    return true;
}

Eigen::AlignedBox2d ground_box(const UrbanScene& scene) {
    const SceneStatistics& s = scene.statistics();
    Eigen::AlignedBox2d box(Eigen::Vector2d(s.lowest.head<2>()), Eigen::Vector2d(s.highest.head<2>()));
    // A margin, so that outlines are seen whole and a single wall has a picture too.
    const double margin = std::max(1.0, 0.02 * box.sizes().maxCoeff());
    box.min().array() -= margin;
    box.max().array() += margin;
    // Very long and narrow scenes become a little wider: a picture has two directions.
    const double narrowest = 0.25 * box.sizes().maxCoeff();
    for (int axis = 0; axis < 2; ++axis) {
        const double missing = std::max(0.0, narrowest - box.sizes()[axis]) / 2;
        box.min()[axis] -= missing;
        box.max()[axis] += missing;
    }
    return box;
}

void draw_scale_and_north(SvgDocument& svg, const PlanView& view) {
    namespace style = plot_style;
    constexpr double widest_bar = 160;
    const double metres = style::round_step(widest_bar / view.pixels_per_metre(), 2);
    const double length = metres * view.pixels_per_metre();
    const SvgPoint low{view.corner().x + 14, view.corner().y + view.size().y - 14};
    const std::string text = metres >= 1000 ? fmt::format("{:g} km", metres / 1000) : fmt::format("{:g} m", metres);
    svg.begin_group("scale");
    svg.line({low.x, low.y}, {low.x + length, low.y}, {.stroke = style::paper, .width = 6, .opacity = 0.8});
    svg.line({low.x, low.y}, {low.x + length, low.y}, {.stroke = style::ink, .width = 2.5});
    for (const double x : {low.x, low.x + length})
        svg.line({x, low.y - 5}, {x, low.y + 5}, {.stroke = style::ink, .width = 1.5});
    svg.text(
        {.at = {low.x + length / 2, low.y - 11}, .text = text, .size = 11.5, .anchor = "middle", .halo = style::paper});
    svg.end_group();
    const SvgPoint top{view.corner().x + view.size().x - 22, view.corner().y + 14};
    svg.begin_group("north");
    svg.path(SvgPath()
                 .move_to({top.x, top.y})
                 .line_to({top.x + 7, top.y + 22})
                 .line_to({top.x, top.y + 17})
                 .line_to({top.x - 7, top.y + 22})
                 .close(),
             {.fill = style::ink, .stroke = style::paper, .width = 1.5});
    svg.text(
        {.at = {top.x, top.y + 32}, .text = "N", .size = 12, .anchor = "middle", .bold = true, .halo = style::paper});
    svg.end_group();
}

}  // namespace skyloop
