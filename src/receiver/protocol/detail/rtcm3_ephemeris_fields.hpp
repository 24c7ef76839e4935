/// The fields of RTCM 3's messages of ephemerides in their order, once for writing, reading and listing
/// (RTCM 10403.3, tables 3.5-21 and following).
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string_view>

#include "world/gnss/ephemeris.hpp"

namespace skyloop::inline receiver {

/// A record and what its message tells beside it, as the fields have it.
struct KeplerFields {
    KeplerEphemeris r;
    std::int64_t satellite = 0, week = 0, accuracy = 0, toe = 0, toc = 0, issue = 0, clock_issue = 0;
    std::int64_t health = 0, codes_on_l2 = 0, l2p_data_off = 0, fit = 0;  ///< of GPS, QZSS, NavIC and BeiDou
    std::int64_t e1_status = 0, e1_invalid = 0, e5a_status = 0, e5a_invalid = 0, e5b_status = 0, e5b_invalid = 0;
};

/// The same of GLONASS, as the strings of its satellites have it (ICD L1, L2 GLONASS 5.1, table 4.5).
struct GlonassFields {
    GlonassEphemeris r;
    double tau = 0;  ///< s: minus the clock's bias
    std::int64_t satellite = 0, channel = 0, almanac_health = 0, almanac_health_told = 0, p1 = 0, hours = 0,
                 minutes = 0;
    std::int64_t half_minute = 0, malfunction = 0, p2 = 0, reference = 0, p3 = 0, p = 0, unhealthy = 0, age = 0, p4 = 0;
    std::int64_t accuracy = 0, day = 0, kind = 0, more = 0, unhealthy_fifth = 0, four_years = 0;
};

constexpr double sc = std::numbers::pi;  ///< a semicircle, rad
inline double step(int exponent) { return std::ldexp(1.0, exponent); }

/// How the systems' harmonic corrections and times differ.
struct OrbitWidths {
    int angle_bits = 16, angle_exponent = -29, radius_bits = 16, radius_exponent = -5, toe_bits = 16, toe_step_s = 16;
};

/// A visitor has whole(name, number, width), time(name, steps, width, step in seconds), scaled(name, value, width,
/// step) and unsigned_scaled of the same form, circle(name, radians) of 32 bits of 2^-31 semicircles, magnitude(name,
/// value, width, step) of a sign and a magnitude, and skip(width). Times are whole numbers of their step.
template <class Visitor>
void orbit_fields(Visitor& v, KeplerFields& m, const OrbitWidths& w) {
    v.scaled("crs_m", m.r.crs, w.radius_bits, step(w.radius_exponent));
    v.scaled("delta_n_radps", m.r.delta_n, 16, sc * step(-43));
    v.circle("m0_rad", m.r.m0);
    v.scaled("cuc_rad", m.r.cuc, w.angle_bits, step(w.angle_exponent));
    v.unsigned_scaled("eccentricity", m.r.e, 32, step(-33));
    v.scaled("cus_rad", m.r.cus, w.angle_bits, step(w.angle_exponent));
    v.unsigned_scaled("sqrt_a", m.r.sqrt_a, 32, step(-19));
    v.time("toe_s", m.toe, w.toe_bits, w.toe_step_s);
    v.scaled("cic_rad", m.r.cic, w.angle_bits, step(w.angle_exponent));
    v.circle("omega0_rad", m.r.omega0);
    v.scaled("cis_rad", m.r.cis, w.angle_bits, step(w.angle_exponent));
    v.circle("i0_rad", m.r.i0);
    v.scaled("crc_m", m.r.crc, w.radius_bits, step(w.radius_exponent));
    v.circle("omega_rad", m.r.omega);
    v.scaled("omega_dot_radps", m.r.omega_dot, 24, sc * step(-43));
}

template <class Visitor>
void lnav_clock_fields(Visitor& v, KeplerFields& m) {
    v.time("toc_s", m.toc, 16, 16);
    v.scaled("af2_sps2", m.r.af2, 8, step(-55));
    v.scaled("af1_sps", m.r.af1, 16, step(-43));
    v.scaled("af0_s", m.r.af0, 22, step(-31));
}

/// 1019.
template <class Visitor>
void gps_fields(Visitor& v, KeplerFields& m) {
    v.whole("satellite", m.satellite, 6);
    v.whole("week", m.week, 10);
    v.whole("accuracy", m.accuracy, 4);
    v.whole("codes_on_l2", m.codes_on_l2, 2);
    v.scaled("idot_radps", m.r.idot, 14, sc * step(-43));
    v.whole("iode", m.issue, 8);
    lnav_clock_fields(v, m);
    v.whole("iodc", m.clock_issue, 10);
    orbit_fields(v, m, {});
    v.scaled("tgd_s", m.r.tgd, 8, step(-31));
    v.whole("health", m.health, 6);
    v.whole("l2p_data_off", m.l2p_data_off, 1);
    v.whole("fit", m.fit, 1);
}

/// 1044.
template <class Visitor>
void qzss_fields(Visitor& v, KeplerFields& m) {
    v.whole("satellite", m.satellite, 4);
    lnav_clock_fields(v, m);
    v.whole("iode", m.issue, 8);
    orbit_fields(v, m, {});
    v.scaled("idot_radps", m.r.idot, 14, sc * step(-43));
    v.whole("codes_on_l2", m.codes_on_l2, 2);
    v.whole("week", m.week, 10);
    v.whole("accuracy", m.accuracy, 4);
    v.whole("health", m.health, 6);
    v.scaled("tgd_s", m.r.tgd, 8, step(-31));
    v.whole("iodc", m.clock_issue, 10);
    v.whole("fit", m.fit, 1);
}

/// 1042.
template <class Visitor>
void beidou_fields(Visitor& v, KeplerFields& m) {
    v.whole("satellite", m.satellite, 6);
    v.whole("week", m.week, 13);
    v.whole("accuracy", m.accuracy, 4);
    v.scaled("idot_radps", m.r.idot, 14, sc * step(-43));
    v.whole("aode", m.issue, 5);
    v.time("toc_s", m.toc, 17, 8);
    v.scaled("a2_sps2", m.r.af2, 11, step(-66));
    v.scaled("a1_sps", m.r.af1, 22, step(-50));
    v.scaled("a0_s", m.r.af0, 24, step(-33));
    v.whole("aodc", m.clock_issue, 5);
    orbit_fields(v, m, {18, -31, 18, -6, 17, 8});
    v.scaled("tgd1_s", m.r.tgd, 10, 1e-10);
    v.scaled("tgd2_s", m.r.tgd2, 10, 1e-10);
    v.whole("health", m.health, 1);
}

/// 1045, and 1046 with `inav`.
template <class Visitor>
void galileo_fields(Visitor& v, KeplerFields& m, bool inav) {
    v.whole("satellite", m.satellite, 6);
    v.whole("week", m.week, 12);
    v.whole("iodnav", m.issue, 10);
    v.whole("sisa", m.accuracy, 8);
    v.scaled("idot_radps", m.r.idot, 14, sc * step(-43));
    v.time("toc_s", m.toc, 14, 60);
    v.scaled("af2_sps2", m.r.af2, 6, step(-59));
    v.scaled("af1_sps", m.r.af1, 21, step(-46));
    v.scaled("af0_s", m.r.af0, 31, step(-34));
    orbit_fields(v, m, {16, -29, 16, -5, 14, 60});
    v.scaled("bgd_e1_e5a_s", m.r.tgd, 10, step(-32));
    if (!inav) {
        v.whole("e5a_health", m.e5a_status, 2);
        v.whole("e5a_invalid", m.e5a_invalid, 1);
        return v.skip(7);
    }
    v.scaled("bgd_e1_e5b_s", m.r.tgd2, 10, step(-32));
    v.whole("e5b_health", m.e5b_status, 2);
    v.whole("e5b_invalid", m.e5b_invalid, 1);
    v.whole("e1_health", m.e1_status, 2);
    v.whole("e1_invalid", m.e1_invalid, 1);
    v.skip(2);
}

/// 1041.
template <class Visitor>
void navic_fields(Visitor& v, KeplerFields& m) {
    v.whole("satellite", m.satellite, 6);
    v.whole("week", m.week, 10);
    v.scaled("af0_s", m.r.af0, 22, step(-31));
    v.scaled("af1_sps", m.r.af1, 16, step(-43));
    v.scaled("af2_sps2", m.r.af2, 8, step(-55));
    v.whole("accuracy", m.accuracy, 4);
    v.time("toc_s", m.toc, 16, 16);
    v.scaled("tgd_s", m.r.tgd, 8, step(-31));
    v.scaled("delta_n_radps", m.r.delta_n, 22, sc * step(-41));
    v.whole("iodec", m.issue, 8);
    v.skip(10);
    v.whole("health", m.health, 2);
    v.scaled("cuc_rad", m.r.cuc, 15, step(-28));
    v.scaled("cus_rad", m.r.cus, 15, step(-28));
    v.scaled("cic_rad", m.r.cic, 15, step(-28));
    v.scaled("cis_rad", m.r.cis, 15, step(-28));
    v.scaled("crc_m", m.r.crc, 15, step(-4));
    v.scaled("crs_m", m.r.crs, 15, step(-4));
    v.scaled("idot_radps", m.r.idot, 14, sc * step(-43));
    v.circle("m0_rad", m.r.m0);
    v.time("toe_s", m.toe, 16, 16);
    v.unsigned_scaled("eccentricity", m.r.e, 32, step(-33));
    v.unsigned_scaled("sqrt_a", m.r.sqrt_a, 32, step(-19));
    v.circle("omega0_rad", m.r.omega0);
    v.circle("omega_rad", m.r.omega);
    v.scaled("omega_dot_radps", m.r.omega_dot, 22, sc * step(-41));
    v.circle("i0_rad", m.r.i0);
    v.skip(4);
}

template <class Visitor>
void glonass_axis_fields(Visitor& v, GlonassFields& m, std::size_t axis) {
    constexpr double km = 1000;
    constexpr std::array<std::array<std::string_view, 3>, 3> names{{{"velocity_x_mps", "x_m", "acceleration_x_mps2"},
                                                                    {"velocity_y_mps", "y_m", "acceleration_y_mps2"},
                                                                    {"velocity_z_mps", "z_m", "acceleration_z_mps2"}}};
    v.magnitude(names[axis][0], m.r.velocity_mps[axis], 24, km * step(-20));
    v.magnitude(names[axis][1], m.r.position_m[axis], 27, km * step(-11));
    v.magnitude(names[axis][2], m.r.acceleration_mps2[axis], 5, km * step(-30));
}

/// 1020. What is not told of other instants than that of the ephemeris, DF131 being 0, is skipped.
template <class Visitor>
void glonass_fields(Visitor& v, GlonassFields& m) {
    v.whole("satellite", m.satellite, 6);
    v.whole("channel", m.channel, 5);
    v.whole("almanac_health", m.almanac_health, 1);
    v.whole("almanac_health_told", m.almanac_health_told, 1);
    v.whole("p1", m.p1, 2);
    v.whole("tk_hours", m.hours, 5);
    v.whole("tk_minutes", m.minutes, 6);
    v.whole("tk_half_minute", m.half_minute, 1);
    v.whole("malfunction", m.malfunction, 1);
    v.whole("p2", m.p2, 1);
    v.time("tb_s", m.reference, 7, 900);
    for (std::size_t axis = 0; axis < 3; ++axis)
        glonass_axis_fields(v, m, axis);
    v.whole("p3", m.p3, 1);
    v.magnitude("gamma", m.r.clock_drift, 11, step(-40));
    v.whole("p", m.p, 2);
    v.whole("unhealthy", m.unhealthy, 1);
    v.magnitude("tau_s", m.tau, 22, step(-30));
    v.magnitude("delta_tau_s", m.r.group_delay_l2, 5, step(-30));
    v.whole("age_days", m.age, 5);
    v.whole("p4", m.p4, 1);
    v.whole("accuracy", m.accuracy, 4);
    v.whole("day", m.day, 11);
    v.whole("kind", m.kind, 2);
    v.whole("additional_data", m.more, 1);
    v.skip(11 + 32);
    v.whole("four_years", m.four_years, 5);
    v.skip(22);
    v.whole("unhealthy_fifth", m.unhealthy_fifth, 1);
    v.skip(7);
}

/// The fields of the message of that number; false where it is none of an ephemeris.
template <class Visitor>
bool ephemeris_fields(Visitor& v, int number, KeplerFields& kepler, GlonassFields& glonass) {
    switch (number) {
        case 1019:
            return gps_fields(v, kepler), true;
        case 1020:
            return glonass_fields(v, glonass), true;
        case 1041:
            return navic_fields(v, kepler), true;
        case 1042:
            return beidou_fields(v, kepler), true;
        case 1044:
            return qzss_fields(v, kepler), true;
        case 1045:
        case 1046:
            return galileo_fields(v, kepler, number == 1046), true;
        default:
            return false;
    }
}

}  // namespace skyloop::inline receiver
