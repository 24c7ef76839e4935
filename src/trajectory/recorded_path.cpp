#include "skyloop/trajectory/recorded_path.hpp"

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <iterator>

#include "skyloop/geo/geodetic.hpp"

namespace skyloop {
namespace {

using Knot = RecordedPath::Knot;
using Coefficients = Eigen::Matrix<double, 3, 6>;

// The velocity of a parabola fitted to five neighbours (FEEDS.md 1.13.2, step 2).
Eigen::Vector3d velocity_of_parabola(std::span<const Knot> knots, std::size_t at) {
    const std::size_t width = std::min<std::size_t>(5, knots.size());
    const std::size_t first = std::min(at < 2 ? 0 : at - 2, knots.size() - width);
    if (width < 3) return (knots[1].position - knots[0].position) / (knots[1].time - knots[0].time);
    // In units of the window's span, so that the columns are alike in size.
    const double span = knots[first + width - 1].time - knots[first].time;
    Eigen::MatrixXd design(static_cast<Eigen::Index>(width), 3), places(static_cast<Eigen::Index>(width), 3);
    for (std::size_t i = 0; i < width; ++i) {
        const double t = (knots[first + i].time - knots[at].time) / span;
        const auto row = static_cast<Eigen::Index>(i);
        design.row(row) << 1, t, t * t;
        places.row(row) = (knots[first + i].position - knots[at].position).transpose();
    }
    const Eigen::MatrixXd fit = design.colPivHouseholderQr().solve(places);
    return fit.row(1).transpose() / span;
}

// Of the velocities, with unequal steps; one-sided at the ends (FEEDS.md 1.13.2, step 1).
void estimate_accelerations(std::span<Knot> knots) {
    const auto slope = [&](std::size_t i) -> Eigen::Vector3d {
        return (knots[i + 1].velocity - knots[i].velocity) / (knots[i + 1].time - knots[i].time);
    };
    const std::size_t last = knots.size() - 1;
    knots[0].acceleration = slope(0);
    knots[last].acceleration = slope(last - 1);
    for (std::size_t i = 1; i < last; ++i) {
        const double before = knots[i].time - knots[i - 1].time, after = knots[i + 1].time - knots[i].time;
        knots[i].acceleration = (after * slope(i - 1) + before * slope(i)) / (before + after);
    }
}

// One stretch without gaps: what the rows do not say is taken from their neighbours.
void fill_in(std::span<Knot> knots) {
    if (knots.size() < 2) {
        for (Knot& knot : knots)
            if (!knot.has_velocity) knot.velocity.setZero();
        for (Knot& knot : knots)
            knot.acceleration.setZero();
        return;
    }
    for (std::size_t i = 0; i < knots.size(); ++i)
        if (!knots[i].has_velocity) knots[i].velocity = velocity_of_parabola(knots, i);
    estimate_accelerations(knots);
}

// A point of the straight line between two places, at the height between theirs: on a long way the line itself dips
// below the ground.
Eigen::Vector3d lifted(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double part) {
    const double from_height = to_geodetic(Position<Ecef>(from)).height.above_ellipsoid.value();
    const double to_height = to_geodetic(Position<Ecef>(to)).height.above_ellipsoid.value();
    const Eigen::Vector3d chord = from + part * (to - from);
    if ((to - from).norm() > 1e7) return chord;  // through the Earth: no path that a vehicle took
    Geodetic place = to_geodetic(Position<Ecef>(chord));
    place.height.above_ellipsoid = Metres(from_height + part * (to_height - from_height));
    return to_ecef(place).vector();
}

// The knots inside a gap: from the velocity before it to a constant one, and from that to the one after it. The time of
// each change is at most 10 s and a third of the gap.
std::vector<Knot> bridge(const Knot& from, const Knot& to) {
    constexpr double longest_change_s = 10, longest_chord_m = 2000;
    const double span = to.time - from.time;
    const double change = std::min(longest_change_s, span / 3);
    // The ends of the changes and the velocity between them agree when the velocity changes evenly.
    const Eigen::Vector3d way = to.position - from.position;
    const Eigen::Vector3d mean = (way - (from.velocity + to.velocity) * (change / 2)) / (span - change);
    const Eigen::Vector3d left = from.position + (from.velocity + mean) * (change / 2);
    const Eigen::Vector3d right = to.position - (to.velocity + mean) * (change / 2);
    const double chords = std::min(1e4, std::ceil(std::max(1.0, (right - left).norm() / longest_chord_m)));
    std::vector<Knot> knots;
    for (int i = 0; i <= static_cast<int>(chords); ++i) {
        const double part = static_cast<double>(i) / chords;
        Knot knot;
        knot.time = from.time + change + part * (span - 2 * change);
        knot.position = lifted(left, right, part);
        knots.push_back(knot);
    }
    for (std::size_t i = 0; i < knots.size(); ++i) {
        const Knot& before = knots[i == 0 ? 0 : i - 1];
        const Knot& after = knots[std::min(i + 1, knots.size() - 1)];
        knots[i].velocity = (after.position - before.position) / (after.time - before.time);
        knots[i].acceleration.setZero();
    }
    return knots;
}

// Quintic Hermite in powers of u (FEEDS.md 1.13.3); p relative to the first knot.
Coefficients quintic(const Knot& from, const Knot& to, double h) {
    const Eigen::Vector3d p1 = to.position - from.position;
    const Eigen::Vector3d v0 = h * from.velocity, v1 = h * to.velocity;
    const Eigen::Vector3d a0 = h * h * from.acceleration, a1 = h * h * to.acceleration;
    Coefficients c;
    c.col(0).setZero();
    c.col(1) = v0;
    c.col(2) = a0 / 2;
    c.col(3) = 10 * p1 - 6 * v0 - 4 * v1 - 1.5 * a0 + 0.5 * a1;
    c.col(4) = -15 * p1 + 8 * v0 + 7 * v1 + 1.5 * a0 - a1;
    c.col(5) = 6 * p1 - 3 * v0 - 3 * v1 - 0.5 * a0 + 0.5 * a1;
    return c;
}

Coefficients cubic(const Knot& from, const Knot& to, double h) {
    const Eigen::Vector3d p1 = to.position - from.position;
    const Eigen::Vector3d v0 = h * from.velocity, v1 = h * to.velocity;
    Coefficients c = Coefficients::Zero();
    c.col(1) = v0;
    c.col(2) = 3 * p1 - 2 * v0 - v1;
    c.col(3) = -2 * p1 + v0 + v1;
    return c;
}

// Whether a quintic piece accelerates far more than its ends and its way ask for (FEEDS.md 1.13.3).
bool swings_out(const Coefficients& c, const Knot& from, const Knot& to, double h) {
    constexpr double least_mps2 = 0.1;  // noise of rows, not worth a step of the acceleration
    const Eigen::Vector3d needed = 2 * (to.position - from.position - h * from.velocity) / (h * h);
    const double allowed = 3 * std::max({from.acceleration.norm(), to.acceleration.norm(), needed.norm(), least_mps2});
    for (int i = 1; i < 8; ++i) {
        const double u = i / 8.0;
        const Eigen::Vector3d a =
            (2 * c.col(2) + 6 * u * c.col(3) + 12 * u * u * c.col(4) + 20 * u * u * u * c.col(5)) / (h * h);
        if (a.norm() > allowed) return true;
    }
    return false;
}

bool contradicts(const Knot& from, const Knot& to) {
    constexpr double least_mps = 1, part_of_speed = 0.2;
    const Eigen::Vector3d moved = (to.position - from.position) / (to.time - from.time);
    const Eigen::Vector3d told = (from.velocity + to.velocity) / 2;
    return (moved - told).norm() > least_mps + part_of_speed * told.norm();
}

std::vector<Knot> knots_of(const Track& track) {
    std::vector<Knot> knots;
    knots.reserve(track.points.size());
    for (const TrackRow& point : track.points) {
        Knot knot;
        knot.time = to_seconds(point.time - track.points.front().time).value();
        knot.position = point.position.vector();
        knot.has_velocity = point.velocity.has_value();
        knot.velocity = knot.has_velocity ? point.velocity->vector() : Eigen::Vector3d::Zero();
        knots.push_back(knot);
    }
    return knots;
}

}  // namespace

RecordedPath::RecordedPath(const Track& track, std::span<const TrackGap> gaps, GpsTime start) : start_(start) {
    std::vector<Knot> knots = knots_of(track);
    std::vector<std::size_t> ends;  // of stretches: the index after their last row
    for (std::size_t i = 1, next = 0; i < track.points.size() && next < gaps.size(); ++i)
        if (track.points[i].time == gaps[next].to) ends.push_back(i), ++next;
    ends.push_back(knots.size());
    std::size_t begin = 0;
    for (const std::size_t end : ends) {
        fill_in(std::span(knots).subspan(begin, end - begin));
        begin = end;
    }
    pieces_.reserve(knots.size());
    for (std::size_t i = 1, next = 0; i < knots.size(); ++i) {
        if (i != ends[next]) {
            if (contradicts(knots[i - 1], knots[i])) ++contradictions_;
            add_piece(knots[i - 1], knots[i]);
            continue;
        }
        ++next;
        Knot before = knots[i - 1];
        for (const Knot& knot : bridge(knots[i - 1], knots[i])) {
            add_piece(before, knot);
            before = knot;
        }
        add_piece(before, knots[i]);
    }
}

void RecordedPath::add_piece(const Knot& from, const Knot& to) {
    const double h = to.time - from.time;
    Piece piece{from.time, h, from.position, quintic(from, to, h)};
    if (swings_out(piece.coefficients, from, to, h)) {
        piece.coefficients = cubic(from, to, h);
        ++cubic_;
    }
    pieces_.push_back(piece);
}

TruthState RecordedPath::at(GpsTime time) const {
    const double t = difference(time, start_).value();
    const bool moves = t >= 0 && t <= duration().value();
    const double inside = std::clamp(t, 0.0, duration().value());
    auto piece = std::upper_bound(pieces_.begin(), pieces_.end(), inside,
                                  [](double value, const Piece& p) { return value < p.begins; });
    piece = piece == pieces_.begin() ? piece : std::prev(piece);
    const double u = std::min(1.0, (inside - piece->begins) / piece->length);
    Eigen::Matrix<double, 6, 1> powers, slopes;
    for (int i = 0; i < 6; ++i) {
        powers(i) = std::pow(u, i);
        slopes(i) = i == 0 ? 0 : i * std::pow(u, i - 1);
    }
    TruthState state;
    state.time = time;
    state.position = Position<Ecef>(piece->anchor + piece->coefficients * powers);
    state.geodetic = to_geodetic(state.position);
    if (moves) state.velocity = Velocity<Ecef>(piece->coefficients * slopes / piece->length);
    return state;
}

}  // namespace skyloop
