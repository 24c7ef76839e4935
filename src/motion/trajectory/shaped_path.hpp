/// Generated paths on the Earth.
/// A plane on which paths are drawn, and how it lies on the ellipsoid.
#pragma once

#include <Eigen/Core>

#include <memory>

#include "base/geo/geodetic.hpp"
#include "motion/trajectory/local_shape.hpp"
#include "motion/trajectory/path_attitude.hpp"
#include "motion/trajectory/trajectory.hpp"
#include "motion/trajectory/vehicle.hpp"
#include "world/flow/truth_state.hpp"

namespace skyloop::inline motion {

/// Directions and distances from the origin are those of geodesics (azimuthal equidistant projection: Snyder, Map
/// Projections, USGS 1395, chapter 25, with Karney's geodesics), heights are those above the ellipsoid. What runs
/// across such a line is too long on the plane by s²/6R²: 0.04 % at 300 km.
class GeodesicPlane {
public:
    static constexpr double farthest_m = 1e6;  ///< from the origin, that a path may lead
    explicit GeodesicPlane(const Geodetic& origin) : origin_(origin) {}
    [[nodiscard]] const Geodetic& origin() const { return origin_; }

    /// East and north of the origin, height above the ellipsoid; m.
    [[nodiscard]] Eigen::Vector3d to_local(const Geodetic& place) const;
    /// The state without its orientation, and by how much the plane's north stands clockwise of true north there.
    struct Placed {
        TruthState state;
        Angle north;
    };
    [[nodiscard]] Placed place(GpsTime time, const LocalMotion& motion) const;

private:
    Geodetic origin_;
};

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

}  // namespace skyloop::inline motion
