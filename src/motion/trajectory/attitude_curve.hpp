/// Attitudes told at single instants, as a curve.
#pragma once

#include <Eigen/Geometry>
#include <vector>

namespace skyloop {

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

}  // namespace skyloop
