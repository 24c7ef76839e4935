// The crowns of trees that a ray meets, and its stretches in them.

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "detail/foliage_tree.hpp"
#include "world/scene/urban_scene.hpp"

namespace skyloop::inline world {

/// Gathered volume by volume. Woods overlap, where one is drawn within another or two files hold the same one: a metre
/// in several crowns is one metre.
class CrownStretches {
public:
    /// @param length metres of the ray that count
    CrownStretches(const SceneRay& ray, double length) : ray_(ray), length_(length) {}

    void add(const FoliageVolume& volume);
    /// Metres in any of the volumes, whatever their order to the last bit.
    [[nodiscard]] double metres();

private:
    struct Stretch {
        double begin, end;  ///< m along the ray
        auto operator<=>(const Stretch&) const = default;
    };
    const SceneRay& ray_;
    double length_;
    std::vector<Stretch> stretches_;
};

namespace {

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

/// Where along a ray its shadow on the ground crosses a ring, rising, of those between `first` and `last`.
std::vector<double> crossings(const FoliageVolume& volume, const SceneRay& ray, double first, double last) {
    const Eigen::Vector2d origin = ray.origin.head<2>(), direction = ray.direction.head<2>();
    std::vector<double> found;
    for (std::size_t i = 0, j = volume.ring.size() - 1; i < volume.ring.size(); j = i++) {
        const Eigen::Vector2d edge = volume.ring[i] - volume.ring[j], from = volume.ring[j] - origin;
        const double turn = cross(direction, edge);
        if (turn == 0) continue;
        const double along = cross(from, edge) / turn, share = cross(from, direction) / turn;
        if (share >= 0 && share <= 1 && along > first && along < last) found.push_back(along);
    }
    std::ranges::sort(found);
    return found;
}

}  // namespace

// Between two neighbouring crossings all points are inside the prism or none; which, the middle tells, so that a ray
// through a corner counts as it should.
void CrownStretches::add(const FoliageVolume& volume) {
    if (volume.ring.size() < 3 || !(volume.top > volume.base)) return;
    double first = 0, last = length_;
    const double up = ray_.direction.z();
    if (up != 0) {
        const double base = (volume.base - ray_.origin.z()) / up, top = (volume.top - ray_.origin.z()) / up;
        first = std::max(first, std::min(base, top));
        last = std::min(last, std::max(base, top));
    } else if (ray_.origin.z() < volume.base || ray_.origin.z() > volume.top) {
        return;
    }
    if (!(last > first)) return;
    std::vector<double> ends = crossings(volume, ray_, first, last);
    if (std::isfinite(last)) ends.push_back(last);
    for (double begin = first; const double end : ends) {
        const Eigen::Vector3d middle = ray_.origin + (begin + end) / 2 * ray_.direction;
        if (inside_ring(volume.ring, middle.head<2>())) stretches_.push_back({begin, end});
        begin = end;
    }
}

double CrownStretches::metres() {
    std::ranges::sort(stretches_);
    double sum = 0, covered = 0;
    for (const auto& [begin, end] : stretches_) {
        sum += std::max(0.0, end - std::max(begin, covered));
        covered = std::max(covered, end);
    }
    return sum;
}

double foliage_length(std::span<const FoliageVolume> foliage, const SceneRay& ray, double length) {
    CrownStretches crowns(ray, length);
    for (const FoliageVolume& volume : foliage)
        crowns.add(volume);
    return crowns.metres();
}

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

}  // namespace skyloop::inline world
