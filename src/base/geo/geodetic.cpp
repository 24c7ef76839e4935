#include "base/geo/geodetic.hpp"

#include <fmt/format.h>
#include <GeographicLib/Geocentric.hpp>
#include <GeographicLib/Geodesic.hpp>

#include <cmath>

namespace skyloop::inline base {

Geodetic Geodetic::degrees(double latitude, double longitude, double height_m) {
    return {Angle::degrees(latitude), Angle::degrees(longitude), {Metres(height_m)}};
}

tl::expected<Geodetic, std::string> place_from_degrees(double latitude, double longitude, double height_m) {
    if (!(std::abs(latitude) <= 90))
        return tl::make_unexpected(fmt::format("latitude is {}; expected -90 to 90 degrees", latitude));
    if (!(std::abs(longitude) <= 360))
        return tl::make_unexpected(fmt::format("longitude is {}; expected -360 to 360 degrees", longitude));
    if (!(height_m >= -1e4 && height_m <= 1e7))
        return tl::make_unexpected(
            fmt::format("height is {}; expected metres above the ellipsoid, -10 000 to 10 000 000", height_m));
    return Geodetic::degrees(latitude, std::remainder(longitude, 360), height_m);
}

tl::expected<std::vector<Geodetic>, std::string> corners_from_degrees(std::span<const double> numbers) {
    if (numbers.size() % 2 != 0 || numbers.size() < 6)
        return tl::make_unexpected(
            fmt::format("holds {} numbers; expected at least three pairs of latitude and longitude", numbers.size()));
    std::vector<Geodetic> corners;
    for (std::size_t i = 0; i < numbers.size(); i += 2) {
        const auto place = place_from_degrees(numbers[i], numbers[i + 1], 0);
        if (!place) return tl::make_unexpected(place.error());
        corners.push_back(*place);
    }
    return corners;
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

GeodesicPoint geodesic_direct(const Geodetic& start, Angle azimuth, Metres distance) {
    double latitude = 0;
    double longitude = 0;
    double end_azimuth = 0;
    double reduced_length = 0;
    GeographicLib::Geodesic::WGS84().Direct(start.latitude.deg(), start.longitude.deg(), azimuth.deg(),
                                            distance.value(), latitude, longitude, end_azimuth, reduced_length);
    return {Angle::degrees(latitude), Angle::degrees(longitude), Angle::degrees(end_azimuth), Metres(reduced_length)};
}

GeodesicLeg geodesic_between(const Geodetic& from, const Geodetic& to) {
    double length = 0;
    double azimuth = 0;
    double end_azimuth = 0;
    GeographicLib::Geodesic::WGS84().Inverse(from.latitude.deg(), from.longitude.deg(), to.latitude.deg(),
                                             to.longitude.deg(), length, azimuth, end_azimuth);
    return {Metres(length), Angle::degrees(azimuth)};
}

}  // namespace skyloop::inline base
