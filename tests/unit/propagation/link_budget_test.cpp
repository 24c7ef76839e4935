#include "world/propagation/sensor_model_losses.hpp"

#include <gtest/gtest.h>

#include "support/oracle_table.hpp"
#include "unit/propagation/one_satellite.hpp"

namespace skyloop {
namespace {

using test::OneSatellite;
using test::OracleRow;

AtmosphereParameters link_row_atmosphere(const OracleRow& row) {
    AtmosphereParameters atmosphere;
    atmosphere.sea_level_temperature = Kelvin(row.number("T_sea_level_K"));
    atmosphere.layers = default_layers();
    atmosphere.layers.front().vapour_g_m3 = row.number("rho_troposphere_g_m3");
    if (row.number("cloud_rho_g_m3") > 0)
        atmosphere.clouds.push_back({row.text("cloud"), Metres(row.number("cloud_base_m")),
                                     Metres(row.number("cloud_top_m")), row.number("cloud_rho_g_m3")});
    atmosphere.ionosphere_loss = Decibels(row.number("L_iono_dB"));
    atmosphere.environment_noise = Decibels(row.number("ambient_extra_dB"));
    return atmosphere;
}

TEST(LinkBudget, EveryOracleRow) {
    for (const OracleRow& row : test::oracle_rows("paper_link_budget.csv")) {
        SCOPED_TRACE(row.id());
        const AtmosphereParameters atmosphere = link_row_atmosphere(row);
        LinkBudgetParameters link;
        link.satellite_power = DecibelWatts(row.number("p_sat_dBW"));
        OneSatellite scene(Angle::degrees(row.number("el_deg")), Metres(row.number("distance_m")),
                           Geodetic::degrees(46, 30, row.number("rx_h_m")));
        scene.arrival().reflections = static_cast<int>(row.integer("n_reflections"));
        LayeredAtmosphereLoss air(atmosphere);
        LinkBudget budget(link, atmosphere.environment_noise);
        scene.after(air);
        const Arrival& arrival = scene.after(budget);

        const double tolerance = row.number("tol_dB");
        EXPECT_NEAR(arrival.free_space_loss.value(), row.number("L_s_dB"), tolerance);
        EXPECT_NEAR(arrival.gas_loss.value(), row.number("L_atm_dB"), tolerance);
        EXPECT_NEAR(arrival.cloud_loss.value(), row.number("L_clouds_dB"), tolerance);
        EXPECT_NEAR(arrival.reflection_loss.value(), row.number("L_reflections_dB"), tolerance);
        ASSERT_TRUE(arrival.received_power);
        EXPECT_NEAR(arrival.received_power->value(), row.number("P_rec_dBW"), tolerance);
        EXPECT_NEAR(budget.noise_density_dbw_hz(), row.number("P_ambient_dBW"), tolerance);
        ASSERT_TRUE(arrival.cn0);
        EXPECT_NEAR(arrival.cn0->value(), row.number("snr_dB"), tolerance);
        EXPECT_EQ(*arrival.cn0 >= DbHz(5), row.integer("accepted") == 1);
    }
}

TEST(LinkBudget, ReceivedSpecificationReplacesPowerAndDistance) {
    LinkBudgetParameters link;
    link.power_mode = PowerMode::received_spec;
    LinkBudget budget(link, Decibels(1));
    OneSatellite near(Angle::degrees(80), Metres(20.2e6), Geodetic::degrees(46, 30, 0));
    OneSatellite far(Angle::degrees(5), Metres(25.5e6), Geodetic::degrees(46, 30, 0));
    EXPECT_NEAR(near.after(budget).cn0->value(), -158.5 + 203, 1e-9);
    EXPECT_EQ(near.after(budget).cn0, far.after(budget).cn0);
}

TEST(LinkBudget, HiddenSatelliteHasNoSignal) {
    LinkBudget budget({}, Decibels(1));
    OneSatellite scene(Angle::degrees(40), Metres(21e6), Geodetic::degrees(46, 30, 0));
    scene.arrival().paths = 0;
    scene.arrival().line_of_sight = false;
    EXPECT_FALSE(scene.after(budget).cn0);
    EXPECT_FALSE(scene.after(budget).received_power);
}

TEST(LinkBudget, APathWithTooManyReflectionsIsNone) {
    for (const int most : {0, 3, 16}) {
        LinkBudgetParameters link;
        link.max_reflections = most;
        LinkBudget budget(link, Decibels(1));
        for (const int more : {0, 1}) {
            OneSatellite scene(Angle::degrees(40), Metres(21e6), Geodetic::degrees(46, 30, 0));
            scene.arrival().line_of_sight = false;
            scene.arrival().reflections = most + more;
            scene.arrival().excess_path = Metres(30);
            const Arrival& arrival = scene.after(budget);
            EXPECT_EQ(arrival.paths, 1 - more);
            EXPECT_EQ(arrival.cn0.has_value(), more == 0);
            EXPECT_EQ(arrival.received_power.has_value(), more == 0);
            EXPECT_EQ(arrival.excess_path, Metres(more == 0 ? 30 : 0));
            EXPECT_EQ(reception_of(arrival), more == 0 ? Reception::reflected : Reception::blocked);
        }
    }
}

}  // namespace
}  // namespace skyloop
