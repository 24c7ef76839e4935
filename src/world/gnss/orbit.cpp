#include "world/gnss/orbit.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "world/gnss/constants.hpp"

namespace skyloop::inline world {
namespace {

// What differs between the systems of Kepler-type records.
struct OrbitConstants {
    double gravity;        // m³/s²
    double rotation;       // rad/s
    Nanoseconds week_lag;  // the system's weeks begin so much after those of GPST
};

OrbitConstants orbit_constants(Constellation constellation) {
    switch (constellation) {
        case Constellation::galileo:
            return {gravitational_constant_galileo, earth_rotation_rate, Nanoseconds(0)};
        case Constellation::beidou:
            return {gravitational_constant_beidou, earth_rotation_rate_beidou, bdt_lag};
        default:
            return {gravitational_constant_gps, earth_rotation_rate, Nanoseconds(0)};
    }
}

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

// The Earth's rotation since toe, of a geostationary BeiDou satellite, is applied after the tilt of its frame.
PlaneState plane_state(const KeplerEphemeris& eph, const OrbitConstants& constants, double tk, double anomaly,
                       double anomaly_dot) {
    const double a = eph.sqrt_a * eph.sqrt_a + eph.axis_rate * tk;
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
    const double r_dot =
        a * e * sin_e * anomaly_dot + 2 * phi_dot * (eph.crs * c2 - eph.crc * s2) + eph.axis_rate * (1 - e * cos_e);

    PlaneState p{};
    p.x = r * std::cos(u);
    p.y = r * std::sin(u);
    p.x_dot = r_dot * std::cos(u) - p.y * u_dot;
    p.y_dot = r_dot * std::sin(u) + p.x * u_dot;
    p.inclination = eph.i0 + eph.idot * tk + eph.cis * s2 + eph.cic * c2;
    p.inclination_dot = eph.idot + 2 * phi_dot * (eph.cis * c2 - eph.cic * s2);
    const double toe_of_week = week_and_tow(eph.toe - constants.week_lag).tow_seconds();
    p.node_dot = eph.omega_dot - (is_beidou_geo(eph.satellite) ? 0 : constants.rotation);
    p.node = eph.omega0 + p.node_dot * tk - constants.rotation * toe_of_week;
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

// From the frame in which the orbit of a geostationary BeiDou satellite is given: r = Rz(ω t_k) Rx(−5°) r_g.
void rotate_geostationary(double rotation, double tk, SatelliteState& state) {
    constexpr double tilt = -5 * std::numbers::pi / 180;
    const double st = std::sin(tilt);
    const double ct = std::cos(tilt);
    const double sr = std::sin(rotation * tk);
    const double cr = std::cos(rotation * tk);
    const auto turned = [&](const Eigen::Vector3d& v) {
        const double y = v.y() * ct + v.z() * st;
        const double z = -v.y() * st + v.z() * ct;
        return Eigen::Vector3d(v.x() * cr + y * sr, -v.x() * sr + y * cr, z);
    };
    const Eigen::Vector3d r = turned(state.position.vector());
    const Eigen::Vector3d v = turned(state.velocity.vector());
    state.position = Position<Ecef>(r);
    state.velocity = {v.x() + rotation * r.y(), v.y() - rotation * r.x(), v.z()};
}

Eigen::Vector3d vector_of(const std::array<double, 3>& a) { return {a[0], a[1], a[2]}; }

// Position and velocity of a GLONASS satellite, m and m/s.
struct Motion {
    Eigen::Vector3d position;
    Eigen::Vector3d velocity;
};
Motion operator+(const Motion& a, const Motion& b) { return {a.position + b.position, a.velocity + b.velocity}; }
Motion operator*(double k, const Motion& m) { return {k * m.position, k * m.velocity}; }

// The derivative of a motion in the turning frame of the Earth: central gravity, its second zonal harmonic, the frame's
// rotation, and Moon and Sun.
Motion motion_rate(const Motion& m, const Eigen::Vector3d& moon_and_sun) {
    constexpr double rate = earth_rotation_rate_glonass;
    const Eigen::Vector3d& p = m.position;
    const double r2 = p.squaredNorm();
    const double r3 = r2 * std::sqrt(r2);
    const double gravity = -gravitational_constant_glonass / r3;
    const double oblateness = 1.5 * second_zonal_harmonic_glonass * gravitational_constant_glonass *
                              equatorial_radius_glonass * equatorial_radius_glonass / (r3 * r2);
    const double polar = 5 * p.z() * p.z() / r2;
    const double equatorial = gravity - oblateness * (1 - polar) + rate * rate;
    return {m.velocity, moon_and_sun + Eigen::Vector3d(equatorial * p.x() + 2 * rate * m.velocity.y(),
                                                       equatorial * p.y() - 2 * rate * m.velocity.x(),
                                                       (gravity - oblateness * (3 - polar)) * p.z())};
}

Motion integrated(Motion m, const Eigen::Vector3d& moon_and_sun, double span) {
    constexpr double longest_step = 60;
    // Whole steps first, so that neighbouring instants share them: the orbit has no kinks.
    for (double left = span; left != 0;) {
        const double h = std::clamp(left, -longest_step, longest_step);
        left -= h;
        const Motion k1 = motion_rate(m, moon_and_sun);
        const Motion k2 = motion_rate(m + 0.5 * h * k1, moon_and_sun);
        const Motion k3 = motion_rate(m + 0.5 * h * k2, moon_and_sun);
        const Motion k4 = motion_rate(m + h * k3, moon_and_sun);
        m = m + (h / 6) * (k1 + 2 * k2 + 2 * k3 + k4);
    }
    return m;
}

}  // namespace

SatelliteState satellite_state(const KeplerEphemeris& eph, GpsTime time, Seconds offset) {
    const OrbitConstants constants = orbit_constants(eph.satellite.constellation);
    const double tk = difference(time, eph.toe).value() + offset.value();
    const double tc = difference(time, eph.toc).value() + offset.value();
    const double a = eph.sqrt_a * eph.sqrt_a;
    const double n = std::sqrt(constants.gravity / (a * a * a)) + eph.delta_n;
    const double anomaly = eccentric_anomaly(eph.m0 + (n + 0.5 * eph.delta_n_rate * tk) * tk, eph.e);
    const double anomaly_dot = (n + eph.delta_n_rate * tk) / (1 - eph.e * std::cos(anomaly));

    SatelliteState state;
    rotate_to_ecef(plane_state(eph, constants, tk, anomaly, anomaly_dot), state);
    if (is_beidou_geo(eph.satellite)) rotate_geostationary(constants.rotation, tk, state);

    // F = −2√μ/c² (IS-GPS-200, 20.3.3.3.3.1).
    const double f = -2 * std::sqrt(constants.gravity) / (speed_of_light * speed_of_light);
    state.relativistic_bias = f * eph.e * eph.sqrt_a * std::sin(anomaly);
    state.clock_bias = eph.af0 + eph.af1 * tc + eph.af2 * tc * tc + state.relativistic_bias;
    state.clock_drift = eph.af1 + 2 * eph.af2 * tc + f * eph.e * eph.sqrt_a * std::cos(anomaly) * anomaly_dot;
    return state;
}

SatelliteState satellite_state(const GlonassEphemeris& eph, GpsTime time, Seconds offset) {
    const double t = difference(time, eph.toe).value() + offset.value();
    const Motion m =
        integrated({vector_of(eph.position_m), vector_of(eph.velocity_mps)}, vector_of(eph.acceleration_mps2), t);
    return {Position<Ecef>(m.position), Velocity<Ecef>(m.velocity.x(), m.velocity.y(), m.velocity.z()),
            eph.clock_bias + eph.clock_drift * t, eph.clock_drift, 0};
}

SatelliteState satellite_state(const SbasEphemeris& eph, GpsTime time, Seconds offset) {
    const double t = difference(time, eph.toe).value() + offset.value();
    const Eigen::Vector3d acceleration = vector_of(eph.acceleration_mps2);
    const Eigen::Vector3d velocity = vector_of(eph.velocity_mps) + t * acceleration;
    const Eigen::Vector3d position =
        vector_of(eph.position_m) + t * vector_of(eph.velocity_mps) + 0.5 * t * t * acceleration;
    return {Position<Ecef>(position), Velocity<Ecef>(velocity.x(), velocity.y(), velocity.z()),
            eph.clock_bias + eph.clock_drift * t, eph.clock_drift, 0};
}

SatelliteState satellite_state(const Ephemeris& ephemeris, GpsTime time, Seconds offset) {
    return std::visit([&](const auto& e) { return satellite_state(e, time, offset); }, ephemeris);
}

Ephemeris carried_to(const Ephemeris& ephemeris, GpsTime time) {
    const auto* glonass = std::get_if<GlonassEphemeris>(&ephemeris);
    if (glonass == nullptr) return ephemeris;
    const SatelliteState state = satellite_state(*glonass, time);
    GlonassEphemeris carried = *glonass;
    carried.toe = time;
    for (std::size_t i = 0; i < 3; ++i) {
        carried.position_m[i] = state.position.vector()[static_cast<Eigen::Index>(i)];
        carried.velocity_mps[i] = state.velocity.vector()[static_cast<Eigen::Index>(i)];
    }
    carried.clock_bias = state.clock_bias;
    return carried;
}

KeplerEphemeris carried_almanac(const KeplerEphemeris& record, GpsTime time) {
    const double passed = difference(time, record.toe).value();
    // The node's longitude counts from the start of the week.
    const auto weeks = static_cast<double>(week_and_tow(record.toe).week - week_and_tow(time).week);
    const double turned = earth_rotation_rate * static_cast<double>(seconds_per_week) * weeks;
    const double motion =
        std::sqrt(orbit_constants(record.satellite.constellation).gravity) / std::pow(record.sqrt_a, 3) +
        record.delta_n;
    const auto circle = [](double angle) { return std::remainder(angle, 2 * std::numbers::pi); };
    KeplerEphemeris carried = record;
    carried.toe = carried.toc = time;
    carried.i0 = record.i0 + record.idot * passed;
    carried.omega0 = circle(record.omega0 + record.omega_dot * passed + turned);
    carried.m0 = circle(record.m0 + motion * passed);
    carried.af0 = record.af0 + record.af1 * difference(time, record.toc).value();
    return carried;
}

namespace {

bool same_record(const GlonassEphemeris& a, const GlonassEphemeris& b) {
    return a.toe == b.toe && a.position_m == b.position_m && a.velocity_mps == b.velocity_mps &&
           a.acceleration_mps2 == b.acceleration_mps2 && a.clock_bias == b.clock_bias && a.clock_drift == b.clock_drift;
}

}  // namespace

const GlonassEphemeris& CarriedRecords::at(const GlonassEphemeris& record, GpsTime time) {
    const auto minutes = std::chrono::duration_cast<std::chrono::minutes>(time - record.toe);
    const GpsTime base = record.toe + minutes;
    Carried& kept = carried_[record.satellite];
    if (!same_record(kept.origin, record) || kept.record.toe != base) {
        kept.origin = record;
        kept.record = std::get<GlonassEphemeris>(carried_to(record, base));
    }
    return kept.record;
}

KeplerEphemeris ephemeris_of_almanac(const KeplerEphemeris& almanac, GpsTime time) {
    const std::int64_t number = (time.time_since_epoch() + ephemeris_spacing / 2) / ephemeris_spacing;
    KeplerEphemeris record = carried_almanac(almanac, GpsTime(number * ephemeris_spacing));
    constexpr std::int64_t issues = 256;
    constexpr double usual_accuracy_m = 2.4, usual_fit_h = 4;
    record.message = NavigationMessage::lnav;
    record.iode = record.iodc = static_cast<int>(number % issues);
    // In the run the almanac is the truth.
    record.accuracy_m = usual_accuracy_m;
    // Of QZSS a flag, whose 0 is its usual two hours.
    record.fit_interval_h = record.satellite.constellation == Constellation::qzss ? 0 : usual_fit_h;
    return record;
}

}  // namespace skyloop::inline world
