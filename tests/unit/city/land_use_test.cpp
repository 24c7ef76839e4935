// How land is used, from OpenStreetMap.
#include "world/city/land_use.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <fstream>

namespace skyloop {
namespace {

using testing::HasSubstr;

constexpr std::array<std::string_view, 2> uses{"natural=wood", "landuse=forest"};

const std::string nodes = R"(
<node id="1" lat="50" lon="10"/><node id="2" lat="50" lon="10.001"/><node id="3" lat="50.001" lon="10.001"/>
<node id="4" lat="50.001" lon="10"/><node id="5" lat="50.0002" lon="10.0002"/><node id="6" lat="50.0002" lon="10.0007"/>
<node id="7" lat="50.0007" lon="10.0007"/><node id="8" lat="50.0007" lon="10.0002"/>)";
const std::string square = R"(<way id="1"><nd ref="1"/><nd ref="2"/><nd ref="3"/><nd ref="4"/><nd ref="1"/>)";
const std::string inner = R"(<way id="2"><nd ref="5"/><nd ref="6"/><nd ref="7"/><nd ref="8"/><nd ref="5"/></way>)";

Result<LandUse> land_use_of(const std::string& content, const std::string& name = "town.osm") {
    const std::string path = testing::TempDir() + name;
    std::ofstream(path) << "<osm version=\"0.6\">" + nodes + content + "</osm>";
    return read_land_use(path, uses);
}

TEST(LandUse, TakesTheFirstKnownTagOfAnArea) {
    const auto land = land_use_of(square + R"(<tag k="landuse" v="forest"/><tag k="natural" v="wood"/></way>)" + inner);
    ASSERT_TRUE(land) << land.error().message;
    ASSERT_EQ(land->areas.size(), 1u);
    EXPECT_EQ(land->areas.front().use, "natural=wood");
    EXPECT_EQ(land->areas.front().outer.size(), 4u);
    EXPECT_TRUE(land->areas.front().holes.empty());
}

TEST(LandUse, LeavesClearingsOpen) {
    const auto land = land_use_of(square + R"(<tag k="landuse" v="forest"/></way>)" + inner +
                                  R"(<relation id="9"><member type="way" ref="1" role="outer"/>
<member type="way" ref="2" role="inner"/><tag k="type" v="multipolygon"/><tag k="landuse" v="forest"/></relation>)");
    ASSERT_TRUE(land) << land.error().message;
    ASSERT_EQ(land->areas.size(), 1u);  // the border says again what its relation says
    ASSERT_EQ(land->areas.front().holes.size(), 1u);
    EXPECT_NEAR(land->areas.front().holes[0][2].latitude.deg(), 50.0007, 1e-9);
}

TEST(LandUse, CountsWhatAnExtractCuts) {
    const auto land = land_use_of(square + R"(<tag k="landuse" v="forest"/></way>
<way id="3"><nd ref="1"/><nd ref="77"/><nd ref="3"/><nd ref="1"/><tag k="landuse" v="forest"/></way>)");
    ASSERT_TRUE(land) << land.error().message;
    EXPECT_EQ(land->areas.size(), 1u);
    EXPECT_EQ(land->cut, 1u);
}

TEST(LandUse, SaysWhatIsWrong) {
    const auto none = land_use_of(square + R"(<tag k="landuse" v="meadow"/></way>)");
    ASSERT_FALSE(none);
    EXPECT_THAT(none.error().message,
                HasSubstr("town.osm: has no area of a known use; expected one, as natural=wood, landuse=forest"));
    const auto cut = land_use_of(R"(<way id="3"><nd ref="1"/><nd ref="77"/><nd ref="3"/><nd ref="1"/>
<tag k="landuse" v="forest"/></way>)");
    ASSERT_FALSE(cut);
    EXPECT_THAT(cut.error().message, HasSubstr("of its 1 areas of a known use none has all its corners in the file"));
    const auto damaged = land_use_of("<way>", "damaged.osm");
    ASSERT_FALSE(damaged);
    EXPECT_THAT(damaged.error().message, HasSubstr("damaged.osm:"));
    const auto other = read_land_use("town.json", uses);
    ASSERT_FALSE(other);
    EXPECT_EQ(other.error().message, "town.json: is no file of OpenStreetMap by its name; expected .osm or .osm.pbf");
    EXPECT_EQ(read_land_use("missing.osm", uses).error().code, ErrorCode::outside);
}

}  // namespace
}  // namespace skyloop
