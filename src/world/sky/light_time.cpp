#include "world/sky/light_time.hpp"

#include "world/gnss/constants.hpp"
#include "world/gnss/earth_turn.hpp"

namespace skyloop {

Position<Ecef> in_reception_frame(const Position<Ecef>& at_transmission, Seconds travel_time) {
    return Position<Ecef>(turned_by(at_transmission.vector(), travel_time.value()));
}

namespace {

// What the receiver sees of the transmitter, in the frame of the reception instant.
struct Sight {
    Eigen::Vector3d direction;
    Eigen::Vector3d velocity;
    Eigen::Vector3d turn;  // how the Earth's rotation moves the transmitter on while its signal travels, m/s

    // A longer way is seen from an earlier satellite through more of the Earth's rotation.
    double slope() const { return direction.dot(turn - velocity); }
};

Sight sight_of(const EcefMotion& transmitter, const Position<Ecef>& receiver, Seconds travel_time) {
    const Eigen::Vector3d position = turned_by(transmitter.position.vector(), travel_time.value());
    return {(position - receiver.vector()).normalized(), turned_by(transmitter.velocity.vector(), travel_time.value()),
            earth_rotation_rate * Eigen::Vector3d(position.y(), -position.x(), 0)};
}

}  // namespace

MetresPerSecond light_time_slope(const EcefMotion& transmitter, const Position<Ecef>& receiver, Seconds travel_time) {
    return MetresPerSecond(sight_of(transmitter, receiver, travel_time).slope());
}

MetresPerSecond light_time_range_rate(const EcefMotion& transmitter, const EcefMotion& receiver, Seconds travel_time) {
    const Sight sight = sight_of(transmitter, receiver.position, travel_time);
    const double own = sight.direction.dot(sight.velocity - receiver.velocity.vector());
    return MetresPerSecond(own / (1 - sight.slope() / speed_of_light));  // with τ = ρ/c it stands on both sides
}

}  // namespace skyloop
