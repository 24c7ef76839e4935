/// A plane on which paths are drawn, and how it lies on the ellipsoid.
#pragma once

#include <Eigen/Core>

#include "base/geo/geodetic.hpp"
#include "motion/trajectory/local_shape.hpp"
#include "world/flow/truth_state.hpp"

namespace skyloop {

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

}  // namespace skyloop
