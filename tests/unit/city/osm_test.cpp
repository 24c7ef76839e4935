#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fmt/format.h>

#include "base/core/files.hpp"
#include "mesh_support.hpp"
#include "support/oracle_table.hpp"
#include "world/city/city_file.hpp"

namespace skyloop::test {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

/// Nodes 1 … 8: two squares, 0.001° and inside it 0.0005° wide.
const std::string osm_nodes = R"(
<node id="1" lat="50" lon="10"/><node id="2" lat="50" lon="10.001"/><node id="3" lat="50.001" lon="10.001"/>
<node id="4" lat="50.001" lon="10"/><node id="5" lat="50.0002" lon="10.0002"/><node id="6" lat="50.0002" lon="10.0007"/>
<node id="7" lat="50.0007" lon="10.0007"/><node id="8" lat="50.0007" lon="10.0002"/>)";

std::string osm_tags(std::initializer_list<std::pair<std::string_view, std::string_view>> tags) {
    std::string text;
    for (const auto& [key, value] : tags)
        text += fmt::format(R"(<tag k="{}" v="{}"/>)", key, value);
    return text;
}

std::string osm_way(int id, std::initializer_list<int> nodes, std::string_view tags = "") {
    std::string text = fmt::format(R"(<way id="{}">)", id);
    for (const int node : nodes)
        text += fmt::format(R"(<nd ref="{}"/>)", node);
    return text + std::string(tags) + "</way>";
}

std::string osm_file(std::string_view content) {
    return fmt::format("<?xml version='1.0'?>\n<osm version=\"0.6\">{}{}</osm>", osm_nodes, content);
}

Result<CityFile> read_osm(std::string_view text) { return parse_osm(text, "osm", "town.osm", {}); }

std::string osm_refusal(std::string_view bytes, std::string_view format = "osm") {
    const auto file = parse_osm(bytes, format, "town.osm", {});
    EXPECT_FALSE(file);
    if (file) return "";
    EXPECT_EQ(file.error().code, ErrorCode::input);
    EXPECT_EQ(file.error().message.find('\n'), std::string::npos);
    EXPECT_THAT(file.error().message, StartsWith("town.osm"));
    return file.error().message;
}

double roof_area(const CityModel& city) {
    CityModel roofs = city;
    std::erase_if(roofs.triangles, [](const CityTriangle& t) { return t.kind != SurfaceKind::roof; });
    return area_of(roofs);
}

/// Of a square of so many degrees at 50° N, m².
double square_area(double side) {
    const CurvatureRadii radii = curvature_radii(Angle::degrees(50));
    const double step = Angle::degrees(side).rad();
    return radii.meridian * step * radii.prime_vertical * std::cos(Angle::degrees(50).rad()) * step;
}

TEST(OpenStreetMap, RaisesWaysByHeightElseByLevels) {
    const auto tall =
        read_osm(osm_file(osm_way(1, {1, 2, 3, 4, 1}, osm_tags({{"building", "yes"}, {"height", "40'6&quot;"}}))));
    ASSERT_TRUE(tall) << tall.error().message;
    EXPECT_NEAR(highest_of(tall->model).z(), 40.5 * 0.3048, 0.01);
    EXPECT_NEAR(roof_area(tall->model), square_area(0.001), 0.5);
    EXPECT_EQ(tall->format, "osm");
    const auto floors = read_osm(osm_file(osm_way(
        1, {1, 2, 3, 4, 1}, osm_tags({{"building", "yes"}, {"building:levels", "5"}, {"building:min_level", "2"}}))));
    ASSERT_TRUE(floors) << floors.error().message;
    EXPECT_NEAR(highest_of(floors->model).z(), 15, 0.01);
    for (const Eigen::Vector3d& vertex : floors->model.vertices)
        EXPECT_GT(vertex.z(), 5.9);
}

TEST(OpenStreetMap, CountsTheRoofAboveTheLevels) {
    const auto top_of = [](std::initializer_list<std::pair<std::string_view, std::string_view>> tags) {
        const auto file =
            read_osm(osm_file(osm_way(1, {1, 2, 3, 4, 1}, R"(<tag k="building" v="yes"/>)" + osm_tags(tags))));
        EXPECT_TRUE(file) << file.error().message;
        return file ? std::round(100 * highest_of(file->model).z()) / 100 : 0;
    };
    EXPECT_EQ(top_of({{"building:levels", "5"}, {"roof:levels", "2"}}), 21);
    EXPECT_EQ(top_of({{"building:levels", "5"}, {"roof:levels", "2"}, {"roof:height", "4 m"}}), 19);
    EXPECT_EQ(top_of({{"building:levels", "5"}, {"roof:levels", "2"}, {"height", "17"}}), 17);
    EXPECT_EQ(top_of({{"building:levels", "0"}, {"roof:levels", "1"}}), 3);
    EXPECT_EQ(top_of({{"roof:height", "4"}}), 9) << "of a house of unknown height";
}

TEST(OpenStreetMap, LeavesOutWhatIsBelowTheGround) {
    const auto building = osm_tags({{"building", "yes"}, {"height", "10"}});
    const auto buildings = [&](std::initializer_list<std::pair<std::string_view, std::string_view>> tags) {
        const auto file =
            read_osm(osm_file(osm_way(1, {1, 2, 3, 4, 1}, building) +
                              osm_way(2, {5, 6, 7, 8, 5}, R"(<tag k="building" v="yes"/>)" + osm_tags(tags))));
        EXPECT_TRUE(file) << file.error().message;
        return file ? file->buildings : 0;
    };
    EXPECT_EQ(buildings({{"building:levels", "0"}, {"building:levels:underground", "2"}}), 1U);
    EXPECT_EQ(buildings({{"location", "underground"}, {"layer", "-1"}}), 1U);
    EXPECT_EQ(buildings({{"building:levels", "3"}, {"building:levels:underground", "2"}}), 2U);
    EXPECT_EQ(buildings({{"building:levels", "0"}}), 2U) << "unknown levels";
}

TEST(OpenStreetMap, BuildsNothingThatIsDeleted) {
    const std::string kept = osm_way(2, {5, 6, 7, 8, 5}, osm_tags({{"building", "yes"}, {"height", "5"}}));
    const std::string house = R"(<nd ref="1"/><nd ref="2"/><nd ref="3"/><nd ref="4"/><nd ref="1"/>)" +
                              osm_tags({{"building", "yes"}, {"height", "20"}}) + "</way>";
    for (const std::string_view attributes :
         {"id='1' action='delete' visible='true'", "action=\"delete\"\n id=\"1\"", "id='1' visible='false'"}) {
        const auto file = read_osm(osm_file(fmt::format("<way {}>", attributes) + house + kept));
        ASSERT_TRUE(file) << file.error().message;
        EXPECT_EQ(file->buildings, 1U) << attributes;
        EXPECT_NEAR(highest_of(file->model).z(), 5, 0.01) << attributes;
    }
    const auto changed =
        read_osm(osm_file("<!-- <way id='1' action='delete'> --><way id='1' action='modify' user='>'>" + house + kept));
    ASSERT_TRUE(changed) << changed.error().message;
    EXPECT_EQ(changed->buildings, 2U);
}

TEST(OpenStreetMap, TakesTheLastVersionOfAMultipolygon) {
    const auto version = [](int number, std::string_view more, std::string_view height) {
        return fmt::format(R"(<relation id="1" version="{}" {}><member type="way" ref="1" role="outer"/>)", number,
                           more) +
               osm_tags({{"type", "multipolygon"}, {"building", "yes"}, {"height", height}}) + "</relation>";
    };
    const std::string kept = osm_way(2, {5, 6, 7, 8, 5}, osm_tags({{"building", "yes"}, {"height", "5"}}));
    const std::string ways = osm_way(1, {1, 2, 3, 4, 1}) + kept;
    const auto changed = read_osm(osm_file(ways + version(1, "", "30") + version(2, "", "20")));
    ASSERT_TRUE(changed) << changed.error().message;
    EXPECT_EQ(changed->buildings, 2U);
    EXPECT_NEAR(highest_of(changed->model).z(), 20, 0.01);
    const auto deleted = read_osm(osm_file(ways + version(1, "", "30") + version(2, "visible='false'", "20")));
    ASSERT_TRUE(deleted) << deleted.error().message;
    EXPECT_EQ(deleted->buildings, 1U);
}

TEST(OpenStreetMap, BuildsAcrossThe180thMeridian) {
    const auto file = read_osm(
        R"(<osm version="0.6"><node id="1" lat="-16.8" lon="179.9999"/><node id="2" lat="-16.8" lon="-179.9999"/>
        <node id="3" lat="-16.7998" lon="-179.9999"/><node id="4" lat="-16.7998" lon="179.9999"/>)" +
        osm_way(1, {1, 2, 3, 4, 1}, osm_tags({{"building", "yes"}, {"height", "10"}})) + "</osm>");
    ASSERT_TRUE(file) << file.error().message;
    EXPECT_NEAR(roof_area(file->model), 21.32 * 22.13, 1);
    EXPECT_NEAR(std::abs(file->model.origin.longitude.deg()), 180, 1e-9);
}

TEST(OpenStreetMap, JoinsWaysOfAMultipolygonAroundItsCourtyard) {
    const auto file = read_osm(osm_file(
        osm_way(1, {1, 2, 3}) + osm_way(2, {1, 4, 3}) + osm_way(3, {5, 6, 7, 8, 5}) + R"(<relation id="1">
        <member type="way" ref="1" role="outer"/><member type="way" ref="2" role="outer"/>
        <member type="way" ref="3" role="inner"/>)" +
        osm_tags({{"type", "multipolygon"}, {"building", "yes"}, {"height", "10"}, {"building:material", "brick"}}) +
        "</relation>"));
    ASSERT_TRUE(file) << file.error().message;
    EXPECT_EQ(file->buildings, 1u);
    EXPECT_NEAR(roof_area(file->model), square_area(0.001) - square_area(0.0005), 0.5);
    EXPECT_EQ(count_of(file->model, SurfaceKind::wall), 16u);
    EXPECT_EQ(file->model.materials.at(file->model.triangles.front().material), "brick");
}

TEST(OpenStreetMap, PlantsWoodsAndKeepsGladesOpen) {
    const auto file = read_osm(osm_file(
        osm_way(1, {1, 2, 3, 4, 1}) + osm_way(3, {5, 6, 7, 8, 5}) +
        R"(<relation id="1"><member type="way" ref="1" role="outer"/><member type="way" ref="3" role="inner"/>)" +
        osm_tags({{"type", "multipolygon"}, {"landuse", "forest"}}) + "</relation>"));
    ASSERT_TRUE(file) << file.error().message;
    ASSERT_EQ(file->model.foliage.size(), 1u);
    EXPECT_EQ(file->model.foliage[0].ring.size(), 10u);
    EXPECT_TRUE(file->model.triangles.empty());
}

TEST(OpenStreetMap, ABorderThatIsNamedAWoodTooKeepsTheGladesOpen) {
    const auto wood = osm_tags({{"landuse", "forest"}});
    const auto relation = [&](std::string_view tags) {
        return R"(<relation id="1"><member type="way" ref="1" role="outer"/><member type="way" ref="3" role="inner"/>)" +
               osm_tags({{"type", "multipolygon"}}) + std::string(tags) + "</relation>";
    };
    const auto ways = osm_way(1, {1, 2, 3, 4, 1}, wood) + osm_way(3, {5, 6, 7, 8, 5});
    const auto file = read_osm(osm_file(ways + relation(wood)));
    ASSERT_TRUE(file) << file.error().message;
    ASSERT_EQ(file->model.foliage.size(), 1u);
    EXPECT_EQ(file->model.foliage[0].ring.size(), 10u);
    const auto lake = read_osm(osm_file(ways + relation(osm_tags({{"natural", "water"}}))));
    ASSERT_TRUE(lake) << lake.error().message;
    ASSERT_EQ(lake->model.foliage.size(), 1u);
    EXPECT_EQ(lake->model.foliage[0].ring.size(), 4u) << "of another thing the border says nothing";
}

TEST(OpenStreetMap, ABorderThatIsNamedTheSameBuildingKeepsTheCourtyardOpen) {
    const auto read = [](std::string_view tags_of_way, std::string_view tags_of_relation) {
        auto file = read_osm(osm_file(
            osm_way(1, {1, 2, 3, 4, 1}, std::string(tags_of_way) + osm_tags({{"building", "yes"}})) +
            osm_way(3, {5, 6, 7, 8, 5}) +
            R"(<relation id="1"><member type="way" ref="1" role="outer"/><member type="way" ref="3" role="inner"/>)" +
            osm_tags({{"type", "multipolygon"}, {"building", "yes"}}) + std::string(tags_of_relation) + "</relation>"));
        EXPECT_TRUE(file) << file.error().message;
        return file ? std::move(*file) : CityFile{};
    };
    const std::string tall = osm_tags({{"height", "18"}}), brick = osm_tags({{"building:material", "brick"}});
    for (const auto& [way, relation] : {std::pair(tall, tall), std::pair(tall, brick), std::pair(brick, tall)}) {
        const CityFile file = read(way, relation);
        EXPECT_EQ(file.buildings, 1U);
        EXPECT_NEAR(roof_area(file.model), square_area(0.001) - square_area(0.0005), 0.5);
        EXPECT_NEAR(highest_of(file.model).z(), 18, 0.01);
        EXPECT_THAT(file.warnings, ::testing::ElementsAre(HasSubstr("1 outer ways repeat the building")));
    }
    EXPECT_EQ(read(brick, tall).model.materials.back(), "brick");
    for (const char* other : {"5", "30"}) {
        const CityFile plinth = read(osm_tags({{"height", other}}), tall);
        EXPECT_EQ(plinth.buildings, 2U) << "a house of its own";
        EXPECT_THAT(plinth.warnings, ::testing::IsEmpty());
    }
}

TEST(OpenStreetMap, DropsOpenAndCutOutlinesAndSaysSo) {
    const auto building = osm_tags({{"building", "yes"}, {"height", "10"}});
    const auto file = read_osm(osm_file(osm_way(1, {1, 2, 3, 4, 1}, building) + osm_way(2, {1, 2, 3, 4}, building) +
                                        osm_way(3, {1, 2, 99, 1}, building) +
                                        osm_way(4, {5, 6, 7, 5}, osm_tags({{"building", "no"}}))));
    ASSERT_TRUE(file) << file.error().message;
    EXPECT_EQ(file->buildings, 1u);
    EXPECT_EQ(file->dropped, 2u);
    EXPECT_THAT(file->warnings, ::testing::ElementsAre(HasSubstr("2 outlines")));
}

TEST(OpenStreetMap, TakesPlacesWithinWays) {
    const std::array<std::string, 4> places{R"(lat="50" lon="10")", R"(lat="50" lon="10.001")",
                                            R"(lat="50.001" lon="10.001")", R"(lat="50.001" lon="10")"};
    const std::string tags = osm_tags({{"building", "yes"}, {"height", "10"}});
    for (const bool numbered : {true, false}) {
        const auto corners = [&](std::initializer_list<int> which) {
            std::string text;
            for (const int i : which)
                text += fmt::format("<nd {} {}/>", numbered ? fmt::format("ref='{}'", i + 1) : "",
                                    places.at(static_cast<std::size_t>(i)));
            return text;
        };
        const auto file = read_osm(
            "<osm version='0.6'><way id='1'><bounds minlat='50' minlon='10' maxlat='50.001' "
            "maxlon='10.001'/>" +
            corners({0, 1, 2, 3, 0}) + tags + "</way></osm>");
        ASSERT_TRUE(file) << file.error().message;
        EXPECT_NEAR(roof_area(file->model), square_area(0.001), 0.5);
        const auto joined =
            read_osm("<osm version='0.6'><way id='1'>" + corners({0, 1, 2}) + "</way><way id='2'>" +
                     corners({2, 3, 0}) + "</way><relation id='1'><member type='way' ref='1' role='outer'/>" +
                     "<member type='way' ref='2' role='outer'/>" + osm_tags({{"type", "multipolygon"}}) + tags +
                     "</relation></osm>");
        ASSERT_TRUE(joined) << joined.error().message;
        EXPECT_NEAR(roof_area(joined->model), square_area(0.001), 0.5);
    }
}

TEST(OpenStreetMap, SaysWhatToAskOverpassFor) {
    EXPECT_THAT(osm_refusal("<osm version='0.6'><relation id='1'><member type='way' ref='1' role=''><nd lat='1' "
                            "lon='2'/></member></relation></osm>"),
                ::testing::AllOf(StartsWith("town.osm: "), HasSubstr("ask Overpass for \"out body;")));
    EXPECT_THAT(osm_refusal("<osm version='0.6'><way id='1'><center lat='1' lon='2'/></way></osm>"),
                HasSubstr("ask Overpass for"));
    EXPECT_THAT(
        osm_refusal("<osm version='0.6'>" + osm_way(1, {1, 2, 3, 1}, osm_tags({{"building", "yes"}})) + "</osm>"),
        HasSubstr("the corners of all 1 outlines are wrong or not in the file"));
}

TEST(OpenStreetMap, RefusesWithOneClearLine) {
    EXPECT_THAT(osm_refusal(""), HasSubstr("empty"));
    EXPECT_THAT(osm_refusal("<osm version='0.6'>\n<node"), HasSubstr("town.osm:2"));
    EXPECT_THAT(osm_refusal("<html/>"), HasSubstr("town.osm"));
    EXPECT_THAT(osm_refusal(osm_file("")), HasSubstr("no outline"));
    for (const char* wild : {"50e50", "1e9", "-18e400", "&#53;0e50"})
        EXPECT_EQ(osm_refusal(fmt::format("<osm version='0.6'>\n<node id='9' lat='{}' lon='1'/></osm>", wild)),
                  fmt::format("town.osm:2: coordinate \"{}\"; expected degrees", wild));
    EXPECT_THAT(osm_refusal("<osm version='0.6'>\n<bounds minlat='1e99'/></osm>"),
                StartsWith("town.osm:2: coordinate"));
    EXPECT_THAT(osm_refusal(osm_file("<node id='9' lat='4.8e1' lon='1e-400'/>")), HasSubstr("no outline"));
    EXPECT_THAT(osm_refusal("<osm version='0.6'><node id='1' lat='x' lon='9'/></osm>"), HasSubstr("damaged"));
    EXPECT_THAT(osm_refusal("no blocks at all", "osm.pbf"), HasSubstr("damaged"));
    EXPECT_THAT(osm_refusal("x", "o5m"), HasSubstr("\"o5m\""));
}

std::string varint(std::uint64_t value) {
    std::string bytes;
    for (; value >= 128; value >>= 7U)
        bytes += static_cast<char>((value & 127U) | 128U);
    return bytes + static_cast<char>(value);
}

/// For signed numbers, as protocol buffers write "sint64".
std::uint64_t zigzag(std::int64_t value) { return static_cast<std::uint64_t>(value < 0 ? -2 * value - 1 : 2 * value); }

std::string number_field(unsigned field, std::uint64_t value) { return varint(field << 3U) + varint(value); }

std::string bytes_field(unsigned field, const std::string& bytes) {
    return varint(field << 3U | 2U) + varint(bytes.size()) + bytes;
}

std::string packed(std::initializer_list<std::uint64_t> values) {
    std::string bytes;
    for (const std::uint64_t value : values)
        bytes += varint(value);
    return bytes;
}

/// A block of a PBF file, not compressed (wiki.openstreetmap.org/wiki/PBF_Format).
std::string pbf_block(const std::string& type, const std::string& content) {
    const std::string blob = bytes_field(1, content);
    const std::string header = bytes_field(1, type) + number_field(3, blob.size());
    return std::string(3, '\0') + static_cast<char>(header.size()) + header + blob;
}

/// A house of four nodes, 0.001° wide, and one way. Places count in 100 nanodegrees, and may stand in the way alone.
std::string small_pbf(bool within_way = false) {
    const std::string strings = bytes_field(1, "") + bytes_field(1, "building") + bytes_field(1, "yes") +
                                bytes_field(1, "height") + bytes_field(1, "25");
    std::string nodes;
    const std::array<std::array<std::int64_t, 2>, 4> places{{{500'000'000, 100'000'000},
                                                             {500'000'000, 100'010'000},
                                                             {500'010'000, 100'010'000},
                                                             {500'010'000, 100'000'000}}};
    for (std::size_t i = 0; i < 4; ++i)
        nodes += bytes_field(1, number_field(1, zigzag(static_cast<std::int64_t>(i) + 1)) +
                                    number_field(8, zigzag(places[i][0])) + number_field(9, zigzag(places[i][1])));
    std::string way = number_field(1, 1) + bytes_field(2, packed({1, 3})) + bytes_field(3, packed({2, 4})) +
                      bytes_field(8, packed({zigzag(1), zigzag(1), zigzag(1), zigzag(1), zigzag(-3)}));
    std::string header = bytes_field(4, "OsmSchema-V0.6");
    if (within_way) {
        way += bytes_field(9, packed({zigzag(500'000'000), 0, zigzag(10'000), 0, zigzag(-10'000)})) +
               bytes_field(10, packed({zigzag(100'000'000), zigzag(10'000), 0, zigzag(-10'000), 0}));
        header += bytes_field(5, "LocationsOnWays");
        nodes.clear();
    }
    const std::string group = nodes.empty() ? "" : bytes_field(2, nodes);
    return pbf_block("OSMHeader", header) +
           pbf_block("OSMData", bytes_field(1, strings) + group + bytes_field(2, bytes_field(3, way)));
}

TEST(OpenStreetMap, ReadsPbfWholeAndRefusesItCut) {
    const std::string bytes = small_pbf();
    ASSERT_GT(bytes.size(), 100u);
    const auto file = parse_osm(bytes, "osm.pbf", "town.osm", {});
    ASSERT_TRUE(file) << file.error().message;
    EXPECT_EQ(file->format, "osm.pbf");
    EXPECT_EQ(file->buildings, 1u);
    EXPECT_NEAR(highest_of(file->model).z(), 25, 0.01);
    EXPECT_NEAR(roof_area(file->model), square_area(0.001), 0.5);
    for (std::size_t size = 1; size < bytes.size(); size += 7)
        osm_refusal(bytes.substr(0, size), "osm.pbf");
}

TEST(OpenStreetMap, TakesPlacesWithinWaysOfPbf) {
    const auto file = parse_osm(small_pbf(true), "osm.pbf", "town.osm", {});
    ASSERT_TRUE(file) << file.error().message;
    EXPECT_NEAR(roof_area(file->model), square_area(0.001), 0.5);
}

TEST(OpenStreetMap, TellsWhereAPbfIsCut) {
    const std::string bytes = small_pbf();
    EXPECT_THAT(osm_refusal(bytes.substr(0, bytes.size() - 1), "osm.pbf"), HasSubstr("a blob is not whole"));
    const std::string header_without_type = number_field(3, 5);
    const std::string blob{0, 0, 0, static_cast<char>(header_without_type.size())};
    EXPECT_THAT(osm_refusal(blob + header_without_type + "abcde", "osm.pbf"),
                HasSubstr("at byte 0: a blob has no type; expected OSMHeader or OSMData"));
}

TEST(OpenStreetMap, ReadsAnExtractOfBavaria) {
    SKYLOOP_REQUIRE_SHARED(path, "city/osm_sample_10.068_48.135.osm");
    const auto text = read_text_file(path);
    ASSERT_TRUE(text);
    const auto file = parse_osm(*text, "osm", "sample.osm", {});
    ASSERT_TRUE(file) << file.error().message;
    EXPECT_LE(file->buildings, 34u);
    EXPECT_GE(file->buildings, 30u);
    EXPECT_THAT(file->warnings, ::testing::Contains(HasSubstr("have no height or levels")));
    EXPECT_NEAR(file->model.origin.latitude.deg(), 48.136, 0.002);
}

}  // namespace
}  // namespace skyloop::test
