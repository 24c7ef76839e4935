/// How a motion goes on, and how one leads to another.
#pragma once

#include <span>

#include "motion/trajectory/live_path.hpp"

namespace skyloop::inline motion {

/// @param from the last that is known @param after s since then, ≥ 0
LivePath::Motion carried_on(const LivePath::Motion& from, const LivePath::Patience& patience, double after);

/// Where the velocities between two motions come from.
enum class Velocities {
    of_the_curve,  ///< its slope
    told,          ///< those of the two motions: the source knows them better than its rounded places
};

/// The quintic curve between two motions (FEEDS.md 1.13.3), and the shorter turn between their attitudes.
/// @param h s between them, > 0 @param t s since `from`, 0 … h @param velocities `told`: by cubic curves between those
/// of the motions, which a place of 1 cm more or less does not bend
LivePath::Motion between(const LivePath::Motion& from, const LivePath::Motion& to, double h, double t,
                         Velocities velocities = Velocities::of_the_curve);

/// A difference of motions that is taken away within `length` s, `t` s after its beginning: the quintic curve to zero.
LivePath::Motion taken_away(const LivePath::Motion& difference, double length, double t);
/// What is left then of a turn. The part goes smoothly from 1 to 0.
double part_left(double length, double t);

/// The slope at the last of up to nine points, by a parabola fitted to them; a line of two; zero of one.
/// @param times s
Eigen::Vector3d slope_at_end(std::span<const double> times, std::span<const Eigen::Vector3d> values);

}  // namespace skyloop::inline motion
