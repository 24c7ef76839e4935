#include "detail/foliage_tree.hpp"

#include <algorithm>
#include <utility>

#include "detail/crown_stretches.hpp"

namespace skyloop {
namespace {

constexpr std::size_t most_in_leaf = 4;
constexpr double farthest_tree = 1e8;  // m, as far as corners of triangles may lie
constexpr double crown_margin = 1e-3;  // m: a ray along a side is inside for all that rounding does

}  // namespace

void FoliageTree::Box::extend(const Box& other) {
    lowest = lowest.cwiseMin(other.lowest);
    highest = highest.cwiseMax(other.highest);
}

bool FoliageTree::Box::passed_by(const SceneRay& ray, double reach) const {
    double first = 0, last = reach;
    for (int axis = 0; axis < 3; ++axis) {
        const double low = lowest[axis] - crown_margin - ray.origin[axis];
        const double high = highest[axis] + crown_margin - ray.origin[axis];
        if (ray.direction[axis] == 0) {
            if (low > 0 || high < 0) return false;
            continue;
        }
        const double a = low / ray.direction[axis], b = high / ray.direction[axis];
        first = std::max(first, std::min(a, b));
        last = std::min(last, std::max(a, b));
    }
    return first <= last;
}

FoliageTree::Box FoliageTree::box_around(const FoliageVolume& volume) {
    Box box;
    for (const Eigen::Vector2d& corner : volume.ring) {
        const Eigen::Vector3d low(corner.x(), corner.y(), volume.base), high(corner.x(), corner.y(), volume.top);
        box.extend({low, high});
    }
    return box;
}

FoliageTree::FoliageTree(std::vector<FoliageVolume> volumes) : volumes_(std::move(volumes)) {
    std::vector<Box> boxes;
    for (std::uint32_t i = 0; i < volumes_.size(); ++i) {
        boxes.push_back(box_around(volumes_[i]));
        // Written so that what is no number fails.
        const bool near =
            boxes.back().lowest.minCoeff() >= -farthest_tree && boxes.back().highest.maxCoeff() <= farthest_tree;
        if (volumes_[i].ring.size() >= 3 && volumes_[i].top > volumes_[i].base && near) order_.push_back(i);
    }
    if (!order_.empty()) add_nodes(order_, boxes);
}

void FoliageTree::add_nodes(std::span<std::uint32_t> order, const std::vector<Box>& boxes) {
    const std::size_t at = nodes_.size();
    Node node;
    for (const std::uint32_t i : order)
        node.box.extend(boxes[i]);
    if (order.size() <= most_in_leaf) {
        node.first = static_cast<std::uint32_t>(order.data() - order_.data());
        node.count = static_cast<std::uint32_t>(order.size());
    }
    nodes_.push_back(node);
    if (node.count == 0) {
        int axis = 0;
        (node.box.highest - node.box.lowest).maxCoeff(&axis);
        // Ties by the index, so that the tree is the same everywhere.
        const auto before = [&](std::uint32_t a, std::uint32_t b) {
            const double x = boxes[a].lowest[axis] + boxes[a].highest[axis];
            const double y = boxes[b].lowest[axis] + boxes[b].highest[axis];
            return x != y ? x < y : a < b;
        };
        const std::size_t half = order.size() / 2;
        std::nth_element(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(half), order.end(), before);
        add_nodes(order.first(half), boxes);
        add_nodes(order.subspan(half), boxes);
    }
    nodes_[at].end = static_cast<std::uint32_t>(nodes_.size());
}

double FoliageTree::length(const SceneRay& ray, double reach) const {
    CrownStretches crowns(ray, reach);
    for (std::size_t i = 0; i < nodes_.size();) {
        const Node& node = nodes_[i];
        if (!node.box.passed_by(ray, reach)) {
            i = node.end;
            continue;
        }
        for (std::uint32_t k = 0; k < node.count; ++k)
            crowns.add(volumes_[order_[node.first + k]]);
        ++i;
    }
    return crowns.metres();
}

}  // namespace skyloop
