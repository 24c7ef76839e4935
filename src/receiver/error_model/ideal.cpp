#include "receiver/error_model/ideal.hpp"

#include "base/geo/local_frame.hpp"

namespace skyloop {
namespace {

// Below it a horizontal velocity is what the turn from ECEF to the horizon has left of a vertical one.
constexpr MetresPerSecond rest{1e-6};

}  // namespace

Fix Ideal::fix(const TruthState& truth, const SkyView& sky, const Arrivals& arrivals) {
    Fix fix = builder_.start(truth, sky, arrivals);
    if (!fix.has_position()) return fix;
    builder_.place(fix, truth.position, Metres(0));
    fix.position = truth.geodetic;
    const Eigen::Vector3d enu = LocalFrame(truth.geodetic).to_enu(truth.velocity).vector();
    const GroundMotion motion = ground_motion({enu.y(), enu.x(), -enu.z()});
    fix.velocity = motion.velocity;
    fix.speed = motion.speed;
    if (motion.speed >= rest) course_ = motion.course;
    fix.course = course_;
    fix.speed_accuracy = MetresPerSecond(0);
    fix.course_accuracy = Angle();
    return fix;
}

}  // namespace skyloop
