#include "world/propagation/specific_attenuation.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "support/oracle_table.hpp"
#include "world/gnss/constants.hpp"

namespace skyloop {
namespace {

using test::oracle_rows;
using test::OracleRow;

const Hertz l1_carrier(carrier_frequency_l1);

TEST(Concentration, EveryOracleRow) {
    for (const OracleRow& row : oracle_rows("paper_equivalent_concentration.csv")) {
        SCOPED_TRACE(row.id());
        const double tolerance = row.number("tol_rel");
        AtmosphereParameters atmosphere;
        atmosphere.sea_level_temperature = Kelvin(row.number("T_sea_level_K"));
        AtmosphericLayer layer{"", Metres(row.number("h1_m")), Metres(row.number("h2_m"))};
        const auto expect_close = [&](double value, const char* column) {
            EXPECT_NEAR(value / row.number(column), 1, tolerance) << column;
        };
        expect_close(concentration_at(layer.base, atmosphere), "k_at_h1");
        expect_close(layer_concentration(layer, atmosphere), "k_slab_mean");
        layer.concentration = ConcentrationMode::midpoint;
        expect_close(layer_concentration(layer, atmosphere), "k_slab_mid");
        layer.concentration = ConcentrationMode::fixed;
        layer.fixed_concentration = 0.25;
        EXPECT_EQ(layer_concentration(layer, atmosphere), 0.25);
    }
}

TEST(Concentration, ScaleHeightAtFifteenCelsius) {
    EXPECT_NEAR(scale_height(AtmosphereParameters{}).value(), 8434.66, 0.005);
}

TEST(Concentration, OfALayerWithoutThicknessIsThatOfItsHeight) {
    const AtmosphereParameters atmosphere;
    const AtmosphericLayer layer{"", Metres(3000), Metres(3000)};
    EXPECT_DOUBLE_EQ(layer_concentration(layer, atmosphere), concentration_at(Metres(3000), atmosphere));
}

TEST(GasAttenuation, EveryOracleRow) {
    for (const OracleRow& row : oracle_rows("paper_gas_attenuation.csv")) {
        SCOPED_TRACE(row.id());
        const double tolerance = row.number("tol_rel");
        const Hertz carrier(row.number("f_GHz") * 1e9);
        const double k = row.number("k");
        const auto expect_close = [&](DecibelsPerKilometre value, const char* column) {
            EXPECT_NEAR(value.value(), row.number(column), tolerance * std::abs(row.number(column))) << column;
        };
        expect_close(vapour_attenuation(carrier, row.number("rho_g_m3"), k), "A_vap_dB_km");
        expect_close(oxygen_attenuation(carrier, k, 0.277), "A_o2_dB_km_paper_0p277");
        expect_close(oxygen_attenuation(carrier, k, 0.227), "A_o2_dB_km_source_0p227");
    }
}

TEST(GasAttenuation, OxygenConstantChangesItByLessThanTwoPercent) {
    const double printed = oxygen_attenuation(l1_carrier, 1, 0.277).value();
    const double source = oxygen_attenuation(l1_carrier, 1, 0.227).value();
    EXPECT_NEAR(printed, 0.005500, 1e-6);
    EXPECT_NEAR(source, 0.005601, 1e-6);
    EXPECT_NEAR(printed / source - 1, -0.018, 0.0005);
}

TEST(Rain, EveryOracleRow) {
    for (const OracleRow& row : oracle_rows("itu_p838_rain.csv")) {
        SCOPED_TRACE(row.id());
        const double tolerance = row.number("tol_rel");
        const Hertz carrier(row.number("f_GHz") * 1e9);
        const Angle elevation = Angle::degrees(row.number("el_deg"));
        const RainCoefficients c = rain_coefficients(carrier, elevation, Angle::degrees(row.number("tau_deg")));
        EXPECT_NEAR(c.k / row.number("k"), 1, tolerance);
        EXPECT_NEAR(c.alpha / row.number("alpha"), 1, tolerance);
        const double gamma = c.k * std::pow(row.number("rain_mm_h"), c.alpha);
        EXPECT_NEAR(gamma / row.number("gamma_R_dB_km"), 1, tolerance);
        if (row.number("tau_deg") == 45) {
            const Rain rain{row.number("rain_mm_h")};
            EXPECT_NEAR(rain_attenuation(rain, carrier, elevation).value() / row.number("gamma_R_dB_km"), 1, tolerance);
        }
    }
}

TEST(Rain, AgreesWithTheValidationWorkbook) {
    for (const OracleRow& row : oracle_rows("itu_official_p838.csv")) {
        SCOPED_TRACE(row.id());
        const RainCoefficients c =
            rain_coefficients(Hertz(row.number("f_GHz") * 1e9), Angle::degrees(row.number("el_deg")),
                              Angle::degrees(row.number("tau_deg")));
        EXPECT_NEAR(c.k, row.number("k"), 5e-9);
        EXPECT_NEAR(c.alpha, row.number("alpha"), 5e-9);
        EXPECT_NEAR(c.k * std::pow(row.number("rain_mm_h"), c.alpha), row.number("gamma_R_dB_km"), 5e-8);
    }
}

TEST(Rain, AsVapourTakesItsLiquidWaterAsVapour) {
    Rain rain{100};
    rain.model = RainModel::as_vapour;
    const double liquid = 0.072 * std::pow(100, 0.88);
    EXPECT_DOUBLE_EQ(rain_attenuation(rain, l1_carrier, Angle::degrees(30)).value(),
                     vapour_attenuation(l1_carrier, liquid, 1).value());
    EXPECT_EQ(rain_attenuation(Rain{}, l1_carrier, Angle::degrees(30)).value(), 0);
}

}  // namespace
}  // namespace skyloop
