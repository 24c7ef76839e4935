// The cutting of EarClipper; its rings and bridges are in ear_clipper.cpp.
#include <algorithm>
#include <cmath>

#include "detail/ear_clipper.hpp"

namespace skyloop::inline world {

namespace {

/// Square metres below which a triangle is none.
constexpr double least_area = 1e-9;

/// Spreads 15 bits to every second one.
std::uint32_t spread_bits(std::uint32_t bits) {
    bits = (bits | (bits << 8U)) & 0x00FF00FFU;
    bits = (bits | (bits << 4U)) & 0x0F0F0F0FU;
    bits = (bits | (bits << 2U)) & 0x33333333U;
    return (bits | (bits << 1U)) & 0x55555555U;
}

int sign_of(double value) { return value > 0 ? 1 : value < 0 ? -1 : 0; }

/// For three points on one line.
bool between(const Eigen::Vector2d& a, const Eigen::Vector2d& p, const Eigen::Vector2d& b) {
    return p.x() <= std::max(a.x(), b.x()) && p.x() >= std::min(a.x(), b.x()) && p.y() <= std::max(a.y(), b.y()) &&
           p.y() >= std::min(a.y(), b.y());
}

}  // namespace

std::vector<std::array<std::uint32_t, 3>> EarClipper::triangles() {
    if (outer_ != none) tasks_.push_back({outer_, 0});
    while (!tasks_.empty() && budget_ > 0) {
        const Task task = tasks_.back();
        tasks_.pop_back();
        clip(task);
    }
    return std::move(triangles_);
}

void EarClipper::clip(Task task) {
    if (task.attempt == 0 && hashed_) order_by_code(task.start);
    int ear = task.start, stop = task.start;
    while (at(ear).previous != at(ear).next) {
        const int previous = at(ear).previous, next = at(ear).next;
        if (budget_ <= 0) return;
        if (is_ear(ear)) {
            emit(previous, ear, next);
            remove(ear);
            // Skipping one makes fewer slivers.
            ear = stop = at(next).next;
            continue;
        }
        ear = next;
        if (ear != stop) continue;
        if (task.attempt == 0)
            tasks_.push_back({without_idle_corners(ear), 1});
        else if (task.attempt == 1)
            tasks_.push_back({without_local_crossings(without_idle_corners(ear)), 2});
        else
            split_and_clip(ear);
        return;
    }
}

void EarClipper::emit(int a, int b, int c) {
    if (turn(a, b, c) > 2 * least_area) triangles_.push_back({at(a).index, at(b).index, at(c).index});
}

bool EarClipper::spoils(int corner, int ear) const {
    const int a = at(ear).previous, c = at(ear).next;
    if (corner == a || corner == c || same_place(corner, a)) return false;
    return inside_triangle({at(a).at, at(ear).at, at(c).at}, at(corner).at) &&
           turn(at(corner).previous, corner, at(corner).next) <= 0;
}

bool EarClipper::is_ear(int ear) {
    const int a = at(ear).previous, c = at(ear).next;
    if (turn(a, ear, c) <= 0) return false;
    if (hashed_) {
        const Eigen::Vector2d low = at(a).at.cwiseMin(at(ear).at).cwiseMin(at(c).at);
        const Eigen::Vector2d high = at(a).at.cwiseMax(at(ear).at).cwiseMax(at(c).at);
        return is_ear_by_code(ear, {code_of(low), code_of(high)});
    }
    std::int64_t steps = 0;
    int corner = at(c).next;
    for (; corner != a; corner = at(corner).next, ++steps)
        if (spoils(corner, ear)) break;
    return !spent(steps) && corner == a;
}

bool EarClipper::is_ear_by_code(int ear, const std::array<std::uint32_t, 2>& codes) {
    std::int64_t steps = 0;
    bool spoiled = false;
    for (int corner = at(ear).earlier; !spoiled && corner != none && at(corner).code >= codes[0]; ++steps) {
        spoiled = spoils(corner, ear);
        corner = at(corner).earlier;
    }
    for (int corner = at(ear).later; !spoiled && corner != none && at(corner).code <= codes[1]; ++steps) {
        spoiled = spoils(corner, ear);
        corner = at(corner).later;
    }
    return !spent(steps) && !spoiled;
}

int EarClipper::without_local_crossings(int start) {
    int corner = start;
    do {
        const int a = at(corner).previous, next = at(corner).next, b = at(next).next;
        if (!same_place(a, b) && segments_meet({a, corner}, {next, b}) && locally_inside(a, b) &&
            locally_inside(b, a)) {
            emit(a, corner, b);
            remove(corner);
            remove(next);
            corner = start = b;
        }
        corner = at(corner).next;
    } while (corner != start && !spent(1));
    return without_idle_corners(corner);
}

void EarClipper::split_and_clip(int start) {
    int a = start;
    do {
        for (int b = at(at(a).next).next; b != at(a).previous; b = at(b).next) {
            if (spent(1)) return;
            if (at(a).index == at(b).index || !valid_diagonal(a, b)) continue;
            int other = split(a, b);
            a = without_idle_corners(a, at(a).next);
            other = without_idle_corners(other, at(other).next);
            tasks_.push_back({other, 0});
            tasks_.push_back({a, 0});
            return;
        }
        a = at(a).next;
    } while (a != start);
}

bool EarClipper::segments_meet(std::pair<int, int> first, std::pair<int, int> second) const {
    const auto [p1, q1] = first;
    const auto [p2, q2] = second;
    const int o1 = sign_of(turn(p1, q1, p2)), o2 = sign_of(turn(p1, q1, q2));
    const int o3 = sign_of(turn(p2, q2, p1)), o4 = sign_of(turn(p2, q2, q1));
    if (o1 != o2 && o3 != o4) return true;
    return (o1 == 0 && between(at(p1).at, at(p2).at, at(q1).at)) ||
           (o2 == 0 && between(at(p1).at, at(q2).at, at(q1).at)) ||
           (o3 == 0 && between(at(p2).at, at(p1).at, at(q2).at)) ||
           (o4 == 0 && between(at(p2).at, at(q1).at, at(q2).at));
}

bool EarClipper::locally_inside(int a, int b) const {
    const int previous = at(a).previous, next = at(a).next;
    return turn(previous, a, next) > 0 ? turn(a, b, next) <= 0 && turn(a, previous, b) <= 0
                                       : turn(a, b, previous) > 0 || turn(a, next, b) > 0;
}

bool EarClipper::middle_inside(int a, int b) {
    const Eigen::Vector2d middle = (at(a).at + at(b).at) / 2;
    bool inside = false;
    int corner = a;
    std::int64_t steps = 0;
    do {
        const Eigen::Vector2d& p = at(corner).at;
        const Eigen::Vector2d& q = at(at(corner).next).at;
        if ((p.y() > middle.y()) != (q.y() > middle.y()) &&
            middle.x() < (q.x() - p.x()) * (middle.y() - p.y()) / (q.y() - p.y()) + p.x())
            inside = !inside;
        corner = at(corner).next;
        ++steps;
    } while (corner != a);
    return !spent(steps) && inside;
}

bool EarClipper::crosses_ring(int a, int b) {
    int corner = a;
    do {
        const int next = at(corner).next;
        const auto i = at(corner).index, j = at(next).index;
        if (i != at(a).index && j != at(a).index && i != at(b).index && j != at(b).index &&
            segments_meet({corner, next}, {a, b}))
            return true;
        corner = next;
    } while (corner != a && !spent(1));
    return false;
}

bool EarClipper::valid_diagonal(int a, int b) {
    if (at(at(a).next).index == at(b).index || at(at(a).previous).index == at(b).index) return false;
    const bool zero_length =
        same_place(a, b) && turn(at(a).previous, a, at(a).next) > 0 && turn(at(b).previous, b, at(b).next) > 0;
    const bool seen = locally_inside(a, b) && locally_inside(b, a) &&
                      (turn(at(a).previous, a, at(b).previous) != 0 || turn(a, at(b).previous, b) != 0);
    return zero_length || (seen && !crosses_ring(a, b) && middle_inside(a, b));
}

std::uint32_t EarClipper::code_of(const Eigen::Vector2d& place) const {
    const auto cell = [this](double value) {
        return spread_bits(static_cast<std::uint32_t>(std::clamp(value * code_scale_, 0.0, 32767.0)));
    };
    return cell(place.x()) | (cell(place.y()) << 1U);
}

void EarClipper::order_by_code(int start) {
    std::vector<int> order;
    int corner = start;
    do {
        at(corner).code = code_of(at(corner).at);
        order.push_back(corner);
        corner = at(corner).next;
    } while (corner != start);
    std::sort(order.begin(), order.end(),
              [this](int a, int b) { return at(a).code != at(b).code ? at(a).code < at(b).code : a < b; });
    for (std::size_t i = 0; i < order.size(); ++i) {
        at(order[i]).earlier = i > 0 ? order[i - 1] : none;
        at(order[i]).later = i + 1 < order.size() ? order[i + 1] : none;
    }
}

}  // namespace skyloop::inline world
