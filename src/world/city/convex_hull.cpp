#include "detail/convex_hull.hpp"

#include <algorithm>
#include <cmath>

namespace skyloop {

std::vector<Eigen::Vector2d> convex_hull(std::vector<Eigen::Vector2d> points) {
    const auto before = [](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
        return a.x() != b.x() ? a.x() < b.x() : a.y() < b.y();
    };
    std::erase_if(points, [](const Eigen::Vector2d& p) { return !p.allFinite(); });  // they have no order
    std::sort(points.begin(), points.end(), before);
    std::vector<Eigen::Vector2d> hull;
    for (int half = 0; half < 2; ++half) {
        const std::size_t start = hull.size();
        for (const Eigen::Vector2d& p : points) {
            while (hull.size() >= start + 2) {
                const Eigen::Vector2d u = hull.back() - hull[hull.size() - 2], v = p - hull.back();
                if (u.x() * v.y() - u.y() * v.x() > 0) break;
                hull.pop_back();
            }
            hull.push_back(p);
        }
        if (!hull.empty()) hull.pop_back();
        std::reverse(points.begin(), points.end());
    }
    return hull;
}

double hull_area(const std::vector<Eigen::Vector2d>& ring) {
    double sum = 0;
    for (std::size_t i = 1; i + 1 < ring.size(); ++i) {
        const Eigen::Vector2d a = ring[i] - ring[0], b = ring[i + 1] - ring[0];
        sum += a.x() * b.y() - a.y() * b.x();
    }
    return std::abs(sum) / 2;
}

}  // namespace skyloop
