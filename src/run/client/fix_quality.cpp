#include <fmt/format.h>

#include <cmath>

#include "run/client/health_checks.hpp"

namespace skyloop {
namespace {

// 1e-6 degrees are a decimetre: nobody is there, and receivers that have no place tell exactly this one.
constexpr double nowhere_deg = 1e-6;

std::optional<std::string> doubt_accuracy(const HeardSolution& s, const HealthLimits& limits) {
    if (s.horizontal_accuracy_m && *s.horizontal_accuracy_m > limits.horizontal_accuracy_m)
        return fmt::format("horizontal accuracy {:.1f} m", *s.horizontal_accuracy_m);
    if (s.vertical_accuracy_m && *s.vertical_accuracy_m > limits.vertical_accuracy_m)
        return fmt::format("vertical accuracy {:.1f} m", *s.vertical_accuracy_m);
    if (s.speed_accuracy_mps && *s.speed_accuracy_mps > limits.speed_accuracy_mps)
        return fmt::format("speed accuracy {:.1f} m/s", *s.speed_accuracy_mps);
    if (s.hdop && *s.hdop > limits.hdop) return fmt::format("HDOP {:.1f}", *s.hdop);
    return std::nullopt;
}

}  // namespace

HeardSolution heard_solution(const ObservedEpoch& epoch, GpsTime heard) {
    HeardSolution s;
    s.heard = heard;
    s.valid = epoch.type >= FixType::fix_2d && epoch.type <= FixType::rtk_fixed;
    s.three_dimensional = epoch.type > FixType::fix_2d && epoch.type <= FixType::rtk_fixed;
    s.satellites = epoch.satellites_used.value_or(0);
    const ObservedMotion& motion = epoch.motion;
    s.has_place = epoch.place || motion.latitude;
    if (epoch.place) {
        s.latitude_deg = epoch.place->latitude.deg();
        s.longitude_deg = epoch.place->longitude.deg();
        s.height_m = epoch.place->height.above_ellipsoid.value();
    } else if (motion.latitude) {
        s.latitude_deg = motion.latitude->deg();
        s.longitude_deg = motion.longitude->deg();
    }
    if (motion.altitude) s.height_m = motion.altitude->value();
    if (epoch.horizontal_accuracy) s.horizontal_accuracy_m = epoch.horizontal_accuracy->value();
    if (epoch.vertical_accuracy) s.vertical_accuracy_m = epoch.vertical_accuracy->value();
    if (epoch.speed_accuracy) s.speed_accuracy_mps = epoch.speed_accuracy->value();
    s.hdop = epoch.hdop;
    s.has_vertical_velocity = epoch.velocity.has_value();
    // Receivers leave the course empty when they stand: then the speed has no direction and hardly a size.
    const double course = motion.course ? motion.course->rad() : 0;
    if (epoch.velocity)
        s.velocity_mps = {epoch.velocity->north, epoch.velocity->east, epoch.velocity->down};
    else if (motion.ground_speed)
        s.velocity_mps = {motion.ground_speed->value() * std::cos(course),
                          motion.ground_speed->value() * std::sin(course), 0};
    s.utc_s = epoch.utc_s;
    return s;
}

std::optional<std::string> doubt_fix(const HeardSolution& s, const HealthLimits& limits) {
    if (!s.valid) return "no fix";
    if (!s.has_place) return "a fix without a position";
    if (!s.three_dimensional) return "no 3D fix";
    if (std::abs(s.latitude_deg) < nowhere_deg && std::abs(s.longitude_deg) < nowhere_deg)
        return "a fix at latitude 0, longitude 0";
    if (s.satellites < limits.satellites) return fmt::format("{} satellites used", s.satellites);
    return doubt_accuracy(s, limits);
}

std::optional<std::string> HealthChecks::doubt(const HeardSolution& solution) {
    // Each of them has to see every solution.
    auto fix = doubt_fix(solution, limits_);
    auto time = time_.doubt(solution, limits_);
    auto motion = motion_.doubt(solution, limits_);
    if (fix) return fix;
    return time ? time : motion;
}

}  // namespace skyloop
