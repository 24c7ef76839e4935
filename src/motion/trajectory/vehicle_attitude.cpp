#include "motion/trajectory/vehicle_attitude.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "detail/smooth_step.hpp"

namespace skyloop {
namespace {

constexpr double weight_mps2 = 9.80665;  // m/s²
constexpr double in_radians = std::numbers::pi / 180;

struct AcrossAndAlong {
    double right = 0, up = 0;             // acceleration, m/s²
    double ground_speed = 0, climbs = 0;  // m/s
    double ahead = 1;                     // of the ground speed along the heading; −1: backwards
};

AcrossAndAlong in_axes_of_heading(const VehicleMotion& motion) {
    const double s = std::sin(motion.heading.rad()), c = std::cos(motion.heading.rad());
    const double ground_speed = std::hypot(motion.velocity.x(), motion.velocity.y());
    const double along = motion.velocity.x() * s + motion.velocity.y() * c;
    return {motion.acceleration.x() * c - motion.acceleration.y() * s, motion.acceleration.z(), ground_speed,
            motion.velocity.z(), ground_speed > 0 ? along / ground_speed : 1};
}

// The slope of the way, which standing vehicles do not have: it fades in between no speed and a walking pace. It is
// that of the nose where it goes ahead within 60°, of the tail where it goes backwards, and goes over from one to the
// other.
double slope_of(const AcrossAndAlong& m) {
    constexpr double walking_mps = 1;
    const double speed = std::hypot(m.ground_speed, m.climbs);
    const double slope = smooth_step(speed / walking_mps).value * std::atan2(m.climbs, m.ground_speed);
    return slope * (2 * smooth_step(std::clamp(m.ahead + 0.5, 0.0, 1.0)).value - 1);
}

Attitude banked(const AcrossAndAlong& m, const VehicleMotion& motion) {
    constexpr double steepest = 60 * in_radians, angle_of_attack = 3 * in_radians;
    constexpr double lifts_off_mps = 10;
    const double bank = std::clamp(std::atan2(m.right, weight_mps2 + m.up), -steepest, steepest);
    const double attack = angle_of_attack * smooth_step(m.ground_speed / lifts_off_mps).value;
    return Attitude::roll_pitch_yaw(Angle::radians(bank), Angle::radians(slope_of(m) + attack), motion.heading);
}

// Thrust carries the weight, accelerates and overcomes the drag; it points along the body's upward axis.
Attitude leaning_with_thrust(const VehicleMotion& motion) {
    constexpr double drag_per_s = 0.1;                  // ours: 6° of lean at 10 m/s, as small multirotors show
    constexpr double least_thrust = 0.2 * weight_mps2;  // whatever it is asked for, it does not turn over
    Eigen::Vector3d thrust = motion.acceleration + drag_per_s * motion.velocity + Eigen::Vector3d(0, 0, weight_mps2);
    thrust.z() = std::max(thrust.z(), least_thrust);
    const Eigen::Vector3d down = Eigen::Vector3d(-thrust.y(), -thrust.x(), thrust.z()).normalized();  // in NED
    const Eigen::Vector3d ahead(std::cos(motion.heading.rad()), std::sin(motion.heading.rad()), 0);
    const Eigen::Vector3d right = down.cross(ahead).normalized();
    Eigen::Matrix3d body_to_ned;
    body_to_ned << right.cross(down), right, down;
    return Attitude(Eigen::Quaterniond(body_to_ned));
}

Attitude leaning_outward(const AcrossAndAlong& m, const VehicleMotion& motion, double degrees_per_g, double pitch) {
    const double roll = -degrees_per_g * in_radians * m.right / weight_mps2;
    return Attitude::roll_pitch_yaw(Angle::radians(roll), Angle::radians(pitch), motion.heading);
}

}  // namespace

Attitude attitude_of_vehicle(VehicleClass kind, const VehicleMotion& motion) {
    constexpr double car_lean = 4, boat_lean = 15;  // degrees per g
    const AcrossAndAlong m = in_axes_of_heading(motion);
    switch (kind) {
        case VehicleClass::plane:
            return banked(m, motion);
        case VehicleClass::multirotor:
            return leaning_with_thrust(motion);
        case VehicleClass::rover:
        case VehicleClass::car:
            return leaning_outward(m, motion, car_lean, slope_of(m));
        case VehicleClass::boat:
            return leaning_outward(m, motion, boat_lean, 0);  // it pitches with the waves, not with its heave
        case VehicleClass::rocket:
            return Attitude::roll_pitch_yaw({}, Angle::degrees(90), motion.heading);
        case VehicleClass::fixed:
        case VehicleClass::pedestrian:
        case VehicleClass::balloon:
            break;
    }
    return Attitude::roll_pitch_yaw({}, {}, motion.heading);
}

}  // namespace skyloop
