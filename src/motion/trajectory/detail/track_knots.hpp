// The points that the curve through a track is led through: what the rows tell, and what their neighbours tell of the
// rest.
///
// One piece of a curve between two points of which place, velocity and acceleration are known.
#pragma once

#include <Eigen/Core>

#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "motion/trajectory/track.hpp"

namespace skyloop::inline motion {

// A point that the curve goes through; seconds after the first row, metres, ECEF.
struct TrackKnot {
    double time = 0;
    Eigen::Vector3d position = Eigen::Vector3d::Zero(), velocity = Eigen::Vector3d::Zero(),
                    acceleration = Eigen::Vector3d::Zero();
    bool has_velocity = false;  // told by the row
};

std::vector<TrackKnot> knots_of(const Track& track);

// Velocities that the rows do not tell, and all accelerations, of one stretch without gaps and jumps. Those of its
// first and last row are bounded by the three steps beside them, and by the vehicle.
// @param most_mps2 acceleration of the vehicle; endless where it is not known
void fill_in_motion(std::span<TrackKnot> knots, double most_mps2 = HUGE_VAL);

// The knots inside a gap: from the velocity before it to a constant one, and from that to the one after it. The time of
// each change is at most 10 s and a third of the gap, and no longer than the way takes at the speed beside it, unless
// the vehicle needs longer to stop.
std::vector<TrackKnot> bridge_of_gap(const TrackKnot& from, const TrackKnot& to, double most_mps2 = HUGE_VAL);

// Whether the velocities of two neighbours do not fit their places.
bool contradict(const TrackKnot& from, const TrackKnot& to);

using PieceCoefficients = Eigen::Matrix<double, 3, 6>;  // of powers of u = (t − t0) / h, relative to the first point, m
using PiecePowers = Eigen::Matrix<double, 6, 1>;

// Quintic Hermite in powers of u (FEEDS.md 1.13.3); p relative to the first knot. @param h s
inline PieceCoefficients quintic_hermite(const TrackKnot& from, const TrackKnot& to, double h) {
    const Eigen::Vector3d p1 = to.position - from.position;
    const Eigen::Vector3d v0 = h * from.velocity, v1 = h * to.velocity;
    const Eigen::Vector3d a0 = h * h * from.acceleration, a1 = h * h * to.acceleration;
    PieceCoefficients c;
    c.col(0).setZero();
    c.col(1) = v0;
    c.col(2) = a0 / 2;
    c.col(3) = 10 * p1 - 6 * v0 - 4 * v1 - 1.5 * a0 + 0.5 * a1;
    c.col(4) = -15 * p1 + 8 * v0 + 7 * v1 + 1.5 * a0 - a1;
    c.col(5) = 6 * p1 - 3 * v0 - 3 * v1 - 0.5 * a0 + 0.5 * a1;
    return c;
}

// Leaves the accelerations out.
inline PieceCoefficients cubic_hermite(const TrackKnot& from, const TrackKnot& to, double h) {
    const Eigen::Vector3d p1 = to.position - from.position;
    const Eigen::Vector3d v0 = h * from.velocity, v1 = h * to.velocity;
    PieceCoefficients c = PieceCoefficients::Zero();
    c.col(1) = v0;
    c.col(2) = 3 * p1 - 2 * v0 - v1;
    c.col(3) = -2 * p1 + v0 + v1;
    return c;
}

// What the coefficients are multiplied by for the value, or its first or second derivative after u.
inline PiecePowers piece_powers(double u, int derivative) {
    PiecePowers powers = PiecePowers::Zero();
    double power = 1;
    for (int i = derivative; i < 6; ++i, power *= u)
        powers(i) = power * (derivative == 0 ? 1 : derivative == 1 ? i : i * (i - 1));
    return powers;
}

}  // namespace skyloop::inline motion
