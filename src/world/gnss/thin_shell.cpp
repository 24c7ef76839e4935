#include "world/gnss/thin_shell.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace skyloop {
namespace {

double shell_ratio(const ThinShell& shell, Metres antenna_height) {
    return (shell.earth_radius + antenna_height).value() / (shell.earth_radius + shell.height).value();
}

double obliquity(double sine_at_shell) { return 1 / std::sqrt(1 - sine_at_shell * sine_at_shell); }

}  // namespace

Angle pierce_angle(const ThinShell& shell, Angle elevation, Metres antenna_height) {
    const double sine_at_shell = shell_ratio(shell, antenna_height) * std::cos(elevation.rad());
    return Angle::radians(std::numbers::pi / 2 - elevation.rad() - std::asin(std::min(sine_at_shell, 1.0)));
}

double gradient_arm(Angle elevation, Metres antenna_height) {
    constexpr Angle full_size = Angle::degrees(9);
    return pierce_angle(ThinShell(), elevation, antenna_height).rad() / full_size.rad();
}

PiercePoint pierce_point(const ThinShell& shell, const Geodetic& place, const SkyDirection& direction) {
    const double azimuth = direction.azimuth.rad();
    const double psi = pierce_angle(shell, direction.elevation, place.height.above_ellipsoid).rad();
    const double sin_latitude = std::sin(place.latitude.rad()), cos_latitude = std::cos(place.latitude.rad());
    const double north = std::sin(psi) * std::cos(azimuth);
    const double sine = sin_latitude * std::cos(psi) + cos_latitude * north;
    // By atan2, so that rays over a pole come down on the other side.
    const double east = std::sin(psi) * std::sin(azimuth);
    const double along = cos_latitude * std::cos(psi) - sin_latitude * north;
    const double longitude = place.longitude.rad() + std::atan2(east, along);
    return {Angle::radians(std::atan2(sine, std::hypot(east, along))),
            Angle::radians(std::remainder(longitude, 2 * std::numbers::pi))};
}

PiercePoint published_pierce_point(const ThinShell& shell, const Geodetic& place, const SkyDirection& direction) {
    PiercePoint point = pierce_point(shell, place, direction);
    const double full = 2 * std::numbers::pi, half = std::numbers::pi;
    const double turn = std::remainder((point.longitude - place.longitude).rad(), full);
    if (std::abs(turn) > half / 2)
        point.longitude =
            Angle::radians(std::remainder(place.longitude.rad() + std::copysign(half, turn) - turn, full));
    return point;
}

double single_layer_mapping(const ThinShell& shell, Angle elevation, Metres antenna_height) {
    return obliquity(shell_ratio(shell, antenna_height) * std::cos(elevation.rad()));
}

double modified_single_layer_mapping(const ThinShell& shell, Angle elevation) {
    return obliquity(shell_ratio(shell, Metres(0)) * std::sin(0.9782 * (std::numbers::pi / 2 - elevation.rad())));
}

Metres ionosphere_group_delay(Tecu slant_content, Hertz carrier) {
    return Metres(40.3e16 * slant_content.value() / (carrier.value() * carrier.value()));
}

}  // namespace skyloop
