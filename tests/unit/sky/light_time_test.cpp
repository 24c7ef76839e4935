#include "world/sky/observe_sky.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "base/geo/local_frame.hpp"
#include "support/oracle_table.hpp"
#include "world/gnss/constants.hpp"

namespace skyloop::test {
namespace {

Position<Ecef> ecef_of(const OracleRow& row, const std::string& prefix, const std::string& suffix) {
    return {row.number(prefix + "_x" + suffix), row.number(prefix + "_y" + suffix), row.number(prefix + "_z" + suffix)};
}

// The time in which a signal from a point, given in the frame of transmission, reaches the receiver.
Seconds travel_time_between(const Position<Ecef>& transmitter, const Position<Ecef>& receiver) {
    Seconds tau(0.07);
    for (int i = 0; i < 6; ++i)
        tau = Seconds((in_reception_frame(transmitter, tau) - receiver).length().value() / speed_of_light);
    return tau;
}

TEST(LightTime, AgreesWithTheGeometryOracle) {
    for (const OracleRow& row : oracle_rows("geometry_azel_range.csv")) {
        SCOPED_TRACE(row.id());
        const LocalFrame local(
            Geodetic::degrees(row.number("rx_lat_deg"), row.number("rx_lon_deg"), row.number("rx_h_m")));
        const Position<Ecef> receiver = ecef_of(row, "rx", "_m");
        const Position<Ecef> satellite = ecef_of(row, "sat", "_m");
        const double metres = row.number("tol_m");
        const double degrees = row.number("tol_deg");

        const LookAngles direct = local.look_angles(satellite);
        EXPECT_NEAR(direct.azimuth.deg(), row.number("az_deg"), degrees);
        EXPECT_NEAR(direct.elevation.deg(), row.number("el_deg"), degrees);
        EXPECT_NEAR(direct.range.value(), row.number("r_geom_m"), metres);

        const Position<Ecef> seen_at = in_reception_frame(satellite, travel_time_between(satellite, receiver));
        const LookAngles rotated = local.look_angles(seen_at);
        EXPECT_NEAR(rotated.azimuth.deg(), row.number("az_rot_deg"), degrees);
        EXPECT_NEAR(rotated.elevation.deg(), row.number("el_rot_deg"), degrees);
        EXPECT_NEAR(rotated.range.value(), row.number("r_rot_m"), metres);
    }
}

TEST(LightTime, AgreesWithTheDopplerOracle) {
    for (const OracleRow& row : oracle_rows("doppler_moving_receiver.csv")) {
        SCOPED_TRACE(row.id());
        const Position<Ecef> receiver = ecef_of(row, "rx", "_m");
        const LocalFrame local(to_geodetic(receiver));
        const Velocity<Enu> velocity(row.number("v_east_m_s"), row.number("v_north_m_s"), row.number("v_up_m_s"));
        const Position<Ecef> satellite(row.number("sat_x_at_tx_m"), row.number("sat_y_at_tx_m"),
                                       row.number("sat_z_at_tx_m"));
        const Velocity<Ecef> motion(row.number("sat_vx_m_s"), row.number("sat_vy_m_s"), row.number("sat_vz_m_s"));
        const MetresPerSecond rate = light_time_range_rate({satellite, motion}, {receiver, local.to_ecef(velocity)},
                                                           travel_time_between(satellite, receiver));
        EXPECT_NEAR(rate.value(), row.number("range_rate_m_s"), row.number("tol_m_s"));
        const double clock_drift = row.number("sat_clk_drift_s_s");
        const double doppler = -row.number("f_Hz") * (rate.value() / speed_of_light - clock_drift);
        EXPECT_NEAR(doppler, row.number("doppler_Hz"), row.number("tol_Hz"));
    }
}

TEST(LightTime, TurnsWestwardWithTheEarth) {
    const Position<Ecef> turned = in_reception_frame(Position<Ecef>(26.56e6, 0, 1e6), Seconds(0.1));
    EXPECT_NEAR(turned.vector().y(), -26.56e6 * earth_rotation_rate * 0.1, 1e-3);
    EXPECT_EQ(turned.vector().z(), 1e6);
}

}  // namespace
}  // namespace skyloop::test
