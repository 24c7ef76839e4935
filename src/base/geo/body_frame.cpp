#include "base/geo/body_frame.hpp"

#include <cmath>
#include <numbers>

namespace skyloop {

Eigen::Quaterniond ned_to_ecef(const Geodetic& place) {
    // About Earth's axis by the longitude, then the north pole's frame tipped to the latitude.
    const Eigen::Quaterniond turned(Eigen::AngleAxisd(place.longitude.rad(), Eigen::Vector3d::UnitZ()));
    const Eigen::Quaterniond tipped(
        Eigen::AngleAxisd(-place.latitude.rad() - std::numbers::pi / 2, Eigen::Vector3d::UnitY()));
    return turned * tipped;
}

}  // namespace skyloop
