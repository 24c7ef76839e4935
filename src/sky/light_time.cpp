#include "skyloop/sky/light_time.hpp"

#include <cmath>

#include "skyloop/gnss/constants.hpp"

namespace skyloop {
namespace {

Eigen::Vector3d turned_with_earth(const Eigen::Vector3d& v, Seconds travel_time) {
    const double angle = earth_rotation_rate * travel_time.value();
    const double s = std::sin(angle);
    const double c = std::cos(angle);
    return {v.x() * c + v.y() * s, -v.x() * s + v.y() * c, v.z()};
}

}  // namespace

Position<Ecef> in_reception_frame(const Position<Ecef>& at_transmission, Seconds travel_time) {
    return Position<Ecef>(turned_with_earth(at_transmission.vector(), travel_time));
}

MetresPerSecond light_time_range_rate(const EcefMotion& transmitter, const EcefMotion& receiver, Seconds travel_time) {
    const Eigen::Vector3d position = turned_with_earth(transmitter.position.vector(), travel_time);
    const Eigen::Vector3d velocity = turned_with_earth(transmitter.velocity.vector(), travel_time);
    const Eigen::Vector3d direction = (position - receiver.position.vector()).normalized();
    // With τ = ρ/c the derivative stands on both sides: a longer way is seen from an earlier satellite (velocity)
    // through more of the Earth's rotation (turn).
    const Eigen::Vector3d turn = earth_rotation_rate * Eigen::Vector3d(position.y(), -position.x(), 0);
    const double own = direction.dot(velocity - receiver.velocity.vector());
    return MetresPerSecond(own / (1 + direction.dot(velocity - turn) / speed_of_light));
}

}  // namespace skyloop
