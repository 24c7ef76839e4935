#include "receiver/pvt/transmitter.hpp"

#include <cmath>

#include "world/gnss/constants.hpp"
#include "world/gnss/orbit.hpp"

namespace skyloop::inline receiver {
namespace {

// Beyond this the parabola of moved() is left for a new look at the orbit.
constexpr double longest_move_s = 2e-3;

// The instant receive_time − P/c, split where nanoseconds end.
struct SplitTime {
    GpsTime time;
    Seconds rest;
};
SplitTime reading_at_transmission(GpsTime receive_time, Metres pseudorange) {
    const Seconds travel(pseudorange.value() / speed_of_light);
    const Nanoseconds whole = to_nanoseconds(travel);
    return {receive_time - whole, Seconds(difference(GpsTime(whole), GpsTime()).value() - travel.value())};
}

double broadcast_accuracy(const Ephemeris& record) {
    return std::visit([](const auto& r) { return std::max(r.accuracy_m, 0.0); }, record);
}

// No satellite's pseudorange is so far off, whatever the receiver's clock.
constexpr double longest_range_m = 1e12;

}  // namespace

Transmitter moved(const Transmitter& transmitter, Seconds span) {
    const Eigen::Vector3d& r = transmitter.position.vector();
    const Eigen::Vector3d& v = transmitter.velocity.vector();
    // Central gravity in the turning frame; what it leaves out is below 1e-8 m in 2 ms.
    constexpr double rate = earth_rotation_rate;
    const double gravity = -gravitational_constant_gps / std::pow(r.squaredNorm(), 1.5);
    const Eigen::Vector3d acceleration = gravity * r + Eigen::Vector3d(rate * rate * r.x() + 2 * rate * v.y(),
                                                                       rate * rate * r.y() - 2 * rate * v.x(), 0);
    const double t = span.value();
    Transmitter there = transmitter;
    there.position = Position<Ecef>(r + t * v + 0.5 * t * t * acceleration);
    there.velocity = Velocity<Ecef>(Eigen::Vector3d(v + t * acceleration));
    there.clock_bias = transmitter.clock_bias + Seconds(transmitter.clock_drift * t);
    return there;
}

std::optional<Transmitter> BroadcastTransmitters::at(SatelliteId satellite, Signal signal, GpsTime receive_time,
                                                     Metres pseudorange) {
    if (!(std::abs(pseudorange.value()) < longest_range_m)) return std::nullopt;
    const SplitTime reading = reading_at_transmission(receive_time, pseudorange);
    const std::optional<Ephemeris> record = source_.ephemeris(satellite, choice_.value_or(reading.time));
    if (!record) return std::nullopt;
    const std::optional<Seconds> delay =
        untold_ == UntoldDelay::none ? sent_group_delay(*record, signal) : group_delay(*record, signal);
    if (!delay) return std::nullopt;

    const auto* glonass = std::get_if<GlonassEphemeris>(&*record);
    const auto look = [&](Seconds offset) {
        const SatelliteState state = glonass
                                         ? satellite_state(carried_.at(*glonass, reading.time), reading.time, offset)
                                         : satellite_state(*record, reading.time, offset);
        return Transmitter{state.position,    state.velocity,      Seconds(state.clock_bias) - *delay,
                           state.clock_drift, is_healthy(*record), Metres(broadcast_accuracy(*record))};
    };
    const Transmitter rough = look(reading.rest);
    if (std::abs(rough.clock_bias.value()) < longest_move_s) return moved(rough, -rough.clock_bias);
    return look(reading.rest - look(reading.rest - rough.clock_bias).clock_bias);
}

std::optional<Transmitter> PreciseTransmitters::at(SatelliteId satellite, Signal signal, GpsTime receive_time,
                                                   Metres pseudorange) {
    if (!(std::abs(pseudorange.value()) < longest_range_m)) return std::nullopt;
    const SplitTime reading = reading_at_transmission(receive_time, pseudorange);
    const std::optional<PreciseState> state = orbits_.state(satellite, reading.time);
    if (!state || !state->clock_bias) return std::nullopt;

    Seconds delay(0);
    bool healthy = true;
    if (group_delays_ != nullptr) {
        const std::optional<Ephemeris> record = group_delays_->ephemeris(satellite, reading.time);
        if (!record) return std::nullopt;
        const std::optional<Seconds> told = table_group_delay(*record, signal);
        if (!told) return std::nullopt;
        delay = *told;
        healthy = is_healthy(*record);
    }
    const double relativity =
        -2 * state->position.vector().dot(state->velocity.vector()) / (speed_of_light * speed_of_light);
    Transmitter transmitter{state->position, state->velocity, Seconds(*state->clock_bias + relativity) - delay, 0,
                            healthy,         Metres(0)};
    const auto ahead = orbits_.state(satellite, reading.time + std::chrono::seconds(1));
    if (ahead && ahead->clock_bias) transmitter.clock_drift = *ahead->clock_bias - *state->clock_bias;
    return moved(transmitter, reading.rest - transmitter.clock_bias);
}

}  // namespace skyloop::inline receiver
