#include "world/propagation/ray_geometry.hpp"

#include <algorithm>
#include <cmath>

namespace skyloop::inline world {

Metres path_to_height(const SphericalRay& ray, Metres height) {
    const double start = (ray.earth_radius + ray.antenna_height).value();
    const double end = std::max((ray.earth_radius + height).value(), start);
    const double tangent = start * std::cos(ray.elevation.rad());
    return Metres(std::sqrt(end * end - tangent * tangent) - start * std::sin(ray.elevation.rad()));
}

Metres shell_path(const SphericalRay& ray, Metres base, Metres top) {
    if (top <= base) return Metres(0);
    return path_to_height(ray, top) - path_to_height(ray, base);
}

Angle elevation_at_height(const SphericalRay& ray, Metres height) {
    const double start = (ray.earth_radius + ray.antenna_height).value();
    const double end = std::max((ray.earth_radius + height).value(), start);
    return Angle::radians(std::acos(start * std::cos(ray.elevation.rad()) / end));
}

Angle off_boresight_angle(const SphericalRay& ray, Metres orbit_radius) {
    const double start = (ray.earth_radius + ray.antenna_height).value();
    return Angle::radians(std::asin(start * std::cos(ray.elevation.rad()) / orbit_radius.value()));
}

}  // namespace skyloop::inline world
