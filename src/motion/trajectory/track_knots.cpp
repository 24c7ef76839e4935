#include "detail/track_knots.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>

#include "base/geo/geodetic.hpp"
#include "detail/least_squares.hpp"

namespace skyloop::inline motion {
namespace {

using Knots = std::span<const TrackKnot>;

// The rows next to one, at most five, and which of them it is.
struct Window {
    std::size_t first = 0, width = 0, at = 0;
    double span = 0;  // s
};

Window window_around(Knots knots, std::size_t at) {
    const std::size_t width = std::min<std::size_t>(5, knots.size());
    const std::size_t first = std::min(at < 2 ? 0 : at - 2, knots.size() - width);
    return {first, width, at, knots[first + width - 1].time - knots[first].time};
}

bool alike_in_step(Knots knots, const Window& window) {
    double shortest = window.span, longest = 0;
    for (std::size_t i = window.first + 1; i < window.first + window.width; ++i) {
        shortest = std::min(shortest, knots[i].time - knots[i - 1].time);
        longest = std::max(longest, knots[i].time - knots[i - 1].time);
    }
    constexpr double most_unlike = 3;
    return longest <= most_unlike * shortest;
}

// A polynomial through the places of a window, or near them, at its row.
struct LocalFit {
    Eigen::Vector3d velocity = Eigen::Vector3d::Zero(), acceleration = Eigen::Vector3d::Zero();
    double residual = 0;  // m, root of the mean square
};

LocalFit local_fit(Knots knots, const Window& window, int degree) {
    const auto rows = static_cast<Eigen::Index>(window.width);
    // In units of the window's span, so that the columns are alike in size.
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 5, 5> design(rows, degree + 1);
    Eigen::Matrix<double, Eigen::Dynamic, 3, 0, 5, 3> places(rows, 3);
    for (Eigen::Index i = 0; i < rows; ++i) {
        const TrackKnot& point = knots[window.first + static_cast<std::size_t>(i)];
        const double t = (point.time - knots[window.at].time) / window.span;
        double power = 1;
        for (int k = 0; k <= degree; ++k, power *= t)
            design(i, k) = power;
        places.row(i) = (point.position - knots[window.at].position).transpose();
    }
    const Eigen::Matrix<double, Eigen::Dynamic, 3, 0, 5, 3> fit = least_squares(design, places);
    LocalFit result;
    result.velocity = fit.row(1).transpose() / window.span;
    result.acceleration = 2 * fit.row(2).transpose() / (window.span * window.span);
    result.residual = (design * fit - places).norm() / std::sqrt(static_cast<double>(rows));
    return result;
}

// How much of a finer estimate is taken that a number of this size speaks for; 1/2 at `even`.
double share(double size, double even) { return size * size / (size * size + even * even); }

// By the parabola of FEEDS.md 1.13.2, step 2, which evens out rows that are noisy by centimetres; where the rows turn
// more than a parabola can, by the polynomial of degree four through them, whose error is of the fourth order.
LocalFit motion_by_places(Knots knots, std::size_t at) {
    constexpr double even_residual_m = 0.02;
    if (knots.size() == 2) {
        LocalFit straight;
        straight.velocity = (knots[1].position - knots[0].position) / (knots[1].time - knots[0].time);
        return straight;
    }
    const Window window = window_around(knots, at);
    LocalFit fit = local_fit(knots, window, 2);
    if (window.width < 5 || !alike_in_step(knots, window)) return fit;
    const LocalFit fine = local_fit(knots, window, 4);
    const double part = share(fit.residual, even_residual_m);
    fit.velocity += part * (fine.velocity - fit.velocity);
    fit.acceleration += part * (fine.acceleration - fit.acceleration);
    return fit;
}

Eigen::Vector3d mean_acceleration(const TrackKnot& from, const TrackKnot& to) {
    return (to.velocity - from.velocity) / (to.time - from.time);
}

// Of the polynomial that has the places and velocities of three neighbours.
Eigen::Vector3d acceleration_by_both(const TrackKnot& before, const TrackKnot& here, const TrackKnot& after) {
    // p(t) − p(0) − v(0) t = t² (c0 + c1 t + c2 t² + c3 t³), and its slope, at both neighbours; t in units of the span.
    const double span = after.time - before.time;
    Eigen::Matrix4d powers;
    Eigen::Matrix<double, 4, 3> values;
    const auto fill = [&](Eigen::Index row, const TrackKnot& there) {
        const double t = (there.time - here.time) / span;
        powers.row(row) << t * t, t * t * t, t * t * t * t, t * t * t * t * t;
        powers.row(row + 1) << 2 * t, 3 * t * t, 4 * t * t * t, 5 * t * t * t * t;
        values.row(row) = (there.position - here.position - here.velocity * (there.time - here.time)).transpose();
        values.row(row + 1) = span * (there.velocity - here.velocity).transpose();
    };
    fill(0, before);
    fill(2, after);
    const Eigen::Matrix<double, 4, 3> solved = powers.partialPivLu().solve(values);
    return 2 * solved.row(0).transpose() / (span * span);
}

// By the velocities of the neighbours (FEEDS.md 1.13.2, step 1), and finer by their places too as far as both agree.
Eigen::Vector3d acceleration_by_velocities(Knots knots, std::size_t at) {
    if (knots.size() == 2) return mean_acceleration(knots[0], knots[1]);
    // At an end: the mean of its step is that of both ends of the step.
    if (at == 0) return 2 * mean_acceleration(knots[0], knots[1]) - acceleration_by_velocities(knots, 1);
    if (at + 1 == knots.size())
        return 2 * mean_acceleration(knots[at - 1], knots[at]) - acceleration_by_velocities(knots, at - 1);
    constexpr double even_mps2 = 0.2;
    const TrackKnot &before = knots[at - 1], &here = knots[at], &after = knots[at + 1];
    const double h1 = here.time - before.time, h2 = after.time - here.time;
    const Eigen::Vector3d coarse =
        (h2 * mean_acceleration(before, here) + h1 * mean_acceleration(here, after)) / (h1 + h2);
    // What the trapezoid rule, corrected by the ends' accelerations, leaves of the way (Euler and Maclaurin).
    const Eigen::Vector3d bend = mean_acceleration(here, after) - mean_acceleration(before, here);
    const Eigen::Vector3d left = here.position - before.position - (before.velocity + here.velocity) * (h1 / 2);
    const Eigen::Vector3d right = after.position - here.position - (here.velocity + after.velocity) * (h2 / 2);
    const Eigen::Vector3d expected = -(h1 * h1 * h1 + h2 * h2 * h2) / (6 * (h1 + h2)) * bend;
    const double shortest = std::min(h1, h2);
    const double discord = 2 * (left + right - expected).norm() / (shortest * shortest);
    return coarse + (1 - share(discord, even_mps2)) * (acceleration_by_both(before, here, after) - coarse);
}

// A change of velocity that every vehicle can make, m/s².
constexpr double easy_mps2 = 2;

// The velocity and acceleration of the row at an end of a stretch, as far as the steps beside it allow. A polynomial
// runs out of its rows there, and turns a single leap between two of them into any velocity.
void bound_end(std::span<TrackKnot> knots, bool last, double most_mps2) {
    constexpr std::size_t fewest = 4;
    if (knots.size() < fewest) return;
    const auto row = [&](std::size_t i) -> TrackKnot& { return knots[last ? knots.size() - 1 - i : i]; };
    TrackKnot& end = row(0);
    std::array<Eigen::Vector3d, 3> steps;
    std::array<double, 3> middles{};  // s from the end
    for (std::size_t i = 0; i < steps.size(); ++i) {
        steps.at(i) = (row(i + 1).position - row(i).position) / (row(i + 1).time - row(i).time);
        middles.at(i) = std::abs((row(i + 1).time + row(i).time) / 2 - end.time);
    }
    const Eigen::Vector3d first = (steps[1] - steps[0]) / (middles[1] - middles[0]),
                          second = (steps[2] - steps[1]) / (middles[2] - middles[1]);
    // What both say, as those of a turn or of a start do and those of a leap do not; with room for what grows.
    const double agreed = 3 * std::min({first.norm(), second.norm(), (first + second).norm() / 2});
    const double easy = std::min(easy_mps2, (steps[0].norm() + 1) / (2 * middles[0]));
    const double most = std::min(most_mps2, std::max(easy, agreed));
    if (!end.has_velocity) {
        const Eigen::Vector3d off = end.velocity - steps[0];
        end.velocity = steps[0] + off * std::min(1.0, most * middles[0] / std::max(off.norm(), 1e-9));
        for (std::size_t i = 0; i < steps.size(); ++i)
            end.velocity *=
                std::min(1.0, (steps.at(i).norm() + most * middles.at(i)) / std::max(end.velocity.norm(), 1e-9));
    }
    end.acceleration *= std::min(1.0, most / std::max(end.acceleration.norm(), 1e-9));
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

}  // namespace

std::vector<TrackKnot> knots_of(const Track& track) {
    std::vector<TrackKnot> knots;
    knots.reserve(track.points.size());
    for (const TrackRow& row : track.points) {
        TrackKnot point;
        point.time = to_seconds(row.time - track.points.front().time).value();
        point.position = row.position.vector();
        point.has_velocity = row.velocity.has_value();
        if (point.has_velocity) point.velocity = row.velocity->vector();
        knots.push_back(point);
    }
    return knots;
}

void fill_in_motion(std::span<TrackKnot> knots, double most_mps2) {
    if (knots.size() < 2) return;
    for (std::size_t i = 0; i < knots.size(); ++i) {
        if (knots[i].has_velocity) continue;
        const LocalFit fit = motion_by_places(knots, i);
        knots[i].velocity = fit.velocity;
        knots[i].acceleration = fit.acceleration;
    }
    for (std::size_t i = 0; i < knots.size(); ++i)
        if (knots[i].has_velocity) knots[i].acceleration = acceleration_by_velocities(knots, i);
    bound_end(knots, false, most_mps2);
    bound_end(knots, true, most_mps2);
}

std::vector<TrackKnot> bridge_of_gap(const TrackKnot& from, const TrackKnot& to, double most_mps2) {
    constexpr double shortest_change_s = 0.1, longest_change_s = 10, longest_chord_m = 2000;
    const double span = to.time - from.time;
    const Eigen::Vector3d way = to.position - from.position;
    // A vehicle that hardly got on stops and starts as soon as it can: it would run far out and back otherwise.
    const double speed = std::max({from.velocity.norm(), to.velocity.norm(), 1e-9});
    const double needed = std::max({way.norm() / speed, speed / std::min(easy_mps2, most_mps2), shortest_change_s});
    const double change = std::min({longest_change_s, span / 3, needed});
    // The ends of the changes and the velocity between them agree when the velocity changes evenly.
    const Eigen::Vector3d mean = (way - (from.velocity + to.velocity) * (change / 2)) / (span - change);
    const Eigen::Vector3d left = from.position + (from.velocity + mean) * (change / 2);
    const Eigen::Vector3d right = to.position - (to.velocity + mean) * (change / 2);
    const double chords = std::min(1e4, std::ceil(std::max(1.0, (right - left).norm() / longest_chord_m)));
    std::vector<TrackKnot> knots;
    for (int i = 0; i <= static_cast<int>(chords); ++i) {
        const double part = static_cast<double>(i) / chords;
        TrackKnot point;
        point.time = from.time + change + part * (span - 2 * change);
        point.position = lifted(left, right, part);
        knots.push_back(point);
    }
    for (std::size_t i = 0; i < knots.size(); ++i) {
        const TrackKnot& before = knots[i == 0 ? 0 : i - 1];
        const TrackKnot& after = knots[std::min(i + 1, knots.size() - 1)];
        knots[i].velocity = (after.position - before.position) / (after.time - before.time);
    }
    return knots;
}

bool contradict(const TrackKnot& from, const TrackKnot& to) {
    constexpr double least_mps = 1, part_of_speed = 0.2;
    const Eigen::Vector3d moved = (to.position - from.position) / (to.time - from.time);
    const Eigen::Vector3d told = (from.velocity + to.velocity) / 2;
    return (moved - told).norm() > least_mps + part_of_speed * told.norm();
}

}  // namespace skyloop::inline motion
