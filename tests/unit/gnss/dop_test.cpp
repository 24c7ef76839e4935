#include "world/gnss/dop.hpp"

#include <gtest/gtest.h>

#include <sstream>
#include <vector>

#include "support/oracle_table.hpp"

namespace skyloop::test {
namespace {

std::vector<SkyDirection> directions_above(const std::string& list, double mask_deg) {
    std::vector<SkyDirection> directions;
    std::istringstream words(list);
    double azimuth = 0;
    double elevation = 0;
    char colon = 0;
    while (words >> azimuth >> colon >> elevation)
        if (elevation >= mask_deg) directions.push_back({Angle::degrees(azimuth), Angle::degrees(elevation)});
    return directions;
}

TEST(Dop, AgreesWithTheOracle) {
    for (const OracleRow& row : oracle_rows("dop.csv")) {
        SCOPED_TRACE(row.id());
        const auto directions = directions_above(row.text("az_el_list_deg"), row.number("el_mask_deg"));
        ASSERT_EQ(static_cast<std::int64_t>(directions.size()), row.integer("n_used"));
        const std::optional<Dop> dop = dilution_of_precision(directions);
        ASSERT_TRUE(dop);
        const double tolerance = row.number("tol_rel");
        EXPECT_NEAR(dop->gdop / row.number("gdop"), 1, tolerance);
        EXPECT_NEAR(dop->pdop / row.number("pdop"), 1, tolerance);
        EXPECT_NEAR(dop->hdop / row.number("hdop"), 1, tolerance);
        EXPECT_NEAR(dop->vdop / row.number("vdop"), 1, tolerance);
        EXPECT_NEAR(dop->tdop / row.number("tdop"), 1, tolerance);
        EXPECT_NEAR(dop->edop * dop->edop + dop->ndop * dop->ndop, dop->hdop * dop->hdop, 1e-9 * dop->hdop * dop->hdop);
    }
}

TEST(Dop, NothingForFewerThanFourOrAFlatSky) {
    std::vector<SkyDirection> sky(3, {Angle::degrees(10), Angle::degrees(30)});
    EXPECT_FALSE(dilution_of_precision(sky));
    EXPECT_FALSE(dilution_of_precision({}));
    sky.resize(5, {Angle::degrees(10), Angle::degrees(30)});
    EXPECT_FALSE(dilution_of_precision(sky)) << "five satellites in one direction";
    std::vector<SkyDirection> ring;
    for (const double azimuth : {0.0, 90.0, 180.0, 270.0, 45.0})
        ring.push_back({Angle::degrees(azimuth), Angle::degrees(30)});
    EXPECT_FALSE(dilution_of_precision(ring)) << "a cone around the zenith leaves height and clock alike";
}

}  // namespace
}  // namespace skyloop::test
