#include "world/gnss/sun_and_moon.hpp"

#include <Eigen/Geometry>

#include <chrono>
#include <cmath>
#include <numbers>

#include "base/time/utc_time.hpp"

namespace skyloop::inline world {
namespace {

constexpr double degree = std::numbers::pi / 180, arc_second = degree / 3600;
constexpr double terrestrial_lead_s = 51.184;  // TT − GPST

double degrees_of_day(double degrees) { return std::remainder(degrees, 360) * degree; }

// Julian centuries since 2000-01-01T12:00:00, of the same scale as the seconds that are added.
double centuries(GpsTime time, double added_s) {
    const GpsTime j2000 = gps_calendar_time(2000, 1, 1, 12, 0, 0);
    return (difference(time, j2000).value() + added_s) / (36525 * 86400.0);
}

// From ecliptic longitude, latitude and distance.
Position<Ecef> earth_fixed(double longitude, double latitude, double distance, GpsTime time) {
    const double obliquity = (23.43929111 - 0.0130042 * centuries(time, terrestrial_lead_s)) * degree;
    const Eigen::Vector3d ecliptic(std::cos(latitude) * std::cos(longitude), std::cos(latitude) * std::sin(longitude),
                                   std::sin(latitude));
    const Eigen::Vector3d equatorial = Eigen::AngleAxisd(obliquity, Eigen::Vector3d::UnitX()) * ecliptic;
    return Position<Ecef>(distance * (Eigen::AngleAxisd(-sidereal_time(time), Eigen::Vector3d::UnitZ()) * equatorial));
}

}  // namespace

double sidereal_time(GpsTime time) {
    const double utc_behind_s = LeapSeconds::announced().offset(time);
    const double t = centuries(time, -utc_behind_s);
    // s of the day; the day's own turn is within the second coefficient.
    const double seconds = 67310.54841 + (876600.0 * 3600 + 8640184.812866) * t + 0.093104 * t * t - 6.2e-6 * t * t * t;
    const double turned = std::fmod(seconds, 86400.0) / 86400 * 2 * std::numbers::pi;
    return turned < 0 ? turned + 2 * std::numbers::pi : turned;
}

Position<Ecef> sun_position(GpsTime time) {
    const double days = 36525 * centuries(time, terrestrial_lead_s);
    const double anomaly = degrees_of_day(357.528 + 0.9856003 * days);
    const double longitude = degrees_of_day(280.460 + 0.9856474 * days) +
                             (1.915 * std::sin(anomaly) + 0.020 * std::sin(2 * anomaly)) * degree;
    constexpr double astronomical_unit = 149597870700;
    const double distance = 1.00014 - 0.01671 * std::cos(anomaly) - 0.00014 * std::cos(2 * anomaly);
    return earth_fixed(longitude, 0, distance * astronomical_unit, time);
}

Position<Ecef> moon_position(GpsTime time) {
    const double t = centuries(time, terrestrial_lead_s);
    const double mean = degrees_of_day(218.31617 + 481267.88088 * t);
    const double l = degrees_of_day(134.96292 + 477198.86753 * t), m = degrees_of_day(357.52543 + 35999.04944 * t);
    const double f = degrees_of_day(93.27283 + 483202.01873 * t), d = degrees_of_day(297.85027 + 445267.11135 * t);
    using std::cos, std::sin;
    const double longitude_terms = 22640 * sin(l) + 769 * sin(2 * l) - 4586 * sin(l - 2 * d) + 2370 * sin(2 * d) -
                                   668 * sin(m) - 412 * sin(2 * f) - 212 * sin(2 * l - 2 * d) -
                                   206 * sin(l + m - 2 * d) + 192 * sin(l + 2 * d) - 165 * sin(m - 2 * d) +
                                   148 * sin(l - m) - 125 * sin(d) - 110 * sin(l + m) - 55 * sin(2 * f - 2 * d);
    const double argument = f + (longitude_terms + 412 * sin(2 * f) + 541 * sin(m)) * arc_second;
    const double latitude_terms = 18520 * sin(argument) - 526 * sin(f - 2 * d) + 44 * sin(l + f - 2 * d) -
                                  31 * sin(-l + f - 2 * d) - 25 * sin(-2 * l + f) - 23 * sin(m + f - 2 * d) +
                                  21 * sin(-l + f) + 11 * sin(-m + f - 2 * d);
    const double distance_km = 385000 - 20905 * cos(l) - 3699 * cos(2 * d - l) - 2956 * cos(2 * d) - 570 * cos(2 * l) +
                               246 * cos(2 * l - 2 * d) - 205 * cos(m - 2 * d) - 171 * cos(l + 2 * d) -
                               152 * cos(l + m - 2 * d);
    return earth_fixed(mean + longitude_terms * arc_second, latitude_terms * arc_second, distance_km * 1e3, time);
}

SatelliteAxes yaw_steering(const Position<Ecef>& satellite, const Position<Ecef>& sun) {
    const Eigen::Vector3d z = -satellite.vector().normalized();
    const Eigen::Vector3d across = z.cross((sun - satellite).vector());
    // Exactly below the Sun any axis is as good.
    const Eigen::Vector3d y = across.norm() > 0 ? across.normalized() : z.unitOrthogonal();
    return {y.cross(z), y, z};
}

}  // namespace skyloop::inline world
