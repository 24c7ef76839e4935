/// Ways through places that a file has without times.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/core/result.hpp"
#include "motion/trajectory/shaped_path.hpp"
#include "motion/trajectory/track.hpp"
#include "motion/trajectory/trajectory.hpp"
#include "motion/trajectory/waypoint_plan.hpp"

namespace skyloop::inline motion {

/// How a route is flown.
struct RouteSettings {
    std::optional<VehicleClass> vehicle{};  ///< nothing: the file's, or a multirotor
    std::optional<double> speed{};          ///< m/s; nothing: the file's, or the vehicle's usual one
    double tolerance = 2;  ///< places this near to the way between those kept are left out of dense routes, and what
                           ///< goes straight in space passes the others this near; m
    double heading = 0;    ///< until it goes anywhere, rad
};

/// The indices of the places that are needed so that the straight ways between them pass all others within the
/// tolerance (Douglas and Peucker, Algorithms for the reduction of the number of points required to represent a
/// digitized line or its caricature, 1973), in order; the first and the last are among them. Long lines are worked on
/// in blocks, whose ends stay, so that time grows evenly with the number of places.
std::vector<std::size_t> places_that_matter(std::span<const Eigen::Vector3d> places, double tolerance);

/// A route as it is flown.
struct FlownRoute {
    GeodesicPlane plane;
    std::shared_ptr<const LocalShape> shape;
    VehicleClass vehicle = VehicleClass::multirotor;
    std::vector<PlannedWaypoint> waypoints{};  ///< the places kept; m on the plane
    std::size_t places = 0;                    ///< that the file has
    std::size_t circles = 0, corners = 0;      ///< places that are circled, and the waypoints that stand for them
    std::vector<std::string> notes{};          ///< what its user should be told
};

/// Plans the way of a route: from rest to rest, with the limits of its vehicle (plan_waypoints()). The places of plans
/// are all kept; those of recordings that lie within the tolerance are left out. A single place is stood at for ever.
/// @param track with a route
/// Fails with `input` where there is no way, and where a place lies more than 1000 km from the first.
Result<FlownRoute> fly_route(const Track& track, const RouteSettings& settings);

/// A flown route in time.
class RoutePath : public FilePath {
public:
    /// @param start when it leaves its first place
    RoutePath(const FlownRoute& route, GpsTime start);
    [[nodiscard]] TruthState at(GpsTime time) const override { return path_.at(time); }
    [[nodiscard]] Seconds duration() const override { return Seconds(path_.shape().duration()); }
    [[nodiscard]] Eigen::Vector3d acceleration(GpsTime time) const override;

private:
    GpsTime start_;
    ShapedPath path_;
};

}  // namespace skyloop::inline motion
