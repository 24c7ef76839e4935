/// Generated paths on the Earth.
#pragma once

#include <memory>

#include "motion/trajectory/geodesic_plane.hpp"
#include "motion/trajectory/trajectory.hpp"
#include "motion/trajectory/vehicle.hpp"
#include "motion/trajectory/vehicle_attitude.hpp"

namespace skyloop {

/// A shape that lies on the Earth, and a vehicle that follows it. Its attitude follows from the heading and from the
/// acceleration as it is on average over half a second, without a corner in its turn rate and at rest where the path
/// begins and ends; the turn rate follows from the attitude.
class ShapedPath : public Trajectory {
public:
    /// @param start when the shape begins
    /// @param vehicle which stands where the shape does not tell
    ShapedPath(GpsTime start, const GeodesicPlane& plane, std::shared_ptr<const LocalShape> shape, VehicleClass vehicle)
        : start_(start), plane_(plane), shape_(std::move(shape)), vehicle_(vehicle) {}
    [[nodiscard]] TruthState at(GpsTime time) const override;
    [[nodiscard]] const LocalShape& shape() const { return *shape_; }

private:
    [[nodiscard]] Attitude in_motion(double t, const VehicleMotion& motion) const;
    [[nodiscard]] double middle_of_window(double t) const;
    [[nodiscard]] Attitude attitude(double t, const LocalMotion& now, Angle north) const;

    GpsTime start_;
    GeodesicPlane plane_;
    std::shared_ptr<const LocalShape> shape_;
    VehicleClass vehicle_;
};

}  // namespace skyloop
