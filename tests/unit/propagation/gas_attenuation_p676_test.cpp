#include "world/propagation/gas_attenuation_p676.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <string>

#include "support/oracle_table.hpp"
#include "world/gnss/constants.hpp"

namespace skyloop {
namespace {

using test::OracleRow;

ReferenceAir air_of(const OracleRow& row) {
    ReferenceAir air{Kelvin(row.number("T_K")), row.number("p_dry_hPa"), row.number("rho_g_m3")};
    air.pressure_hpa += air.vapour_pressure_hpa();
    return air;
}

void expect_gases(const OracleRow& row, double tolerance) {
    SCOPED_TRACE(row.id());
    const GasAttenuation gas = gas_attenuation_p676(air_of(row), Hertz(row.number("f_GHz") * 1e9));
    const auto expect_close = [&](DecibelsPerKilometre value, const char* column) {
        const double expected = row.number(column);
        EXPECT_NEAR(value.value(), expected, tolerance * expected) << column;
    };
    expect_close(gas.oxygen, "gamma_o_dB_km");
    expect_close(gas.vapour, "gamma_w_dB_km");
    expect_close(gas.total(), "gamma_dB_km");
}

using LineNumbers = std::array<double, 7>;

LineNumbers numbers_of(const OxygenLine& l) { return {l.f0, l.a1, l.a2, l.a3, l.a4, l.a5, l.a6}; }
LineNumbers numbers_of(const VapourLine& l) { return {l.f0, l.b1, l.b2, l.b3, l.b4, l.b5, l.b6}; }

template <class Lines>
void expect_lines_of_oracle(const Lines& lines, const std::string& table, char letter) {
    const auto rows = test::oracle_rows(table);
    if (test::shared_oracles_present()) {
        EXPECT_EQ(lines.size(), rows.size());
    }
    for (const OracleRow& row : rows) {
        SCOPED_TRACE(table + " " + row.id());
        LineNumbers expected{row.number("f0_GHz")};
        for (std::size_t i = 1; i < expected.size(); ++i)
            expected[i] = row.number(letter + std::to_string(i));
        const auto line =
            std::find_if(lines.begin(), lines.end(), [&](const auto& l) { return l.f0 == expected.front(); });
        ASSERT_NE(line, lines.end());
        EXPECT_EQ(numbers_of(*line), expected);
    }
}

TEST(GasAttenuationP676, ItsLinesAreThoseOfTheRecommendation) {
    expect_lines_of_oracle(oxygen_lines_p676, "itu_p676_13_lines_oxygen.csv", 'a');
    expect_lines_of_oracle(vapour_lines_p676, "itu_p676_13_lines_water_vapour.csv", 'b');
}

TEST(GasAttenuationP676, EveryOracleRow) {
    for (const OracleRow& row : test::oracle_rows("itu_p676_specific.csv"))
        expect_gases(row, row.number("tol_rel"));
}

TEST(GasAttenuationP676, AgreesWithTheValidationWorkbook) {
    for (const OracleRow& row : test::oracle_rows("itu_official_p676_gamma.csv"))
        expect_gases(row, 1e-9);
}

double slant_loss(Hertz carrier, double apparent_deg, Metres antenna_height) {
    const std::array apparent{Angle::degrees(apparent_deg)};
    return slant_gas_attenuation_p676(carrier, apparent, antenna_height).front().value();
}

TEST(SlantGasAttenuation, EveryOracleRow) {
    for (const OracleRow& row : test::oracle_rows("itu_p676_slant.csv")) {
        SCOPED_TRACE(row.id());
        const double loss =
            slant_loss(Hertz(row.number("f_GHz") * 1e9), row.number("el_deg"), Metres(row.number("rx_h_km") * 1000));
        EXPECT_NEAR(loss / row.number("A_gas_dB"), 1, row.number("tol_rel"));
        // The layering itself is far closer than the table's tolerance.
        EXPECT_NEAR(loss / row.number("A_gas_dB"), 1, 2e-3);
    }
}

TEST(SlantGasAttenuation, EndsWithTheAirAndStaysFiniteAtTheHorizon) {
    const Hertz l1(carrier_frequency_l1);
    EXPECT_EQ(slant_loss(l1, 30, Metres(120000)), 0);
    const double level = slant_loss(l1, 0, Metres(0));
    EXPECT_GT(level, 1.5);
    EXPECT_LT(level, 4);
}

}  // namespace
}  // namespace skyloop
