/// Attitudes told at single instants, as a curve.
/// How a vehicle stands, from how it moves.
/// How a vehicle stands that tells only where it is.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <optional>
#include <span>
#include <vector>

#include "base/geo/attitude.hpp"
#include "base/geo/geodetic.hpp"
#include "motion/trajectory/vehicle.hpp"

namespace skyloop::inline motion {

/// How a body stands at one instant.
struct AttitudeKnot {
    double time = 0;  ///< s
    Eigen::Quaterniond body_to_ecef = Eigen::Quaterniond::Identity();
    bool jump = false;  ///< no way leads from the knot before to this one
};

/// How a body stands and turns.
struct BodyTurn {
    Eigen::Quaterniond body_to_ecef = Eigen::Quaterniond::Identity();
    Eigen::Vector3d rate = Eigen::Vector3d::Zero();  ///< against the Earth, in the body's axes, rad/s
};

/// Through the knots, the turn rate continuous (FEEDS.md 1.13.4): between two knots the rotation vector from the first
/// one is a cubic Hermite polynomial whose ends have the rates of the knots; those are the means of the rates on both
/// sides, weighted by the steps. A knot more than 120° from the one before is reached at a constant rate. Before a jump
/// the last knot holds; before the first knot and after the last one it does not turn.
class AttitudeCurve {
public:
    AttitudeCurve() = default;
    /// @param knots in ascending time
    explicit AttitudeCurve(std::vector<AttitudeKnot> knots);
    /// @param rates of the knots, as BodyTurn::rate
    AttitudeCurve(std::vector<AttitudeKnot> knots, std::vector<Eigen::Vector3d> rates)
        : knots_(std::move(knots)), rates_(std::move(rates)) {}
    [[nodiscard]] bool empty() const { return knots_.empty(); }
    [[nodiscard]] BodyTurn at(double time) const;  ///< there is a knot or more

private:
    std::vector<AttitudeKnot> knots_;
    std::vector<Eigen::Vector3d> rates_;  // of the knots
};

/// What its attitude follows from; east, north, up.
struct VehicleMotion {
    Eigen::Vector3d velocity = Eigen::Vector3d::Zero();      ///< m/s
    Eigen::Vector3d acceleration = Eigen::Vector3d::Zero();  ///< of the motion, gravity not in it; m/s²
    Angle heading;                                           ///< clockwise from north
};

/// Bank in turns, pitch with the way, by the class of the vehicle (FEEDS.md 1.13.4): a plane's turn is coordinated, a
/// multirotor leans with its thrust, cars and boats lean outward, a rocket stands on its tail.
Attitude attitude_of_vehicle(VehicleClass kind, const VehicleMotion& motion);

/// A vehicle's motion at one instant; north, east, down at its place.
struct MotionSample {
    double time = 0;  ///< s
    Geodetic place;
    Eigen::Vector3d velocity = Eigen::Vector3d::Zero();      ///< m/s
    Eigen::Vector3d acceleration = Eigen::Vector3d::Zero();  ///< m/s², gravity not in it
    bool jump = false;                                       ///< no way leads from the sample before to this one
};

/// The attitude by class, of attitude_of_vehicle(). Yaw by the course, held where the vehicle is slower than its
/// class's gate; a car, rover or boat that sets off backwards keeps its yaw (reverse gear). What goes on the ground
/// pitches by 20° at most. All angles pass a low-pass of 0.4 s without lag, and are within the limits of the
/// class.
/// @param samples in ascending time, evenly spaced between jumps
/// @param heading until it first moves; nothing: where it first goes
std::vector<AttitudeKnot> attitude_from_motion(std::span<const MotionSample> samples, VehicleClass vehicle,
                                               std::optional<Angle> heading);

}  // namespace skyloop::inline motion
