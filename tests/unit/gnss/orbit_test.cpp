#include "world/gnss/orbit.hpp"

#include <gtest/gtest.h>

#include "base/time/utc_time.hpp"
#include "support/oracle_table.hpp"

namespace skyloop::test {
namespace {

NavigationMessage oracle_message(const std::string& name) {
    if (name == "INAV") return NavigationMessage::inav;
    if (name == "FNAV") return NavigationMessage::fnav;
    if (name == "D1") return NavigationMessage::d1;
    return name == "D2" ? NavigationMessage::d2 : NavigationMessage::lnav;
}

KeplerEphemeris oracle_ephemeris(const OracleRow& row) {
    KeplerEphemeris e;
    e.satellite = parse_satellite(row.text("sat")).value();
    // BeiDou's weeks began 1356 weeks after those of GPS, and its time runs 14 s behind.
    const bool bdt = row.text("time_scale_of_eph") == "BDT";
    const auto time = [&](const std::string& name) {
        const double tow = row.number(name + "_tow_s") + (bdt ? 14 : 0);
        return to_gps_time(row.integer(name + "_week") + (bdt ? 1356 : 0), tow);
    };
    e.toc = time("toc");
    e.toe = time("toe");
    e.af0 = row.number("af0_s");
    e.af1 = row.number("af1_s_per_s");
    e.af2 = row.number("af2_s_per_s2");
    e.iode = static_cast<int>(row.integer("iode"));
    e.sqrt_a = row.number("sqrtA_sqrt_m");
    e.e = row.number("e");
    e.m0 = row.number("M0_rad");
    e.delta_n = row.number("deltan_rad_per_s");
    e.i0 = row.number("i0_rad");
    e.idot = row.number("idot_rad_per_s");
    e.omega0 = row.number("OMEGA0_rad");
    e.omega_dot = row.number("OMEGADOT_rad_per_s");
    e.omega = row.number("omega_rad");
    e.cuc = row.number("cuc_rad");
    e.cus = row.number("cus_rad");
    e.crc = row.number("crc_m");
    e.crs = row.number("crs_m");
    e.cic = row.number("cic_rad");
    e.cis = row.number("cis_rad");
    e.tgd = row.number("tgd1_s");
    e.tgd2 = row.number("tgd2_s");
    e.message = oracle_message(row.text("msg"));
    return e;
}

// Checks the rows of a table of broadcast orbits; gives how many there were.
int check_orbits(const std::string& table) {
    int checked = 0;
    for (const OracleRow& row : oracle_rows(table)) {
        SCOPED_TRACE(row.id());
        ++checked;
        const GpsTime time = to_gps_time(row.integer("t_gpst_week"), row.number("t_gpst_tow_s"));
        const SatelliteState state = satellite_state(oracle_ephemeris(row), time);
        const double position = row.number("tol_pos_m");
        EXPECT_NEAR(state.position.vector().x(), row.number("x_m"), position);
        EXPECT_NEAR(state.position.vector().y(), row.number("y_m"), position);
        EXPECT_NEAR(state.position.vector().z(), row.number("z_m"), position);
        const double velocity = row.number("tol_vel_m_s");
        EXPECT_NEAR(state.velocity.vector().x(), row.number("vx_m_s"), velocity);
        EXPECT_NEAR(state.velocity.vector().y(), row.number("vy_m_s"), velocity);
        EXPECT_NEAR(state.velocity.vector().z(), row.number("vz_m_s"), velocity);
        const double clock = row.number("tol_clk_s");
        EXPECT_NEAR(state.clock_bias, row.number("clk_s"), clock);
        EXPECT_NEAR(state.relativistic_bias, row.number("clk_rel_s"), clock);
        EXPECT_NEAR(state.clock_drift, row.number("clk_drift_s_s"), 1e-17);
    }
    return checked;
}

TEST(Orbit, AgreesWithTheBroadcastOrbitOracle) {
    EXPECT_EQ(check_orbits("orbit_kepler.csv"), shared_oracles_present() ? 176 : 9);
}

TEST(Orbit, AgreesWithTheOracleAcrossTheEndOfTheWeek) {
    EXPECT_EQ(check_orbits("orbit_week_rollover.csv"), shared_oracles_present() ? 18 : 3);
}

// An almanac is an ephemeris without corrections whose node, too, is that of the start of the week.
TEST(Orbit, AgreesWithTheAlmanacOracle) {
    for (const OracleRow& row : oracle_rows("orbit_almanac.csv")) {
        SCOPED_TRACE(row.id());
        KeplerEphemeris e;
        e.satellite = parse_satellite(row.text("sat")).value();
        e.toe = e.toc = to_gps_time(row.integer("week"), row.number("toa_s"));
        e.sqrt_a = row.number("sqrtA");
        e.e = row.number("e");
        e.i0 = row.number("i_rad");
        e.omega0 = row.number("OMEGA0_week_rad");
        e.omega_dot = row.number("OMEGADOT_rad_s");
        e.omega = row.number("omega_rad");
        e.m0 = row.number("M0_rad");
        e.af0 = row.number("af0_s");
        e.af1 = row.number("af1_s_s");
        const SatelliteState state =
            satellite_state(e, to_gps_time(row.integer("t_gps_week"), row.number("t_gps_tow_s")));
        EXPECT_NEAR(state.position.vector().x(), row.number("x_m"), row.number("tol_m"));
        EXPECT_NEAR(state.position.vector().y(), row.number("y_m"), row.number("tol_m"));
        EXPECT_NEAR(state.position.vector().z(), row.number("z_m"), row.number("tol_m"));
        EXPECT_NEAR(state.clock_bias - state.relativistic_bias, row.number("clk_s"), 1e-15);
    }
}

GlonassEphemeris oracle_state_vector(const OracleRow& row) {
    GlonassEphemeris e;
    e.satellite = parse_satellite(row.text("sat")).value();
    const auto part = [&](const char* name) { return static_cast<unsigned>(row.integer(name)); };
    e.toe = to_gps_time(UtcTime{static_cast<int>(row.integer("tb_utc_y")), part("tb_utc_m"), part("tb_utc_d"),
                                part("tb_utc_h"), part("tb_utc_min"), part("tb_utc_s"), 0},
                        LeapSeconds::constant(static_cast<int>(row.integer("leap_s"))));
    e.position_m = {row.number("x0_m"), row.number("y0_m"), row.number("z0_m")};
    e.velocity_mps = {row.number("vx0_m_s"), row.number("vy0_m_s"), row.number("vz0_m_s")};
    e.acceleration_mps2 = {row.number("ax_m_s2"), row.number("ay_m_s2"), row.number("az_m_s2")};
    e.clock_bias = -row.number("tauN_s");
    e.clock_drift = row.number("gammaN");
    return e;
}

TEST(Orbit, AgreesWithTheGlonassOracle) {
    int checked = 0;
    for (const OracleRow& row : oracle_rows("orbit_glonass.csv")) {
        SCOPED_TRACE(row.id());
        const GlonassEphemeris e = oracle_state_vector(row);
        const GpsTime time = to_gps_time(row.integer("t_gpst_week"), row.number("t_gpst_tow_s"));
        EXPECT_NEAR(difference(time, e.toe).value(), row.number("dt_s"), 1e-6);
        // Carried along, it is the same orbit.
        for (const Ephemeris& record : {Ephemeris(e), carried_to(e, e.toe + (time - e.toe) / 2), carried_to(e, time)}) {
            const SatelliteState state = satellite_state(record, time);
            const double position = row.number("tol_pos_m");
            EXPECT_NEAR(state.position.vector().x(), row.number("x_m"), position);
            EXPECT_NEAR(state.position.vector().y(), row.number("y_m"), position);
            EXPECT_NEAR(state.position.vector().z(), row.number("z_m"), position);
            const double velocity = row.number("tol_vel_m_s");
            EXPECT_NEAR(state.velocity.vector().x(), row.number("vx_m_s"), velocity);
            EXPECT_NEAR(state.velocity.vector().y(), row.number("vy_m_s"), velocity);
            EXPECT_NEAR(state.velocity.vector().z(), row.number("vz_m_s"), velocity);
            EXPECT_NEAR(state.clock_bias, row.number("clk_s"), row.number("tol_clk_s"));
            EXPECT_EQ(state.clock_drift, row.number("gammaN"));
            EXPECT_EQ(state.relativistic_bias, 0);
        }
        ++checked;
    }
    EXPECT_EQ(checked, shared_oracles_present() ? 40 : 4);
}

TEST(Orbit, SbasMovesOnAParabola) {
    SbasEphemeris e;
    e.toe = to_gps_time(2243, 100.0);
    e.position_m = {3e7, -2.9e7, 1e4};
    e.velocity_mps = {1, -2, 0.5};
    e.acceleration_mps2 = {1e-3, 0, -2e-3};
    e.clock_bias = 1e-7;
    e.clock_drift = 1e-11;
    const SatelliteState state = satellite_state(e, e.toe + std::chrono::seconds(99), Seconds(1));
    EXPECT_NEAR(state.position.vector().x(), 3e7 + 100 + 5, 1e-7);
    EXPECT_NEAR(state.position.vector().y(), -2.9e7 - 200, 1e-7);
    EXPECT_NEAR(state.position.vector().z(), 1e4 + 50 - 10, 1e-7);
    EXPECT_NEAR(state.velocity.vector().x(), 1.1, 1e-12);
    EXPECT_NEAR(state.velocity.vector().z(), 0.3, 1e-12);
    EXPECT_NEAR(state.clock_bias, 1e-7 + 1e-9, 1e-20);
    EXPECT_EQ(state.clock_drift, 1e-11);
}

TEST(Orbit, OffsetMovesTimeBelowANanosecond) {
    const KeplerEphemeris e = oracle_ephemeris(oracle_rows("orbit_kepler.csv").front());
    const SatelliteState now = satellite_state(e, e.toe);
    const SatelliteState later = satellite_state(e, e.toe, Seconds(0.5e-9));
    const double moved = (later.position - now.position).length().value();
    EXPECT_NEAR(moved, now.velocity.vector().norm() * 0.5e-9, 2e-8);
    const SatelliteState second = satellite_state(e, e.toe, Seconds(1));
    EXPECT_EQ(second.position.vector(), satellite_state(e, e.toe + std::chrono::seconds(1)).position.vector());
}

TEST(Orbit, VelocityIsTheDerivativeOfPosition) {
    std::vector<Ephemeris> records;
    for (const OracleRow& row : oracle_rows("orbit_kepler.csv"))
        records.emplace_back(oracle_ephemeris(row));
    records.emplace_back(oracle_state_vector(oracle_rows("orbit_glonass.csv").front()));
    for (const Ephemeris& e : records)
        for (const int minutes : {-110, -30, 0, 45, 115}) {
            if (std::holds_alternative<GlonassEphemeris>(e) && std::abs(minutes) > 45) continue;
            const GpsTime t = toe_of(e) + std::chrono::minutes(minutes);
            const Displacement<Ecef> step =
                satellite_state(e, t, Seconds(0.5)).position - satellite_state(e, t, Seconds(-0.5)).position;
            ASSERT_LT((step.vector() - satellite_state(e, t).velocity.vector()).norm(), 1e-4)
                << to_string(satellite_of(e)) << ' ' << minutes;
        }
}

}  // namespace
}  // namespace skyloop::test
