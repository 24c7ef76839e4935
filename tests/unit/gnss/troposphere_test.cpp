#include "world/gnss/atmosphere.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "support/oracle_table.hpp"

namespace skyloop {
namespace {

using test::OracleRow;

TEST(Saastamoinen, EveryOracleRow) {
    for (const OracleRow& row : test::oracle_rows("tropo_saastamoinen.csv")) {
        SCOPED_TRACE(row.id());
        const double tolerance = row.number("tol_m");
        const MslHeight height{Metres(row.number("h_m"))};
        const Angle latitude = Angle::degrees(row.number("lat_deg"));
        const SurfaceWeather weather = standard_weather(height, row.number("rel_humidity"));
        EXPECT_NEAR(weather.pressure_hpa, row.number("p_hPa"), 1e-8);
        EXPECT_NEAR(weather.temperature.value(), row.number("T_K"), 1e-8);
        EXPECT_NEAR(weather.vapour_pressure_hpa, row.number("e_hPa"), 1e-8);
        const ZenithDelay zenith = saastamoinen_zenith_delay(weather, latitude, height);
        EXPECT_NEAR(zenith.hydrostatic.value(), row.number("zhd_m"), tolerance);
        EXPECT_NEAR(zenith.wet.value(), row.number("zwd_m"), tolerance);
        const Metres slant =
            saastamoinen_delay(latitude, height, Angle::degrees(row.number("el_deg")), row.number("rel_humidity"));
        EXPECT_NEAR(slant.value(), row.number("slant_delay_m"), tolerance);
    }
}

TEST(Saastamoinen, StaysFiniteFarAboveTheAir) {
    const double delay = saastamoinen_delay(Angle::degrees(0), {Metres(400000)}, Angle::degrees(20), 0.7).value();
    EXPECT_TRUE(std::isfinite(delay));
    EXPECT_NEAR(delay, 0, 0.01);
}

}  // namespace
}  // namespace skyloop
