#include "world/gnss/nequick_g.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <limits>
#include <stdexcept>
#include <string>

#include "support/oracle_table.hpp"

namespace skyloop {
namespace {

using test::OracleRow;
using ::testing::HasSubstr;

// April, the month of the benchmark.
const NequickTables& april() {
    static const NequickTables tables = [] {
        const auto read = read_nequick_tables(std::filesystem::path(SKYLOOP_SOURCE_DIR) / "data/nequick_g", 4);
        if (!read) throw std::runtime_error(read.error().message);
        return *read;
    }();
    return tables;
}

TEST(NequickG, EveryOracleRow) {
    for (const OracleRow& row : test::oracle_rows("iono_nequick_g.csv")) {
        SCOPED_TRACE(row.id());
        ASSERT_EQ(row.integer("month"), april().month);
        const Tecu content = nequick_slant_content(
            april(), {row.number("ai0"), row.number("ai1"), row.number("ai2")},
            Geodetic::degrees(row.number("rx_lat_deg"), row.number("rx_lon_deg"), row.number("rx_h_m")),
            Geodetic::degrees(row.number("sat_lat_deg"), row.number("sat_lon_deg"), row.number("sat_h_m")),
            row.number("ut_h"));
        EXPECT_NEAR(content.value(), row.number("stec_tecu"), row.number("tol_tecu"));
    }
}

TEST(NequickG, StraightUpIsTheLeast) {
    const auto towards = [](double latitude) {
        return nequick_slant_content(april(), {120, 0, 0}, Geodetic::degrees(46, 30, 50),
                                     Geodetic::degrees(latitude, 30, 20200e3), 12)
            .value();
    };
    EXPECT_GT(towards(46), 5);
    EXPECT_GT(towards(-10), towards(46));
    EXPECT_NEAR(towards(46.0001), towards(46), 0.01);
}

TEST(NequickG, LeavesOutWhatLiesBelowAHighReceiver) {
    const auto from = [](double height) {
        return nequick_slant_content(april(), {120, 0, 0}, Geodetic::degrees(46, 30, height),
                                     Geodetic::degrees(40, 35, 20200e3), 12)
            .value();
    };
    EXPECT_GT(from(0), from(400e3));
    EXPECT_GT(from(400e3), from(1500e3));
    EXPECT_GT(from(1500e3), from(5000e3));
    EXPECT_GT(from(5000e3), 0);
}

TEST(NequickG, HoldsItsIonisationWithinBounds) {
    const Angle mu = Angle::degrees(50);
    EXPECT_EQ(nequick_ionisation({}, mu), 63.7);
    EXPECT_EQ(nequick_ionisation({1000, 0, 0}, mu), 400);
    EXPECT_EQ(nequick_ionisation({-5, 0, 0}, mu), 0);
    EXPECT_DOUBLE_EQ(nequick_ionisation({100, -1, 0.01}, mu), 75);
    EXPECT_TRUE(std::isfinite(
        nequick_slant_content(april(), {-5, 0, 0}, Geodetic::degrees(0, 0, 0), Geodetic::degrees(0, 10, 20200e3), 24)
            .value()));
}

TEST(NequickG, HasAnF2PeakUnderTheStrongestSun) {
    // M(3000)F2 of the maps would be 0.85 here. With 1 the peak has 5e12 electrons a cubic metre, 2590 km up.
    const auto may = read_nequick_tables(std::filesystem::path(SKYLOOP_SOURCE_DIR) / "data/nequick_g", 5);
    ASSERT_TRUE(may) << may.error().message;
    const double content =
        nequick_slant_content(*may, {400, 0, 0}, Geodetic::degrees(7, 18, 0), Geodetic::degrees(7, 18, 20200e3), 18.5)
            .value();
    EXPECT_GT(content, 800);
    EXPECT_LT(content, 1400);
}

TEST(NequickG, EndsWhereNothingIsANumber) {
    const double none = std::numeric_limits<double>::quiet_NaN();
    EXPECT_TRUE(std::isnan(nequick_slant_content(april(), {none, 0, 0}, Geodetic::degrees(46, 30, 50),
                                                 Geodetic::degrees(46, 30, 20200e3), 12)
                               .value()));
}

TEST(ModifiedDipLatitude, HitsItsGridAndClosesAroundTheGlobe) {
    const ModipGrid& grid = april().modip;
    const auto at = [&](double latitude, double longitude) {
        return modified_dip_latitude(grid, Angle::degrees(latitude), Angle::degrees(longitude)).deg();
    };
    EXPECT_NEAR(at(0, 0), -10, 25);
    for (int row = 1; row < 38; ++row)
        for (int column = 1; column < 37; ++column)
            EXPECT_NEAR(at(5 * row - 95, 10 * column - 190),
                        grid.degrees[static_cast<std::size_t>(row)][static_cast<std::size_t>(column)], 1e-6);
    EXPECT_NEAR(at(33.3, 180), at(33.3, -180), 1e-9);
    EXPECT_NEAR(at(33.3, 297.66), at(33.3, -62.34), 1e-9);
    EXPECT_NEAR(at(90, 77), 90, 1e-9);
}

TEST(NequickTables, SayWhatIsWrong) {
    EXPECT_THAT(read_modip_grid("1 2 x", "grid").error().message, HasSubstr("grid:1: found something that is no"));
    EXPECT_THAT(read_modip_grid("1 2\n3\n", "grid").error().message, HasSubstr("found 3 numbers; expected 1521"));
    std::string many;
    for (int i = 0; i < 2859; ++i)
        many += "1\n";
    EXPECT_THAT(read_ccir_month(many, "ccir").error().message, HasSubstr("ccir:2859: found more; expected 2858"));
    EXPECT_FALSE(read_nequick_tables("/nonexistent", 4));
    EXPECT_THAT(read_nequick_tables("/nonexistent", 13).error().message, HasSubstr("expected 1 to 12"));
}

}  // namespace
}  // namespace skyloop
