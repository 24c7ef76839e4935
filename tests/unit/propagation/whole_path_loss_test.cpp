#include "world/propagation/sensor_model_losses.hpp"

#include <gtest/gtest.h>

#include "support/oracle_table.hpp"
#include "unit/propagation/one_satellite.hpp"
#include "world/propagation/gas_attenuation_p676.hpp"

namespace skyloop {
namespace {

using test::OracleRow;

// At 1013.25 hPa with the vapour, as the equivalent heights are; gas_attenuation_p676() has the oracles.
TEST(WholePathLoss, SpecificAttenuationsAreThoseOfP676AtSeaLevel) {
    const WholePathParameters p;
    const ReferenceAir sea_level{Kelvin(288.15), 1013.25, p.vapour_g_m3};
    const GasAttenuation gas = gas_attenuation_p676(sea_level, Hertz(carrier_frequency_l1));
    EXPECT_NEAR(p.oxygen_db_per_km, gas.oxygen.value(), 5e-8);
    EXPECT_NEAR(p.vapour_db_per_km_per_g_m3 * p.vapour_g_m3, gas.vapour.value(), 1e-9);
}

TEST(WholePathLoss, GrowsWithTheCarrierAsP676Has) {
    const ReferenceAir sea_level{Kelvin(288.15), 1013.25, 7.5};
    const WholePathParameters p;
    for (const double f : {1602e6, 1561.098e6, 1176.45e6}) {
        const GasAttenuation gas = gas_attenuation_p676(sea_level, Hertz(f));
        const double zenith = gas.oxygen.value() * p.oxygen_height_km + gas.vapour.value() * p.vapour_height_km;
        EXPECT_NEAR(whole_path_loss(p, Angle::degrees(90), Hertz(f)).value(), zenith, 1e-6) << f;
    }
    test::OneSatellite scene(Angle::degrees(30), Metres(22e6), Geodetic::degrees(46, 30, 0));
    scene.arrival().signals.push_back({Signal::g1, Hertz(1602e6), Seconds(0), Decibels(0)});
    WholePathLoss effect(p);
    EXPECT_EQ(scene.after(effect).gas_loss, whole_path_loss(p, Angle::degrees(30), Hertz(1602e6)));
}

// Flat layers: the sine law holds high in the sky and overshoots near the horizon.
TEST(WholePathLoss, AgreesWithTheLayeredIntegrationHighInTheSky) {
    for (const OracleRow& row : test::oracle_rows("itu_p676_slant.csv")) {
        if (row.number("f_GHz") != 1.57542 || row.number("rx_h_km") != 0) continue;
        SCOPED_TRACE(row.id());
        const double elevation = row.number("el_deg");
        const double loss = whole_path_loss({}, Angle::degrees(elevation)).value();
        EXPECT_NEAR(loss / row.number("A_gas_dB"), 1, elevation >= 20 ? 0.01 : 0.08);
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
