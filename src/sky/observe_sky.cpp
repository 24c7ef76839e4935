#include "skyloop/sky/observe_sky.hpp"

#include <cmath>
#include <optional>

#include "skyloop/geo/local_frame.hpp"
#include "skyloop/gnss/constants.hpp"
#include "skyloop/gnss/orbit.hpp"

namespace skyloop {
namespace {

// A signal on its way from a satellite to the antenna, in the ECEF frame of the reception instant.
struct SignalPath {
    SatelliteState transmitter;       // in the frame of the transmission instant
    Eigen::Vector3d position;         // of the transmitter
    Eigen::Vector3d velocity;         // of the transmitter, rotated but not carried along
    Eigen::Vector3d carried;          // d(position)/d(rotation angle)
    double travel_time = 0;           // s
    double range = 0;                 // m
};

// Turns coordinates into the frame that the Earth's rotation has reached after `angle` (MODELS.md 3.4, Rz).
Eigen::Vector3d rotated(const Eigen::Vector3d& v, double angle) {
    const double s = std::sin(angle);
    const double c = std::cos(angle);
    return {v.x() * c + v.y() * s, -v.x() * s + v.y() * c, v.z()};
}

SignalPath signal_path(const KeplerEphemeris& ephemeris, const TruthState& truth) {
    SignalPath path;
    path.travel_time = 0.075;
    // Each pass shrinks the error by v/c, 1e-5: from 0.1 s of travel time four passes reach the last bit.
    for (int pass = 0; pass < 5; ++pass) {
        path.transmitter = satellite_state(ephemeris, truth.time, Seconds(-path.travel_time));
        path.position = rotated(path.transmitter.position.vector(), earth_rotation_rate * path.travel_time);
        path.range = (path.position - truth.position.vector()).norm();
        const double travel_time = path.range / speed_of_light;
        const bool settled = std::abs(travel_time - path.travel_time) < 1e-15;
        path.travel_time = travel_time;
        if (settled) break;
    }
    path.velocity = rotated(path.transmitter.velocity.vector(), earth_rotation_rate * path.travel_time);
    path.carried = {path.position.y(), -path.position.x(), 0};
    return path;
}

// dρ/dt of ρ = |Rz(ω τ) r_s(t − τ) − r_r(t)| with τ = ρ/c: differentiating both sides and solving for ρ̇.
double range_rate(const SignalPath& path, const TruthState& truth) {
    const Eigen::Vector3d direction = (path.position - truth.position.vector()) / path.range;
    const double approach = direction.dot(path.velocity - truth.velocity.vector());
    const double delay = direction.dot(path.velocity - earth_rotation_rate * path.carried) / speed_of_light;
    return approach / (1 + delay);
}

std::optional<SatelliteInView> in_view(const KeplerEphemeris& ephemeris, const TruthState& truth, const LocalFrame& local) {
    const SignalPath path = signal_path(ephemeris, truth);
    const LookAngles look = local.look_angles(Position<Ecef>(path.position));
    if (!(look.elevation.rad() >= 0)) return std::nullopt;

    SatelliteInView seen;
    seen.id = ephemeris.satellite;
    seen.azimuth = look.azimuth;
    seen.elevation = look.elevation;
    seen.range = Metres(path.range);
    seen.range_rate = MetresPerSecond(range_rate(path, truth));
    seen.travel_time = Seconds(path.travel_time);
    seen.position_at_transmission = path.transmitter.position;
    seen.velocity_at_transmission = path.transmitter.velocity;
    seen.clock_bias = Seconds(path.transmitter.clock_bias);
    seen.clock_drift = path.transmitter.clock_drift;
    seen.group_delay = Seconds(ephemeris.tgd);
    seen.toe = ephemeris.toe;
    seen.iode = ephemeris.iode;
    seen.healthy = ephemeris.healthy();
    return seen;
}

}  // namespace

SkyView observe_sky(const TruthState& truth, const NavigationSource& source) {
    const LocalFrame local(truth.geodetic);
    SkyView sky;
    for (const SatelliteId satellite : source.satellites()) {
        const std::optional<KeplerEphemeris> ephemeris = source.ephemeris(satellite, truth.time);
        if (!ephemeris) continue;
        if (const std::optional<SatelliteInView> seen = in_view(*ephemeris, truth, local)) sky.satellites.push_back(*seen);
    }
    return sky;
}

}  // namespace skyloop
