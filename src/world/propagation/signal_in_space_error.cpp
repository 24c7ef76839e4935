#include "world/propagation/signal_in_space_error.hpp"

#include <Eigen/Geometry>
#include <cmath>

#include "world/gnss/constants.hpp"

namespace skyloop::inline world {
namespace {

constexpr Nanoseconds orbit_error_spacing = std::chrono::seconds(60);
constexpr OrbitClockSigmas typical_sigmas{0.15, 0.9, 0.5, 0.3};

bool is_beidou_medium_orbit(int number) {
    // Geostationary and inclined geosynchronous: C01 to C10, C13, C16, C31, C38 to C40 and from C56 (but C57 and C58).
    return number > 10 && number != 13 && number != 16 && number != 31 && (number < 38 || number > 40) &&
           (number < 56 || number == 57 || number == 58);
}

// Shares of the radial, along-track and cross-track error in the range, and how they change per second.
struct LineOfSightShares {
    Eigen::Vector3d share = Eigen::Vector3d(1, 0, 0);
    Eigen::Vector3d rate = Eigen::Vector3d::Zero();
};

Eigen::Vector3d inertial_velocity(const Eigen::Vector3d& position, const Eigen::Vector3d& velocity) {
    return velocity + Eigen::Vector3d(0, 0, earth_rotation_rate).cross(position);
}

LineOfSightShares line_of_sight_shares(const SatelliteInView& satellite, const TruthState& truth) {
    const Eigen::Vector3d position = satellite.position_at_transmission.vector();
    const Eigen::Vector3d velocity = inertial_velocity(position, satellite.velocity_at_transmission.vector());
    const Eigen::Vector3d normal = position.cross(velocity);
    const double turning = normal.norm();
    if (turning == 0) return {};  // a sky of directions alone
    Eigen::Matrix3d axes;         // rows radial, along, cross
    axes.row(0) = position.normalized();
    axes.row(2) = normal / turning;
    axes.row(1) = axes.row(2).cross(axes.row(0));
    const Eigen::Vector3d ray = position - truth.position.vector();
    const double range = ray.norm();
    const Eigen::Vector3d sight = ray / range;
    const Eigen::Vector3d moving = velocity - inertial_velocity(truth.position.vector(), truth.velocity.vector());
    const Eigen::Vector3d sight_rate = (moving - sight * sight.dot(moving)) / range;

    LineOfSightShares shares{axes * sight, axes * sight_rate};
    // The axes turn with the orbit, about its normal.
    const double orbit_rate = turning / position.squaredNorm();
    shares.rate += orbit_rate * Eigen::Vector3d(shares.share.y(), -shares.share.x(), 0);
    return shares;
}

// What precise products tell goes on smoothly: all of it makes up for what the record gets wrong and for its changes.
void take_products(Arrival& arrival, const RecordError& error, double factor) {
    arrival.signal_in_space_error = factor * error.range;
    arrival.range_rate_error = factor * error.range_rate;
    arrival.earlier_records = {arrival.signal_in_space_error, arrival.range_rate_error, std::nullopt};
}

}  // namespace

SisreWeights sisre_weights(SatelliteId satellite) {
    constexpr SisreWeights geosynchronous{0.99, 1. / 126};
    switch (satellite.constellation) {
        case Constellation::galileo:
            return {0.98, 1. / 61};
        case Constellation::glonass:
            return {0.98, 1. / 45};
        case Constellation::beidou:
            return is_beidou_medium_orbit(satellite.number) ? SisreWeights{0.98, 1. / 54} : geosynchronous;
        case Constellation::gps:
            return {};
        default:
            return geosynchronous;
    }
}

Metres sisre(const OrbitClockSigmas& s, const SisreWeights& w) {
    return Metres(std::sqrt(w.radial * w.radial * s.radial * s.radial + s.clock * s.clock +
                            w.tangential * (s.along * s.along + s.cross * s.cross)));
}

OrbitClockSigmas orbit_clock_sigmas(SatelliteId satellite, const SignalInSpaceParameters& parameters) {
    const double factor =
        of_system(parameters, satellite).value() / sisre(typical_sigmas, sisre_weights(satellite)).value();
    return {typical_sigmas.radial * factor, typical_sigmas.along * factor, typical_sigmas.cross * factor,
            typical_sigmas.clock * factor};
}

SignalInSpaceError::Parts SignalInSpaceError::parts_of(SatelliteId satellite) const {
    const OrbitClockSigmas sigmas = orbit_clock_sigmas(satellite, parameters_);
    const auto process = [&](const char* part, double sigma) {
        return KnottedProcess({sigma, parameters_.correlation_time}, orbit_error_spacing,
                              term_.stream(seed_, "signal_in_space." + to_string(satellite) + "." + part));
    };
    return {process("radial", sigmas.radial), process("along", sigmas.along), process("cross", sigmas.cross),
            process("clock", sigmas.clock)};
}

void SignalInSpaceError::apply(Arrivals& arrivals, const SkyView& sky, const TruthState& truth) {
    const double factor = term_.factor();
    if (factor == 0) return;
    for_each_arrival(arrivals, sky, [&](Arrival& arrival, const SatelliteInView& satellite) {
        if (satellite.record_error) {
            take_products(arrival, *satellite.record_error, factor);
            return;
        }
        Parts& parts = parts_.of(satellite.id, [this](SatelliteId id) { return parts_of(id); });
        const Eigen::Vector3d orbit(parts.radial.at(truth.time), parts.along.at(truth.time),
                                    parts.cross.at(truth.time));
        const Eigen::Vector3d orbit_rate(parts.radial.rate(), parts.along.rate(), parts.cross.rate());
        const double clock = parts.clock.at(truth.time);
        const auto [share, share_rate] = line_of_sight_shares(satellite, truth);
        // Not scaled: it is what joins the records.
        arrival.earlier_records = satellite.earlier_records;
        arrival.signal_in_space_error = Metres(factor * (share.dot(orbit) - clock)) + arrival.earlier_records.range;
        arrival.range_rate_error =
            MetresPerSecond(factor * (share.dot(orbit_rate) + share_rate.dot(orbit) - parts.clock.rate())) +
            arrival.earlier_records.range_rate;
    });
}

}  // namespace skyloop::inline world
