#include "world/propagation/reference_air.hpp"

#include <gtest/gtest.h>

#include "support/oracle_table.hpp"

namespace skyloop {
namespace {

TEST(ReferenceAtmosphere, EveryOracleRow) {
    for (const test::OracleRow& row : test::oracle_rows("itu_p835_atmosphere.csv")) {
        SCOPED_TRACE(row.id());
        const ReferenceAir air = reference_atmosphere_p835(Metres(row.number("h_km") * 1000));
        const double tolerance = row.number("tol_rel");
        EXPECT_NEAR(air.temperature.value() / row.number("T_K"), 1, tolerance);
        EXPECT_NEAR(air.pressure_hpa / row.number("P_hPa"), 1, tolerance);
        EXPECT_NEAR(air.vapour_density_g_m3 / row.number("rho_g_m3"), 1, tolerance);
    }
}

TEST(ReferenceAtmosphere, HasNoStepsUpToAHundredKilometres) {
    for (double h = 0; h < 100000; h += 50) {
        const ReferenceAir here = reference_atmosphere_p835(Metres(h)),
                           there = reference_atmosphere_p835(Metres(h + 50));
        EXPECT_NEAR(there.pressure_hpa / here.pressure_hpa, 0.991, 0.006) << h;
        EXPECT_NEAR((there.temperature - here.temperature).value(), 0, 0.6) << h;
    }
    EXPECT_EQ(reference_atmosphere_p835(Metres(-400)).pressure_hpa, 1013.25);
    EXPECT_EQ(reference_atmosphere_p835(Metres(4e5)).temperature, reference_atmosphere_p835(Metres(1e5)).temperature);
}

TEST(ReferenceAtmosphere, KeepsALittleVapourOnHigh) {
    const ReferenceAir low = reference_atmosphere_p835(Metres(1000));
    EXPECT_EQ(with_least_vapour(low).vapour_density_g_m3, low.vapour_density_g_m3);
    const ReferenceAir high = with_least_vapour(reference_atmosphere_p835(Metres(50000)));
    EXPECT_NEAR(high.vapour_pressure_hpa() / high.pressure_hpa, 2e-6, 1e-12);
}

}  // namespace
}  // namespace skyloop
