#include "skyloop/sky/light_time.hpp"

#include "skyloop/gnss/constants.hpp"
#include "skyloop/gnss/earth_turn.hpp"

namespace skyloop {

Position<Ecef> in_reception_frame(const Position<Ecef>& at_transmission, Seconds travel_time) {
    return Position<Ecef>(turned_by(at_transmission.vector(), travel_time.value()));
}

MetresPerSecond light_time_range_rate(const EcefMotion& transmitter, const EcefMotion& receiver, Seconds travel_time) {
    const Eigen::Vector3d position = turned_by(transmitter.position.vector(), travel_time.value());
    const Eigen::Vector3d velocity = turned_by(transmitter.velocity.vector(), travel_time.value());
    const Eigen::Vector3d direction = (position - receiver.position.vector()).normalized();
    // With τ = ρ/c the derivative stands on both sides: a longer way is seen from an earlier satellite (velocity)
    // through more of the Earth's rotation (turn).
    const Eigen::Vector3d turn = earth_rotation_rate * Eigen::Vector3d(position.y(), -position.x(), 0);
    const double own = direction.dot(velocity - receiver.velocity.vector());
    return MetresPerSecond(own / (1 + direction.dot(velocity - turn) / speed_of_light));
}

}  // namespace skyloop
