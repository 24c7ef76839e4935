#include "world/gnss/atmosphere.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include "support/oracle_table.hpp"
#include "world/gnss/detail/gmf_gpt_table.hpp"

namespace skyloop {
namespace {

using test::OracleRow;

Geodetic place_of(const OracleRow& row, const char* height) {
    return Geodetic::degrees(row.number("lat_deg"), row.number("lon_deg"), row.number(height));
}

AnnualPhase phase_of(double modified_julian_date) { return {modified_julian_date - 44266}; }

// VMF1.F
TroposphereMapping vmf1_mapping(const Vmf1Coefficients& a, Angle latitude, AnnualPhase phase, Angle elevation) {
    return {marini(vmf1_hydrostatic(a.a_hydrostatic, latitude, phase), elevation),
            marini(vmf1_wet(a.a_wet), elevation)};
}

// GMF.F
TroposphereMapping gmf_mapping(const Geodetic& place, AnnualPhase phase, Angle elevation) {
    TroposphereMapping mapping = vmf1_mapping(gmf_coefficients(place, phase), place.latitude, phase, elevation);
    mapping.hydrostatic += niell_height_correction({place.height.above_ellipsoid}, elevation);
    return mapping;
}

TEST(Gmf, ItsHarmonicsAndThoseOfGptAreThePublishedOnes) {
    const auto rows = test::oracle_rows("gmf_gpt_coefficients.csv");
    if (test::shared_oracles_present()) {
        EXPECT_EQ(rows.size(), gmf_gpt_terms.size());
    }
    for (const OracleRow& row : rows) {
        SCOPED_TRACE(row.id() + ", " + row.text("m"));
        const auto term = std::find_if(gmf_gpt_terms.begin(), gmf_gpt_terms.end(), [&](const GmfGptTerm& t) {
            return t.n == row.integer("n") && t.m == row.integer("m");
        });
        ASSERT_NE(term, gmf_gpt_terms.end());
        const std::array<std::pair<HarmonicPair, const char*>, 9> fields{{{term->hydrostatic_mean, "DryMean"},
                                                                          {term->hydrostatic_amplitude, "DryAmp"},
                                                                          {term->wet_mean, "WetMean"},
                                                                          {term->wet_amplitude, "WetAmp"},
                                                                          {term->undulation, "geoid"},
                                                                          {term->pressure_mean, "PressMean"},
                                                                          {term->pressure_amplitude, "PressAmp"},
                                                                          {term->temperature_mean, "TempMean"},
                                                                          {term->temperature_amplitude, "TempAmp"}}};
        for (const auto& [pair, name] : fields) {
            EXPECT_EQ(pair.cosine, row.number(std::string("A") + name)) << name;
            EXPECT_EQ(pair.sine, row.number(std::string("B") + name)) << name;
        }
    }
}

TEST(Gpt, EveryOracleRow) {
    for (const OracleRow& row : test::oracle_rows("tropo_gpt.csv")) {
        SCOPED_TRACE(row.id());
        const GptWeather weather = gpt_weather(place_of(row, "h_ell_m"), phase_of(row.number("mjd")));
        EXPECT_NEAR(weather.pressure_hpa, row.number("p_hPa"), row.number("tol"));
        EXPECT_NEAR(weather.temperature_celsius, row.number("T_C"), row.number("tol"));
        EXPECT_NEAR(weather.undulation.value(), row.number("undulation_m"), row.number("tol"));
    }
}

TEST(Gmf, EveryOracleRow) {
    for (const OracleRow& row : test::oracle_rows("tropo_gmf.csv")) {
        SCOPED_TRACE(row.id());
        const TroposphereMapping mapping =
            gmf_mapping(place_of(row, "h_m"), phase_of(row.number("mjd")), Angle::degrees(row.number("el_deg")));
        EXPECT_NEAR(mapping.hydrostatic, row.number("m_hydro"), row.number("tol"));
        EXPECT_NEAR(mapping.wet, row.number("m_wet"), row.number("tol"));
    }
}

TEST(Gmf, MapsOneAtTheZenith) {
    const TroposphereMapping mapping =
        gmf_mapping(Geodetic::degrees(-30, 100, 1200), phase_of(58000), Angle::degrees(90));
    EXPECT_NEAR(mapping.hydrostatic, 1, 1e-12);
    EXPECT_NEAR(mapping.wet, 1, 1e-12);
}

TEST(Gpt, StaysFiniteInOrbit) {
    const GptWeather weather = gpt_weather(Geodetic::degrees(10, 10, 400000), phase_of(58000));
    EXPECT_EQ(weather.pressure_hpa, 0);
}

// The test case that the IERS Conventions print with VMF1.F.
TEST(Vmf1, AgreesWithTheConventionsTestCase) {
    const TroposphereMapping mapping =
        vmf1_mapping({0.00127683, 0.00060955}, Angle::radians(0.6708665767), phase_of(55055),
                     Angle::radians(std::numbers::pi / 2 - 1.278564131));
    EXPECT_NEAR(mapping.hydrostatic, 3.424342122738071, 1e-9);
    EXPECT_NEAR(mapping.wet, 3.448299714692572, 1e-9);
}

TEST(AnnualPhase, RunsFromTheTwentyEighthOfJanuary) {
    UtcTime utc;
    utc.year = 1980, utc.month = 1, utc.day = 28, utc.hour = 12;
    EXPECT_DOUBLE_EQ(AnnualPhase::of(utc).days, 0.5);
    EXPECT_EQ(AnnualPhase{}.cosine(), 1);
}

}  // namespace
}  // namespace skyloop
