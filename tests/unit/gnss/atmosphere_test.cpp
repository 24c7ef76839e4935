#include "world/gnss/atmosphere.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "support/oracle_table.hpp"
#include "world/gnss/constants.hpp"

namespace skyloop {
namespace {

using test::oracle_rows;
using test::OracleRow;

KlobucharDelay klobuchar_of_row(const OracleRow& row) {
    KlobucharCoefficients c;
    for (std::size_t i = 0; i < 4; ++i) {
        c.alpha[i] = row.number("a" + std::to_string(i));
        c.beta[i] = row.number("b" + std::to_string(i));
    }
    return klobuchar_delay(c, Geodetic::degrees(row.number("lat_deg"), row.number("lon_deg"), 0),
                           {Angle::degrees(row.number("az_deg")), Angle::degrees(row.number("el_deg"))},
                           to_gps_time(row.integer("gps_week"), row.number("gps_tow_s")));
}

TEST(Klobuchar, EveryOracleRow) {
    for (const OracleRow& row : oracle_rows("iono_klobuchar.csv")) {
        SCOPED_TRACE(row.id());
        const KlobucharDelay delay = klobuchar_of_row(row);
        const double tolerance = row.number("tol_m");
        EXPECT_NEAR(delay.vertical.value(), row.number("vertical_delay_m"), tolerance);
        EXPECT_NEAR(delay.slant.value(), row.number("slant_delay_L1_m"), tolerance);
        EXPECT_NEAR(ionosphere_delay_at(delay.slant, Hertz(carrier_frequency_l2)).value(),
                    row.number("slant_delay_L2_m"), tolerance);
    }
}

TEST(Klobuchar, NightDelayIsFiveNanosecondsWithoutCoefficients) {
    const SkyDirection zenith{Angle::degrees(0), Angle::degrees(90)};
    const KlobucharDelay delay = klobuchar_delay({}, Geodetic::degrees(46, 30, 0), zenith, to_gps_time(2100, 0.0));
    EXPECT_NEAR(delay.vertical.value(), 5e-9 * speed_of_light, 1e-12);
}

TEST(Marini, EveryOracleRow) {
    for (const OracleRow& row : oracle_rows("tropo_marini.csv")) {
        SCOPED_TRACE(row.id());
        const MappingCoefficients m{row.number("a"), row.number("b"), row.number("c")};
        EXPECT_NEAR(marini(m, Angle::degrees(row.number("el_deg"))), row.number("m"), row.number("tol"));
    }
}

TEST(Niell, EveryOracleRow) {
    for (const OracleRow& row : oracle_rows("tropo_niell.csv")) {
        SCOPED_TRACE(row.id());
        const double tolerance = row.number("tol");
        const Angle latitude = Angle::degrees(row.number("lat_deg"));
        const Angle elevation = Angle::degrees(row.number("el_deg"));
        const MappingSite site{latitude, {Metres(row.number("h_m"))}, row.number("doy_1based")};
        const MappingCoefficients m = niell_hydrostatic(latitude, site.day_of_year);
        EXPECT_NEAR(m.a, row.number("a_h"), tolerance);
        EXPECT_NEAR(m.b, row.number("b_h"), tolerance);
        EXPECT_NEAR(m.c, row.number("c_h"), tolerance);
        EXPECT_NEAR(marini(m, elevation), row.number("m_hydro_sea_level"), tolerance);
        EXPECT_NEAR(niell_height_correction(site.height, elevation), row.number("delta_m_height"), tolerance);
        EXPECT_NEAR(niell_hydrostatic_mapping(site, elevation), row.number("m_hydro"), tolerance);
        EXPECT_NEAR(niell_wet_mapping(latitude, elevation), row.number("m_wet"), tolerance);
    }
}

TEST(Niell, SeasonIsMirroredHalfAYearLaterInTheSouth) {
    const MappingCoefficients north = niell_hydrostatic(Angle::degrees(50), 40);
    const MappingCoefficients south = niell_hydrostatic(Angle::degrees(-50), 40 + 365.25 / 2);
    EXPECT_NEAR(north.a, south.a, 1e-15);
    EXPECT_GT(niell_hydrostatic(Angle::degrees(50), 28 + 365.25 / 2).a, north.a);
}

TEST(Niell, MapsOneAtTheZenith) {
    const MappingSite site{Angle::degrees(46.4774), {Metres(1500)}, 100};
    EXPECT_NEAR(niell_hydrostatic_mapping(site, Angle::degrees(90)), 1, 1e-12);
    EXPECT_NEAR(niell_wet_mapping(site.latitude, Angle::degrees(90)), 1, 1e-12);
}

TEST(Niell, HeightCorrectionIsHisFromThreeDegreesOn) {
    for (const double degrees : {3.0, 3.001, 5.0, 20.0, 90.0})
        EXPECT_EQ(height_correction_to_horizon({Metres(4000)}, Angle::degrees(degrees)),
                  niell_height_correction({Metres(4000)}, Angle::degrees(degrees)));
}

TEST(Niell, HeightCorrectionGoesOnSmoothlyToTheHorizon) {
    const auto at = [](double sine) {
        return height_correction_to_horizon({Metres(1000)}, Angle::radians(std::asin(sine)));
    };
    const double fitted = std::sin(Angle::degrees(3).rad()), step = 1e-6;
    EXPECT_NEAR(at(fitted - 1e-12), at(fitted), 1e-10);
    const double above = (at(fitted + step) - at(fitted)) / step, below = (at(fitted) - at(fitted - step)) / step;
    EXPECT_NEAR(below, above, 1e-3);
    EXPECT_NEAR(at(0), 0.16, 0.005);
    for (double sine = 0; sine < 0.2; sine += 0.001)
        EXPECT_GT(at(sine), at(sine + 0.001));
}

TEST(CofactorMatrix, AgreesWithDilutionOfPrecision) {
    const std::vector<SkyDirection> sky{{Angle::degrees(10), Angle::degrees(70)},
                                        {Angle::degrees(100), Angle::degrees(20)},
                                        {Angle::degrees(220), Angle::degrees(35)},
                                        {Angle::degrees(310), Angle::degrees(12)},
                                        {Angle::degrees(160), Angle::degrees(50)}};
    const auto q = cofactor_matrix(sky);
    const auto dop = dilution_of_precision(sky);
    ASSERT_TRUE(q && dop);
    EXPECT_NEAR(std::sqrt(q->topLeftCorner<3, 3>().trace()), dop->pdop, 1e-12);
    EXPECT_NEAR(std::sqrt((*q)(1, 1)), dop->ndop, 1e-12);
    EXPECT_TRUE(q->isApprox(q->transpose(), 1e-9));
    EXPECT_FALSE(cofactor_matrix(std::span(sky).first(3)));
}

}  // namespace
}  // namespace skyloop
