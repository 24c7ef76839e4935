#include "world/propagation/specific_attenuation.hpp"

#include <gtest/gtest.h>

#include "support/oracle_table.hpp"
#include "world/gnss/constants.hpp"

namespace skyloop {
namespace {

TEST(CloudAttenuation, EveryOracleRow) {
    for (const test::OracleRow& row : test::oracle_rows("itu_p840_cloud.csv")) {
        SCOPED_TRACE(row.id());
        const Hertz carrier(row.number("f_GHz") * 1e9);
        const Kelvin temperature(row.number("T_C") + 273.15);
        const double tolerance = row.number("tol_rel");
        const auto water = water_permittivity_p840(carrier, temperature);
        EXPECT_NEAR(water.real() / row.number("eps_real"), 1, tolerance);
        EXPECT_NEAR(water.imag() / row.number("eps_imag"), 1, tolerance);
        EXPECT_NEAR(cloud_liquid_coefficient_p840(carrier, temperature) / row.number("K_l"), 1, tolerance);
        const DecibelsPerKilometre gamma = cloud_attenuation_p840(carrier, temperature, row.number("liquid_g_m3"));
        EXPECT_NEAR(gamma.value() / row.number("gamma_c_dB_km"), 1, tolerance);
        const Decibels loss = loss_over(gamma, Metres(row.number("path_km") * 1000));
        EXPECT_NEAR(loss.value() / row.number("A_cloud_dB"), 1, tolerance);
    }
}

TEST(CloudAttenuation, OfAThunderstormIsLessThanADecibel) {
    const DecibelsPerKilometre gamma = cloud_attenuation_p840(Hertz(carrier_frequency_l1), Kelvin(273.15), 3);
    EXPECT_NEAR(loss_over(gamma, Metres(10000)).value(), 0.07, 0.005);
}

}  // namespace
}  // namespace skyloop
