// The points that the curve through a track is led through: what the rows tell, and what their neighbours tell of the
// rest.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "motion/trajectory/track.hpp"

namespace skyloop {

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

}  // namespace skyloop
