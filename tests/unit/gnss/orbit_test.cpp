#include "skyloop/gnss/orbit.hpp"

#include <gtest/gtest.h>

#include "support/oracle_table.hpp"

namespace skyloop::test {
namespace {

KeplerEphemeris oracle_ephemeris(const OracleRow& row) {
    KeplerEphemeris e;
    e.satellite = parse_satellite(row.text("sat")).value();
    e.toc = to_gps_time(row.integer("toc_week"), row.number("toc_tow_s"));
    e.toe = to_gps_time(row.integer("toe_week"), row.number("toe_tow_s"));
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
    return e;
}

// Checks the GPS and QZSS rows of a table of broadcast orbits; gives how many there were.
int check_orbits(const std::string& table) {
    int checked = 0;
    for (const OracleRow& row : oracle_rows(table)) {
        if (row.text("sys") != "GPS" && row.text("sys") != "QZS") continue;
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
    EXPECT_EQ(check_orbits("orbit_kepler.csv"), shared_oracles_present() ? 56 : 4);
}

TEST(Orbit, AgreesWithTheOracleAcrossTheEndOfTheWeek) {
    EXPECT_EQ(check_orbits("orbit_week_rollover.csv"), shared_oracles_present() ? 3 : 2);
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
    const KeplerEphemeris e = oracle_ephemeris(oracle_rows("orbit_kepler.csv").front());
    for (const int minutes : {-110, -30, 0, 45, 115}) {
        const GpsTime t = e.toe + std::chrono::minutes(minutes);
        const Displacement<Ecef> step =
            satellite_state(e, t, Seconds(0.5)).position - satellite_state(e, t, Seconds(-0.5)).position;
        EXPECT_LT((step.vector() - satellite_state(e, t).velocity.vector()).norm(), 1e-4);
    }
}

}  // namespace
}  // namespace skyloop::test
