#include "detail/ear_clipper.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace skyloop::inline world {

namespace {

/// Metres; beyond, products of coordinates lose what matters.
constexpr double most_extent = 1e9;
/// Rings with fewer points are searched point by point.
constexpr std::size_t least_hashed = 80;

}  // namespace

EarClipper::EarClipper(const Footprint& footprint) {
    if (!measure(footprint)) return;
    outer_ = link_ring(footprint.outer, 0, true);
    if (outer_ == none) return;
    std::vector<int> holes;
    auto first = static_cast<std::uint32_t>(footprint.outer.size());
    for (const std::vector<Eigen::Vector2d>& hole : footprint.holes) {
        const int start = link_ring(hole, first, false);
        if (start != none) holes.push_back(leftmost(start));
        first += static_cast<std::uint32_t>(hole.size());
    }
    join_holes(holes);
}

double EarClipper::doubled_area(const std::vector<Eigen::Vector2d>& ring) {
    double sum = 0;
    for (std::size_t i = 1; i + 1 < ring.size(); ++i)
        sum += turn_of(ring[0], ring[i], ring[i + 1]);
    return sum;
}

bool EarClipper::measure(const Footprint& footprint) {
    if (footprint.outer.size() < 3) return false;
    Eigen::Vector2d highest = footprint.outer.front();
    std::size_t points = footprint.outer.size();
    lowest_ = highest;
    for (const Eigen::Vector2d& point : footprint.outer) {
        if (!point.allFinite()) return false;
        lowest_ = lowest_.cwiseMin(point);
        highest = highest.cwiseMax(point);
    }
    for (const auto& hole : footprint.holes) {
        points += hole.size();
        for (const Eigen::Vector2d& point : hole)
            if (!point.allFinite()) return false;
    }
    const double extent = (highest - lowest_).maxCoeff();
    if (!(extent > 0 && extent < most_extent) || points > std::numeric_limits<int>::max() / 4) return false;
    code_scale_ = 32767 / extent;
    hashed_ = points >= least_hashed;
    budget_ = 50'000'000 + 1000 * static_cast<std::int64_t>(points);
    corners_.reserve(points + 2 * footprint.holes.size());
    return true;
}

int EarClipper::link_ring(const std::vector<Eigen::Vector2d>& ring, std::uint32_t first, bool anticlockwise) {
    const bool as_it_stands = (doubled_area(ring) > 0) == anticlockwise;
    int last = none;
    for (std::size_t i = 0; i < ring.size(); ++i) {
        const std::size_t k = as_it_stands ? i : ring.size() - 1 - i;
        last = append(ring[k] - lowest_, first + static_cast<std::uint32_t>(k), last);
    }
    if (last != none && at(last).next != last && same_place(last, at(last).next)) {
        const int next = at(last).next;
        remove(last);
        last = next;
    }
    return last;
}

int EarClipper::append(const Eigen::Vector2d& at_place, std::uint32_t point, int last) {
    const auto added = static_cast<int>(corners_.size());
    Corner corner;
    corner.at = at_place;
    corner.index = point;
    corner.previous = last == none ? added : last;
    corner.next = last == none ? added : at(last).next;
    corners_.push_back(corner);
    if (last != none) {
        at(at(last).next).previous = added;
        at(last).next = added;
    }
    return added;
}

void EarClipper::remove(int corner) {
    const Corner& c = at(corner);
    at(c.next).previous = c.previous;
    at(c.previous).next = c.next;
    if (c.earlier != none) at(c.earlier).later = c.later;
    if (c.later != none) at(c.later).earlier = c.earlier;
}

int EarClipper::without_idle_corners(int start, int end) {
    int corner = start;
    bool again = true;
    while (again || corner != end) {
        again = false;
        const int next = at(corner).next;
        if (next == corner) break;
        if (same_place(corner, next) || turn(at(corner).previous, corner, next) == 0) {
            remove(corner);
            corner = end = at(corner).previous;
            if (corner == at(corner).next) break;
            again = true;
        } else {
            corner = next;
        }
    }
    return end;
}

double EarClipper::turn(int a, int b, int c) const { return turn_of(at(a).at, at(b).at, at(c).at); }

int EarClipper::leftmost(int start) const {
    int best = start;
    for (int corner = at(start).next; corner != start; corner = at(corner).next) {
        const Eigen::Vector2d& p = at(corner).at;
        const Eigen::Vector2d& q = at(best).at;
        if (p.x() < q.x() || (p.x() == q.x() && p.y() < q.y())) best = corner;
    }
    return best;
}

void EarClipper::join_holes(std::vector<int>& holes) {
    std::sort(holes.begin(), holes.end(), [this](int a, int b) {
        if (at(a).at.x() != at(b).at.x()) return at(a).at.x() < at(b).at.x();
        if (at(a).at.y() != at(b).at.y()) return at(a).at.y() < at(b).at.y();
        return a < b;
    });
    for (const int hole : holes) {
        const int bridge = bridge_to(hole);
        if (bridge == none) continue;  // the hole lies outside, or the work was enough
        const int back = split(bridge, hole);
        without_idle_corners(back, at(back).next);
        outer_ = without_idle_corners(bridge, at(bridge).next);
    }
}

int EarClipper::bridge_to(int hole) {
    const Eigen::Vector2d from = at(hole).at;
    double crossing_x = -std::numeric_limits<double>::infinity();
    int found = none;
    int corner = outer_;
    do {
        const int next = at(corner).next;
        const Eigen::Vector2d& p = at(corner).at;
        const Eigen::Vector2d& q = at(next).at;
        if (p == from) return corner;
        if (q == from) return next;
        // Edges of an anticlockwise ring run downwards on the left of what they enclose.
        if (from.y() <= p.y() && from.y() >= q.y() && p.y() != q.y()) {
            const double x = p.x() + (from.y() - p.y()) * (q.x() - p.x()) / (q.y() - p.y());
            if (x <= from.x() && x > crossing_x) {
                crossing_x = x;
                found = p.x() < q.x() ? corner : next;
                if (x == from.x()) return found;
            }
        }
        corner = next;
        if (spent(1)) return none;
    } while (corner != outer_);
    return found == none ? none : better_bridge(found, hole, crossing_x);
}

int EarClipper::better_bridge(int found, int hole, double crossing_x) {
    const Eigen::Vector2d from = at(hole).at;
    const Eigen::Vector2d seen = at(found).at;
    std::array<Eigen::Vector2d, 3> triangle{from, seen, Eigen::Vector2d(crossing_x, from.y())};
    if (turn_of(triangle[0], triangle[1], triangle[2]) < 0) std::swap(triangle[1], triangle[2]);
    double least_slope = std::numeric_limits<double>::infinity();
    int best = found;
    int corner = found;
    do {
        const Eigen::Vector2d& p = at(corner).at;
        if (from.x() > p.x() && p.x() >= seen.x() && inside_triangle(triangle, p) && locally_inside(corner, hole)) {
            const double slope = std::abs(from.y() - p.y()) / (from.x() - p.x());
            const double best_x = at(best).at.x();
            const bool nearer = p.x() > best_x || (p.x() == best_x && sector_contains_sector(best, corner));
            if (slope < least_slope || (slope == least_slope && nearer)) {
                best = corner;
                least_slope = slope;
            }
        }
        corner = at(corner).next;
    } while (corner != found && !spent(1));
    return best;
}

bool EarClipper::sector_contains_sector(int outer, int inner) const {
    return turn(at(outer).previous, outer, at(inner).previous) > 0 && turn(at(inner).next, outer, at(outer).next) > 0;
}

int EarClipper::split(int a, int b) {
    const auto a2 = static_cast<int>(corners_.size()), b2 = a2 + 1;
    const int after_a = at(a).next, before_b = at(b).previous;
    Corner copy_a = at(a), copy_b = at(b);
    copy_a.earlier = copy_a.later = copy_b.earlier = copy_b.later = none;
    at(a).next = b;
    at(b).previous = a;
    copy_a.next = after_a;
    copy_a.previous = b2;
    copy_b.next = a2;
    copy_b.previous = before_b;
    corners_.push_back(copy_a);
    corners_.push_back(copy_b);
    at(after_a).previous = a2;
    at(before_b).next = b2;
    return b2;
}

std::vector<Eigen::Vector2d> EarClipper::bridged_ring() const {
    std::vector<Eigen::Vector2d> ring;
    if (outer_ == none) return ring;
    int corner = outer_;
    do {
        ring.emplace_back(at(corner).at + lowest_);
        corner = at(corner).next;
    } while (corner != outer_);
    return ring;
}

}  // namespace skyloop::inline world
