#include "world/propagation/sensor_model_losses.hpp"

#include <gtest/gtest.h>

#include "support/oracle_table.hpp"
#include "unit/propagation/one_satellite.hpp"

namespace skyloop {
namespace {

using test::OracleRow;

TEST(WholePathLoss, SpecificAttenuationsAreThoseOfP676AtSeaLevel) {
    const WholePathParameters p;
    int rows = 0;
    for (const OracleRow& row : test::oracle_rows("itu_p676_specific.csv")) {
        if (row.number("f_GHz") != 1.57542 || row.number("T_K") != 288.15 || row.number("p_dry_hPa") != 1013.25)
            continue;
        SCOPED_TRACE(row.id());
        ++rows;
        EXPECT_NEAR(p.oxygen_db_per_km / row.number("gamma_o_dB_km"), 1, 1e-3);
        EXPECT_NEAR(p.vapour_db_per_km_per_g_m3 * row.number("rho_g_m3"), row.number("gamma_w_dB_km"), 2e-7);
    }
    EXPECT_GT(rows, 0);
}

// Flat layers: the sine law holds high in the sky and overshoots near the horizon.
TEST(WholePathLoss, AgreesWithTheLayeredIntegrationHighInTheSky) {
    for (const OracleRow& row : test::oracle_rows("itu_p676_slant.csv")) {
        if (row.number("f_GHz") != 1.57542 || row.number("rx_h_km") != 0) continue;
        SCOPED_TRACE(row.id());
        const double elevation = row.number("el_deg");
        const double loss = whole_path_loss({}, Angle::degrees(elevation)).value();
        EXPECT_NEAR(loss / row.number("A_gas_dB"), 1, elevation >= 20 ? 0.03 : 0.1);
    }
}

TEST(WholePathLoss, WritesTheGasLossAlone) {
    test::OneSatellite scene(Angle::degrees(30), Metres(22e6), Geodetic::degrees(46, 30, 0));
    WholePathLoss effect({});
    const Arrival& arrival = scene.after(effect);
    EXPECT_EQ(arrival.gas_loss, whole_path_loss({}, Angle::degrees(30)));
    EXPECT_NEAR(arrival.gas_loss.value(), 2 * whole_path_loss({}, Angle::degrees(90)).value(), 1e-12);
    EXPECT_EQ(arrival.cloud_loss, Decibels(0));
    EXPECT_EQ(arrival.rain_loss, Decibels(0));
}

}  // namespace
}  // namespace skyloop
