#include "detail/label_placement.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace skyloop {
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

}  // namespace skyloop
