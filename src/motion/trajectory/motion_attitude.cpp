#include "motion/trajectory/motion_attitude.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/geo/body_frame.hpp"
#include "motion/trajectory/vehicle_attitude.hpp"

namespace skyloop {
namespace {

using Samples = std::span<const MotionSample>;

constexpr double half_turn = std::numbers::pi;

// Roll, pitch, yaw in rad; the yaw counts on beyond half turns.
using EulerAngles = Eigen::Vector3d;

double speed_over_ground(const MotionSample& sample) { return sample.velocity.head<2>().norm(); }

// Where the vehicle looks by its course, and whether it drives backwards.
class YawByCourse {
public:
    YawByCourse(VehicleClass vehicle, std::optional<double> yaw)
        : traits_(traits_of(vehicle)),
          may_reverse_(vehicle == VehicleClass::car || vehicle == VehicleClass::rover || vehicle == VehicleClass::boat),
          yaw_(yaw) {}

    // Counts on from the yaw before.
    double next(const MotionSample& sample) {
        constexpr double fastest_reverse_mps = 8, turned_round = 2 * half_turn / 3;
        const double speed = speed_over_ground(sample);
        if (speed < traits_.course_gate.value() || speed == 0) {
            stood_ = true;
            return yaw_.value_or(0);
        }
        const double course = std::atan2(sample.velocity.y(), sample.velocity.x());
        if (!yaw_) yaw_ = course;
        if (std::exchange(stood_, false))
            reverse_ = may_reverse_ && std::abs(std::remainder(course - *yaw_, 2 * half_turn)) > turned_round;
        if (speed > fastest_reverse_mps) reverse_ = false;
        const double towards = course + (reverse_ ? half_turn : 0);
        *yaw_ += std::remainder(towards - *yaw_, 2 * half_turn);
        return *yaw_;
    }

private:
    const VehicleTraits& traits_;
    bool may_reverse_, reverse_ = false, stood_ = true;
    std::optional<double> yaw_;
};

// As a vehicle with this motion stands. Below the gate of its class the motion tells nothing; a multirotor's thrust
// carries it at any speed.
EulerAngles angles_of(const MotionSample& sample, double yaw, VehicleClass vehicle) {
    constexpr double steepest_road_deg = 20;
    const bool hovers = vehicle == VehicleClass::multirotor;
    VehicleMotion motion;
    motion.heading = Angle::radians(yaw);
    if (hovers || speed_over_ground(sample) >= traits_of(vehicle).course_gate.value()) {
        motion.velocity = {sample.velocity.y(), sample.velocity.x(), -sample.velocity.z()};
        motion.acceleration = {sample.acceleration.y(), sample.acceleration.x(), -sample.acceleration.z()};
    }
    const Attitude stands = attitude_of_vehicle(vehicle, motion);
    const double steepest = Angle::degrees(steepest_road_deg).rad();
    const bool on_ground = vehicle == VehicleClass::car || vehicle == VehicleClass::rover;
    const double pitch = stands.pitch().rad(), turned = std::remainder(stands.yaw().rad() - yaw, 2 * half_turn);
    return {stands.roll().rad(), on_ground ? std::clamp(pitch, -steepest, steepest) : pitch, yaw + turned};
}

// First order, forwards and then backwards, which takes the lag out again.
void low_pass(std::span<EulerAngles> angles, double step) {
    constexpr double time_constant_s = 0.4;
    const double part = 1 - std::exp(-step / time_constant_s);
    for (std::size_t i = 1; i < angles.size(); ++i)
        angles[i] = angles[i - 1] + part * (angles[i] - angles[i - 1]);
    for (std::size_t i = angles.size(); i-- > 1;)
        angles[i - 1] = angles[i] + part * (angles[i - 1] - angles[i]);
}

void keep_within_limits(std::span<EulerAngles> angles, double step, VehicleClass vehicle) {
    constexpr double roll_rate_deg = 90;
    const VehicleTraits& traits = traits_of(vehicle);
    const double bank = traits.bank_limit.rad(), turn = traits.turn_rate_limit.rad() * step;
    const double roll = Angle::degrees(roll_rate_deg).rad() * step;
    for (std::size_t i = 0; i < angles.size(); ++i) {
        angles[i].x() = std::clamp(angles[i].x(), -bank, bank);
        if (vehicle == VehicleClass::multirotor) angles[i].y() = std::clamp(angles[i].y(), -bank, bank);
        if (i == 0) continue;
        angles[i].x() = std::clamp(angles[i].x(), angles[i - 1].x() - roll, angles[i - 1].x() + roll);
        angles[i].z() = std::clamp(angles[i].z(), angles[i - 1].z() - turn, angles[i - 1].z() + turn);
    }
}

void stand_stretch(Samples samples, VehicleClass vehicle, std::optional<Angle> heading,
                   std::vector<AttitudeKnot>& knots) {
    const double gate = traits_of(vehicle).course_gate.value();
    if (!heading && vehicle != VehicleClass::fixed) {
        const auto first = std::find_if(samples.begin(), samples.end(),
                                        [&](const MotionSample& s) { return speed_over_ground(s) >= gate; });
        if (first != samples.end()) heading = Angle::radians(std::atan2(first->velocity.y(), first->velocity.x()));
    }
    YawByCourse course(vehicle, heading ? std::optional(heading->rad()) : std::nullopt);
    std::vector<EulerAngles> angles;
    angles.reserve(samples.size());
    for (const MotionSample& sample : samples) {
        const double yaw = vehicle == VehicleClass::fixed ? heading.value_or(Angle()).rad() : course.next(sample);
        angles.push_back(angles_of(sample, yaw, vehicle));
    }
    const double step = samples.size() > 1 ? samples[1].time - samples[0].time : 1;
    keep_within_limits(angles, step, vehicle);
    low_pass(angles, step);
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const auto attitude = Attitude::roll_pitch_yaw(Angle::radians(angles[i].x()), Angle::radians(angles[i].y()),
                                                       Angle::radians(angles[i].z()));
        knots.push_back({samples[i].time, body_to_ecef(attitude, samples[i].place), i == 0 && !knots.empty()});
    }
}

}  // namespace

std::vector<AttitudeKnot> attitude_from_motion(Samples samples, VehicleClass vehicle, std::optional<Angle> heading) {
    std::vector<AttitudeKnot> knots;
    knots.reserve(samples.size());
    for (std::size_t begin = 0; begin < samples.size();) {
        std::size_t end = begin + 1;
        while (end < samples.size() && !samples[end].jump)
            ++end;
        stand_stretch(samples.subspan(begin, end - begin), vehicle, heading, knots);
        begin = end;
    }
    return knots;
}

}  // namespace skyloop
