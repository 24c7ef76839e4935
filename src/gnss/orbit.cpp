#include "skyloop/gnss/orbit.hpp"

#include <cmath>

#include "skyloop/gnss/constants.hpp"

namespace skyloop {
namespace {

// Eccentric anomaly from mean anomaly by Newton's method.
double eccentric_anomaly(double mean_anomaly, double eccentricity) {
    double anomaly = mean_anomaly + eccentricity * std::sin(mean_anomaly);
    for (int i = 0; i < 20; ++i) {
        const double step =
            (anomaly - eccentricity * std::sin(anomaly) - mean_anomaly) / (1 - eccentricity * std::cos(anomaly));
        anomaly -= step;
        if (std::abs(step) < 1e-14) break;
    }
    return anomaly;
}

// Position and velocity in the orbital plane, and the plane's orientation, with their rates.
struct PlaneState {
    double x, y, x_dot, y_dot;
    double inclination, inclination_dot;
    double node, node_dot;
};

PlaneState plane_state(const KeplerEphemeris& eph, double tk, double anomaly, double anomaly_dot) {
    const double a = eph.sqrt_a * eph.sqrt_a;
    const double e = eph.e;
    const double sin_e = std::sin(anomaly);
    const double cos_e = std::cos(anomaly);
    const double beta = std::sqrt(1 - e * e);
    const double phi = std::atan2(beta * sin_e, cos_e - e) + eph.omega;
    const double phi_dot = anomaly_dot * beta / (1 - e * cos_e);
    const double s2 = std::sin(2 * phi);
    const double c2 = std::cos(2 * phi);

    const double u = phi + eph.cus * s2 + eph.cuc * c2;
    const double u_dot = phi_dot * (1 + 2 * (eph.cus * c2 - eph.cuc * s2));
    const double r = a * (1 - e * cos_e) + eph.crs * s2 + eph.crc * c2;
    const double r_dot = a * e * sin_e * anomaly_dot + 2 * phi_dot * (eph.crs * c2 - eph.crc * s2);

    PlaneState p{};
    p.x = r * std::cos(u);
    p.y = r * std::sin(u);
    p.x_dot = r_dot * std::cos(u) - p.y * u_dot;
    p.y_dot = r_dot * std::sin(u) + p.x * u_dot;
    p.inclination = eph.i0 + eph.idot * tk + eph.cis * s2 + eph.cic * c2;
    p.inclination_dot = eph.idot + 2 * phi_dot * (eph.cis * c2 - eph.cic * s2);
    const double toe_of_week = week_and_tow(eph.toe).tow_seconds();
    p.node_dot = eph.omega_dot - earth_rotation_rate;
    p.node = eph.omega0 + p.node_dot * tk - earth_rotation_rate * toe_of_week;
    return p;
}

void rotate_to_ecef(const PlaneState& p, SatelliteState& state) {
    const double sn = std::sin(p.node);
    const double cn = std::cos(p.node);
    const double si = std::sin(p.inclination);
    const double ci = std::cos(p.inclination);
    state.position = {p.x * cn - p.y * ci * sn, p.x * sn + p.y * ci * cn, p.y * si};

    const double plane_y_dot = p.y_dot * ci - p.y * si * p.inclination_dot;
    const double vx = p.x_dot * cn - plane_y_dot * sn - state.position.vector().y() * p.node_dot;
    const double vy = p.x_dot * sn + plane_y_dot * cn + state.position.vector().x() * p.node_dot;
    state.velocity = {vx, vy, p.y_dot * si + p.y * ci * p.inclination_dot};
}

}  // namespace

SatelliteState satellite_state(const KeplerEphemeris& eph, GpsTime time, Seconds offset) {
    const double tk = difference(time, eph.toe).value() + offset.value();
    const double tc = difference(time, eph.toc).value() + offset.value();
    const double a = eph.sqrt_a * eph.sqrt_a;
    const double n = std::sqrt(gravitational_constant_gps / (a * a * a)) + eph.delta_n;
    const double anomaly = eccentric_anomaly(eph.m0 + n * tk, eph.e);
    const double anomaly_dot = n / (1 - eph.e * std::cos(anomaly));

    SatelliteState state;
    rotate_to_ecef(plane_state(eph, tk, anomaly, anomaly_dot), state);

    // F = −2√μ/c² (IS-GPS-200, 20.3.3.3.3.1).
    const double f = -2 * std::sqrt(gravitational_constant_gps) / (speed_of_light * speed_of_light);
    state.relativistic_bias = f * eph.e * eph.sqrt_a * std::sin(anomaly);
    state.clock_bias = eph.af0 + eph.af1 * tc + eph.af2 * tc * tc + state.relativistic_bias;
    state.clock_drift = eph.af1 + 2 * eph.af2 * tc + f * eph.e * eph.sqrt_a * std::cos(anomaly) * anomaly_dot;
    return state;
}

}  // namespace skyloop
