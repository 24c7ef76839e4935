#include "skyloop/geo/geodetic.hpp"

#include <GeographicLib/Geocentric.hpp>
#include <cmath>

namespace skyloop {

Geodetic Geodetic::degrees(double latitude, double longitude, double height_m) {
    return {Angle::degrees(latitude), Angle::degrees(longitude), {Metres(height_m)}};
}

Position<Ecef> to_ecef(const Geodetic& place) {
    double x = 0;
    double y = 0;
    double z = 0;
    GeographicLib::Geocentric::WGS84().Forward(place.latitude.deg(), place.longitude.deg(),
                                               place.height.above_ellipsoid.value(), x, y, z);
    return {x, y, z};
}

Geodetic to_geodetic(const Position<Ecef>& point) {
    double latitude = 0;
    double longitude = 0;
    double height = 0;
    const Eigen::Vector3d& p = point.vector();
    GeographicLib::Geocentric::WGS84().Reverse(p.x(), p.y(), p.z(), latitude, longitude, height);
    return Geodetic::degrees(latitude, longitude, height);
}

CurvatureRadii curvature_radii(Angle latitude) {
    const double a = GeographicLib::Geocentric::WGS84().EquatorialRadius();
    const double f = GeographicLib::Geocentric::WGS84().Flattening();
    const double e2 = f * (2 - f);
    const double sine = std::sin(latitude.rad());
    const double w2 = 1 - e2 * sine * sine;
    return {a * (1 - e2) / (w2 * std::sqrt(w2)), a / std::sqrt(w2)};
}

}  // namespace skyloop
