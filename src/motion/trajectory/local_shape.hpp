/// Paths as they are made up, before they lie anywhere on the Earth.
#pragma once

#include <Eigen/Core>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "motion/trajectory/vehicle.hpp"

namespace skyloop::inline motion {

/// A vehicle's motion in the coordinates of a GeodesicPlane: east and north of its origin along the ellipsoid, height
/// above the ellipsoid; metres, seconds.
struct LocalMotion {
    Eigen::Vector3d position = Eigen::Vector3d::Zero();
    Eigen::Vector3d velocity = Eigen::Vector3d::Zero();
    Eigen::Vector3d acceleration = Eigen::Vector3d::Zero();
    double heading = 0;  ///< where the vehicle looks, clockwise from the plane's north, rad
    double roll = 0;     ///< what it leans besides what its acceleration asks for (wind, waves), rad
    double pitch = 0;    ///< the same, nose up, rad
};

/// As what stands the one that goes a path: as a vehicle of one class, or between two of them.
struct Standing {
    VehicleClass from = VehicleClass::multirotor, to = VehicleClass::multirotor;
    double part = 0;  ///< 0: as `from`, 1: as `to`
};

/// A path as a pure function of time. Its acceleration is continuous and its velocity is the slope of its position. It
/// begins at rest, and ends at rest if it ends.
class LocalShape {
public:
    static constexpr double endless = std::numeric_limits<double>::infinity();
    virtual ~LocalShape() = default;
    /// @param t s since its beginning; before it the path stands at its beginning, after duration() at its end
    [[nodiscard]] virtual LocalMotion at(double t) const = 0;
    /// s; `endless` for a path without an end
    [[nodiscard]] virtual double duration() const = 0;
    /// Nothing: as the vehicle of the whole path. @param t as of at()
    [[nodiscard]] virtual std::optional<Standing> standing(double /*t*/) const { return std::nullopt; }
};

/// What came of the wish for a path.
struct PathPlan {
    std::shared_ptr<const LocalShape> shape;
    std::vector<std::string> notes;  ///< what its user should be told: where it is slower than asked for
    std::string summary{};           ///< what came out of a flight: height, speed
};
/// A sentence says why there is no such path, and what would do.
using PathPlanResult = tl::expected<PathPlan, std::string>;

}  // namespace skyloop::inline motion
