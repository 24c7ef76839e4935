// Curves in a plane, and the integrals over short intervals that their lengths are.
#include "motion/trajectory/planar_curve.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace skyloop::inline motion {

// Of degree 9: Abramowitz and Stegun, Handbook of Mathematical Functions, table 25.4, n = 5.
template <class Function>
auto integral_over(double length, const Function& function) {
    constexpr std::array<double, 2> nodes{0.538469310105683, 0.906179845938664};
    constexpr std::array<double, 3> weights{0.568888888888889, 0.478628670499366, 0.236926885056189};
    const double half = length / 2;
    auto sum = function(half);
    sum *= weights[0];
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        auto pair = function(half * (1 - nodes[i]));
        pair += function(half * (1 + nodes[i]));
        pair *= weights[i + 1];
        sum += pair;
    }
    sum *= half;
    return sum;
}

namespace {

constexpr double full_turn = 2 * std::numbers::pi;

Eigen::Vector2d along_heading(double heading) { return {std::sin(heading), std::cos(heading)}; }

// The point that lies `way` after another one when the curvature changes evenly.
CurvePoint further(const CurvePoint& from, double sharpness, double way) {
    const auto heading = [&](double s) { return from.heading + s * (from.curvature + s * sharpness / 2); };
    CurvePoint point;
    point.position =
        from.position + integral_over(way, [&](double s) -> Eigen::Vector2d { return along_heading(heading(s)); });
    point.heading = heading(way);
    point.curvature = from.curvature + way * sharpness;
    return point;
}

// Of a turn that is too small for its arc: the curvature of its middle.
double lower_peak(const TurnShape& turn) { return std::sqrt(std::abs(turn.angle) / (turn.radius * turn.ramp)); }
bool has_arc(const TurnShape& turn) { return std::abs(turn.angle) >= turn.ramp / turn.radius; }

constexpr std::size_t lemniscate_steps = 512;
constexpr double lemniscate_step = full_turn / lemniscate_steps;
constexpr double at_the_crossing = -std::numbers::pi / 2;

// dτ/ds of a lemniscate with a = 1, upside down.
double lemniscate_slope(double tau) { return 1 / std::sqrt(1 + std::sin(tau) * std::sin(tau)); }

}  // namespace

void ClothoidCurve::run(double length, double to_curvature) {
    constexpr double widest = 0.2;  // rad in a piece
    if (!(length > 0)) return;
    const double sharpness = (to_curvature - end_.curvature) / length;
    const double most = std::max(std::abs(end_.curvature), std::abs(to_curvature)) * length;
    const double parts = std::max(1.0, std::ceil(most / widest));
    const double part = length / parts;
    for (int i = 0; i < static_cast<int>(parts); ++i) {
        pieces_.push_back({length_ + i * part, end_, sharpness});
        end_ = further(end_, sharpness, part);
    }
    end_.curvature = to_curvature;
    length_ = pieces_.back().begins + part;
}

CurvePoint ClothoidCurve::at(double way) const {
    if (pieces_.empty()) return end_;
    if (closed_) {
        way = std::fmod(way, length_);
        if (way < 0) way += length_;
    }
    way = std::clamp(way, 0.0, length_);
    const auto after = std::upper_bound(pieces_.begin(), pieces_.end(), way,
                                        [](double value, const Piece& piece) { return value < piece.begins; });
    const Piece& piece = after == pieces_.begin() ? *after : *std::prev(after);
    return further(piece.from, piece.sharpness, way - piece.begins);
}

void add_turn(ClothoidCurve& curve, const TurnShape& turn) {
    const double sign = turn.angle < 0 ? -1 : 1;
    if (has_arc(turn)) {
        curve.run(turn.ramp, sign / turn.radius);
        curve.run(std::abs(turn.angle) * turn.radius - turn.ramp, sign / turn.radius);
        curve.run(turn.ramp, 0);
        return;
    }
    const double peak = lower_peak(turn), ramp = peak * turn.radius * turn.ramp;
    curve.run(ramp, sign * peak);
    curve.run(ramp, 0);
}

double turn_length(const TurnShape& turn) {
    if (has_arc(turn)) return std::abs(turn.angle) * turn.radius + turn.ramp;
    return 2 * lower_peak(turn) * turn.radius * turn.ramp;
}

double tangent_length(const TurnShape& turn) {
    const bool arc = has_arc(turn);
    const double half = std::abs(turn.angle) / 2, radius = arc ? turn.radius : 1 / lower_peak(turn);
    const double ramp = arc ? turn.ramp : half * 2 * radius;
    ClothoidCurve curve({});
    curve.run(ramp, 1 / radius);
    const double ahead = curve.end().position.y(), aside = curve.end().position.x(), turned = curve.end().heading;
    // The circle of the arc is moved inward and onward from the one that would touch the straights.
    const double inward = aside - radius * (1 - std::cos(turned)), onward = ahead - radius * std::sin(turned);
    return (radius + inward) * std::tan(half) + onward;
}

CurvePoint CircleCurve::at(double way) const {
    const double sign = shape_.anticlockwise ? -1 : 1;
    const double azimuth = shape_.start_azimuth + sign * std::fmod(way, length()) / shape_.radius;
    CurvePoint point;
    point.position = shape_.centre + shape_.radius * along_heading(azimuth);
    point.heading = azimuth + sign * std::numbers::pi / 2;
    point.curvature = sign / shape_.radius;
    return point;
}

double CircleCurve::length() const { return full_turn * shape_.radius; }

LemniscateCurve::LemniscateCurve(const Shape& shape) : shape_(shape), ways_{0} {
    for (std::size_t i = 0; i < lemniscate_steps; ++i) {
        const double tau = at_the_crossing + static_cast<double>(i) * lemniscate_step;
        ways_.push_back(ways_.back() + shape_.half_length * integral_over(lemniscate_step, [&](double u) {
                                           return lemniscate_slope(tau + u);
                                       }));
    }
}

CurvePoint LemniscateCurve::at(double way) const {
    way = std::fmod(way, length());
    if (way < 0) way += length();
    const auto after = std::upper_bound(ways_.begin() + 1, ways_.end() - 1, way);
    const std::size_t index = static_cast<std::size_t>(after - ways_.begin()) - 1;
    const double begins = at_the_crossing + static_cast<double>(index) * lemniscate_step;
    const double rest = (way - ways_[index]) / shape_.half_length;
    double inside = rest / lemniscate_slope(begins);
    for (int i = 0; i < 4; ++i) {  // Newton: the slope hardly changes within a step
        const double reached = integral_over(inside, [&](double u) { return lemniscate_slope(begins + u); });
        inside += (rest - reached) / lemniscate_slope(begins + inside);
    }
    const double tau = begins + inside, s = std::sin(tau), c = std::cos(tau), whole = 1 + s * s;
    const Eigen::Vector2d ahead = along_heading(shape_.heading), right(ahead.y(), -ahead.x());
    const double x = c / whole, y = s * c / whole;
    const double dx = -s * (3 - s * s) / (whole * whole), dy = (1 - 3 * s * s) / (whole * whole);
    CurvePoint point;
    point.position = shape_.centre + shape_.half_length * (x * ahead + y * right);
    point.heading = shape_.heading + std::atan2(dy, dx);
    point.curvature = 3 * c / (shape_.half_length * std::sqrt(whole));
    return point;
}

}  // namespace skyloop::inline motion
