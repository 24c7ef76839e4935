#include "world/gnss/sbas_grid.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

namespace skyloop {
namespace {

// Rows of DO-229, table A-14, as its numbers stand there.
TEST(SbasGrid, HasTheBandsOfTheTable) {
    for (int band = 0; band < 9; ++band)
        EXPECT_EQ(sbas_band(band).size(), band == 8 ? 200u : 201u) << band;
    EXPECT_EQ(sbas_band(9).size(), 192u);
    EXPECT_EQ(sbas_band(10).size(), 192u);
    const auto at = [](int band, std::size_t number) { return sbas_band(band).at(number - 1); };
    EXPECT_EQ(at(0, 1), (SbasGridPoint{-75, -180}));
    EXPECT_EQ(at(0, 28), (SbasGridPoint{85, -180}));
    EXPECT_EQ(at(0, 29), (SbasGridPoint{-55, -175}));
    EXPECT_EQ(at(0, 201), (SbasGridPoint{55, -145}));
    EXPECT_EQ(at(1, 1), (SbasGridPoint{-85, -140}));
    EXPECT_EQ(at(1, 28), (SbasGridPoint{75, -140}));
    EXPECT_EQ(at(4, 101), (SbasGridPoint{-75, 0}));
    EXPECT_EQ(at(4, 128), (SbasGridPoint{85, 0}));
    EXPECT_EQ(at(5, 1), (SbasGridPoint{-75, 20}));
    EXPECT_EQ(at(5, 101), (SbasGridPoint{-85, 40}));
    EXPECT_EQ(at(8, 200), (SbasGridPoint{55, 175}));
    EXPECT_EQ(at(9, 1), (SbasGridPoint{60, -180}));
    EXPECT_EQ(at(9, 72), (SbasGridPoint{60, 175}));
    EXPECT_EQ(at(9, 73), (SbasGridPoint{65, -180}));
    EXPECT_EQ(at(9, 181), (SbasGridPoint{85, -180}));
    EXPECT_EQ(at(10, 181), (SbasGridPoint{-85, -170}));
    for (int band = 0; band < 9; ++band)
        for (std::size_t i = 0; i < sbas_band(band).size(); ++i) {
            const SbasMaskPlace place = sbas_mask_place(sbas_band(band)[i]);
            EXPECT_EQ(place.band, band);
            EXPECT_EQ(place.number, static_cast<int>(i) + 1);
        }
    EXPECT_EQ(sbas_mask_place({3, 5}).number, 0);
}

TEST(SbasGrid, EveryPlaceBelow75DegreesStandsInASquareOfPoints) {
    for (double latitude = -75; latitude <= 75; latitude += 1.25)
        for (double longitude = -180; longitude <= 180; longitude += 1.25) {
            const auto cell = sbas_cell({Angle::degrees(latitude), Angle::degrees(longitude)});
            ASSERT_TRUE(cell);
            EXPECT_GE(cell->east, 0);
            EXPECT_LE(cell->east, 1);
            EXPECT_GE(cell->north, -1e-9);
            EXPECT_LE(cell->north, 1 + 1e-9);
            EXPECT_NEAR(cell->corner.latitude + cell->north * cell->size, latitude, 1e-9);
            for (const SbasGridPoint& p : cell->corners())
                EXPECT_GT(sbas_mask_place(p).number, 0) << latitude << ' ' << longitude;
        }
    EXPECT_FALSE(sbas_cell({Angle::degrees(80), Angle()}));
    EXPECT_FALSE(sbas_cell({Angle::degrees(-75.1), Angle()}));
}

TEST(SbasGrid, ClosesAtTheDateLine) {
    const auto cell = sbas_cell({Angle::degrees(12), Angle::degrees(177.5)});
    ASSERT_TRUE(cell);
    EXPECT_EQ(cell->corner, (SbasGridPoint{10, 175}));
    EXPECT_EQ(cell->corners()[0], (SbasGridPoint{15, -180}));
    EXPECT_EQ(cell->corners()[3], (SbasGridPoint{10, -180}));
    EXPECT_NEAR(cell->east, 0.5, 1e-12);
}

}  // namespace
}  // namespace skyloop
