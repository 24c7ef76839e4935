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

Result<CityFile> read_cityjson(std::string_view text, const CityFileSettings& settings = {}) {
    return parse_cityjson(text, "town.json", settings);
}

/// A cube of 10 m with its lower corner at 1000, 2000, 5.
std::string cube_file(std::string_view objects, std::string_view system = "of our own") {
    return fmt::format(
        R"({{"type":"CityJSON","version":"2.0","metadata":{{"referenceSystem":"https://www.opengis.net/def/crs/{}"}},
        "transform":{{"scale":[0.01,0.01,0.01],"translate":[1000,2000,5]}},"CityObjects":{{{}}},
        "vertices":[[0,0,0],[1000,0,0],[1000,1000,0],[0,1000,0],[0,0,1000],[1000,0,1000],[1000,1000,1000],[0,1000,1000]]}})",
        system, objects);
}

const std::string cube_shell = "[[[0,3,2,1]],[[4,5,6,7]],[[0,1,5,4]],[[1,2,6,5]],[[2,3,7,6]],[[3,0,4,7]]]";

std::string solid(std::string_view lod, std::string_view semantics = "null") {
    return fmt::format(R"({{"type":"Solid","lod":{},"boundaries":[{}],"semantics":{}}})", lod, cube_shell, semantics);
}

std::string cityjson_refusal(std::string_view text) {
    const auto file = read_cityjson(text);
    EXPECT_FALSE(file);
    if (file) return "";
    EXPECT_EQ(file.error().code, ErrorCode::input);
    EXPECT_EQ(file.error().message.find('\n'), std::string::npos);
    EXPECT_THAT(file.error().message, StartsWith("town.json"));
    return file.error().message;
}

TEST(CityJson, PutsASolidInTheMiddleWithoutItsFloor) {
    const auto file =
        read_cityjson(cube_file(fmt::format(R"("a":{{"type":"Building","geometry":[{}]}})", solid("\"1\""))));
    ASSERT_TRUE(file) << file.error().message;
    EXPECT_EQ(file->buildings, 1u);
    EXPECT_EQ(count_of(file->model, SurfaceKind::wall), 8u);
    EXPECT_EQ(count_of(file->model, SurfaceKind::roof), 2u);
    EXPECT_DOUBLE_EQ(area_of(file->model), 500);
    for (const Eigen::Vector3d& vertex : file->model.vertices) {
        EXPECT_NEAR(std::abs(vertex.x()), 5, 1e-9);
        EXPECT_NEAR(std::abs(vertex.y()), 5, 1e-9);
        EXPECT_TRUE(std::abs(vertex.z()) < 1e-9 || std::abs(vertex.z() - 10) < 1e-9);
    }
    ASSERT_EQ(file->warnings.size(), 1u);
    EXPECT_THAT(file->warnings[0], HasSubstr("give an origin"));
}

TEST(CityJson, TakesTheHighestLevelAndWhatSemanticsTell) {
    const std::string told = solid("\"2.2\"", R"({"surfaces":[{"type":"GroundSurface"},{"type":"RoofSurface"},
        {"type":"WallSurface"},{"type":"Window"},{"type":"ClosureSurface"}],"values":[[0,1,2,2,3,4]]})");
    const auto file = read_cityjson(cube_file(
        fmt::format(R"("a":{{"type":"Building","geometry":[{},{},{}]}})", solid("1.3"), told, solid("\"0\""))));
    ASSERT_TRUE(file) << file.error().message;
    EXPECT_EQ(count_of(file->model, SurfaceKind::roof), 2u);
    EXPECT_EQ(count_of(file->model, SurfaceKind::wall), 6u);
    EXPECT_EQ(file->model.materials, (std::vector<std::string>{"concrete", "glass"}));
}

TEST(CityJson, JudgesSurfacesWithoutAKnownTypeAmongToldOnesBySlope) {
    const std::string told = solid("\"2.2\"", R"({"surfaces":[{"type":"GroundSurface"},{"type":"RoofSurface"},
        {"type":"WallSurface"},{"type":"+RoofWall"}],"values":[[0,null,2,2,null,3]]})");
    const auto file = read_cityjson(cube_file(fmt::format(R"("a":{{"type":"Building","geometry":[{}]}})", told)));
    ASSERT_TRUE(file) << file.error().message;
    EXPECT_EQ(count_of(file->model, SurfaceKind::roof), 2u);
    EXPECT_EQ(count_of(file->model, SurfaceKind::wall), 8u);
    const auto beside = read_cityjson(
        cube_file(fmt::format(R"("a":{{"type":"Building","geometry":[{},{}]}})", told, solid("\"2.2\""))));
    ASSERT_TRUE(beside) << beside.error().message;
    EXPECT_DOUBLE_EQ(area_of(beside->model), 500) << "a solid beside its own told surfaces";
}

TEST(CityJson, TakesTheLevelBelowOneWithoutSurfaces) {
    for (const std::string_view boundaries : {"[]", "[[[0,1,99]]]"}) {
        const auto file = read_cityjson(cube_file(fmt::format(
            R"("a":{{"type":"Building","geometry":[{},{{"type":"MultiSurface","lod":"2","boundaries":{}}}]}})",
            solid("\"1\""), boundaries)));
        ASSERT_TRUE(file) << file.error().message;
        EXPECT_DOUBLE_EQ(area_of(file->model), 500) << boundaries;
    }
}

TEST(CityJson, CountsWhatIsToldByItsOutlineAlone) {
    const std::string outline = R"({"type":"MultiSurface","lod":"0","boundaries":[[[0,1,2,3]]]})";
    const std::string houses = fmt::format(
        R"("a":{{"type":"Building","geometry":[{0}]}},"b":{{"type":"Building","geometry":[{0}]}},
        "c":{{"type":"BuildingPart","parents":["b"],"geometry":[{0}]}})",
        outline);
    EXPECT_THAT(cityjson_refusal(cube_file(houses)),
                HasSubstr("2 buildings or other constructions are told by their outlines alone"));
    const auto file = read_cityjson(cube_file(houses + fmt::format(R"(,"d":{{"type":"Building","geometry":[{}]}},
        "e":{{"type":"BuildingPart","parents":["d"],"geometry":[{}]}})",
                                                                   outline, solid("\"1\""))));
    ASSERT_TRUE(file) << file.error().message;
    EXPECT_EQ(file->buildings, 1u);
    EXPECT_THAT(file->warnings, ::testing::Contains(HasSubstr("2 buildings or other constructions")));
}

TEST(CityJson, PartsReplaceTheirWhole) {
    const std::string objects = fmt::format(
        R"("a":{{"type":"Building","children":["b"],"geometry":[{}]}},"b":{{"type":"BuildingPart","parents":["a"],"geometry":[{}]}})",
        solid("1"), solid("2"));
    const auto file = read_cityjson(cube_file(objects));
    ASSERT_TRUE(file) << file.error().message;
    EXPECT_DOUBLE_EQ(area_of(file->model), 500);
    EXPECT_EQ(file->buildings, 1u);
}

TEST(CityJson, PartsOfTheSameLevelStandBesideTheirWhole) {
    const auto wall = [](std::string_view corners) {
        return fmt::format(R"([{{"type":"MultiSurface","lod":"2","boundaries":[[{}]]}}])", corners);
    };
    const auto file = read_cityjson(cube_file(fmt::format(
        R"("a":{{"type":"Building","geometry":{}}},"b":{{"type":"BuildingPart","parents":["a"],"geometry":{}}})",
        wall("[0,1,5,4]"), wall("[2,3,7,6]"))));
    ASSERT_TRUE(file) << file.error().message;
    EXPECT_DOUBLE_EQ(area_of(file->model), 200);
    EXPECT_EQ(file->buildings, 1u);
}

TEST(CityJson, ReadsTerrainTreesAndTheRoomsOfNobody) {
    const std::string flat = R"({"type":"CompositeSurface","lod":1,"boundaries":[[[0,1,2,3]]]})";
    const auto file = read_cityjson(cube_file(fmt::format(
        R"("g":{{"type":"TINRelief","geometry":[{0}]}},"t":{{"type":"SolitaryVegetationObject","geometry":[{1}]}},
        "p":{{"type":"PlantCover","geometry":[{0}]}},"r":{{"type":"BuildingRoom","geometry":[{1}]}})",
        flat, solid("2"))));
    ASSERT_TRUE(file) << file.error().message;
    EXPECT_EQ(count_of(file->model, SurfaceKind::ground), 4u);
    EXPECT_EQ(file->model.triangles.size(), 4u);
    ASSERT_EQ(file->model.foliage.size(), 1u);
    EXPECT_EQ(file->model.foliage[0].ring.size(), 4u);
    EXPECT_NEAR(file->model.foliage[0].top - file->model.foliage[0].base, 7.5, 1e-9);
}

TEST(CityJson, ReadsLatitudesAndLongitudes) {
    const std::string text =
        R"({"type":"CityJSON","version":"1.1","metadata":{"referenceSystem":"urn:ogc:def:crs:EPSG::4979"},
        "CityObjects":{"a":{"type":"Building","geometry":[{"type":"MultiSurface","lod":"2","boundaries":[[[0,1,2]]]}]}},
        "vertices":[[50,10,100],[50.0001,10,100],[50,10,130]]})";
    CityFileSettings settings;
    settings.origin = Geodetic::degrees(50, 10, 100);
    const auto file = read_cityjson(text, settings);
    ASSERT_TRUE(file) << file.error().message;
    ASSERT_EQ(file->model.vertices.size(), 3u);
    EXPECT_NEAR(file->model.vertices[0].norm(), 0, 1e-6);
    EXPECT_NEAR(file->model.vertices[1].y(), curvature_radii(Angle::degrees(50)).meridian * Angle::degrees(1e-4).rad(),
                1e-3);
    EXPECT_NEAR(file->model.vertices[2].z(), 30, 1e-6);
    EXPECT_EQ(count_of(file->model, SurfaceKind::wall), 1u);
    const auto by_itself = read_cityjson(text);
    ASSERT_TRUE(by_itself) << by_itself.error().message;
    EXPECT_NEAR(by_itself->model.origin.latitude.deg(), 50.00005, 1e-9);
    EXPECT_NEAR(by_itself->model.origin.height.above_ellipsoid.value(), 100, 1e-9);
}

TEST(CityJson, KnowsDegreesByTheirSystemOrTheirNumbers) {
    const auto read_as = [](std::string_view metadata, bool latitude_first) {
        return read_cityjson(fmt::format(
            R"({{"type":"CityJSON","version":"1.1","metadata":{{{}}},"CityObjects":{{"a":{{"type":"Building","geometry":
            [{{"type":"MultiSurface","lod":"2","boundaries":[[[0,1,2]]]}}]}}}},"vertices":[{}]}})",
            metadata,
            latitude_first ? "[50,10,100],[50.0001,10,100],[50,10,130]" : "[10,50,100],[10,50.0001,100],[10,50,130]"));
    };
    for (const std::string_view system :
         {"EPSG:4326+5773", "urn:ogc:def:crs:EPSG::4490", "epsg:4326", "urn:ogc:def:crs,crs:EPSG::4258,crs:EPSG::5783",
          "https://www.opengis.net/def/crs-compound?1=http://www.opengis.net/def/crs/EPSG/0/4258&2=http://"
          "www.opengis.net/def/crs/EPSG/0/5621"}) {
        const auto file = read_as(fmt::format(R"("referenceSystem":"{}")", system), true);
        ASSERT_TRUE(file) << file.error().message;
        EXPECT_NEAR(file->model.origin.latitude.deg(), 50.00005, 1e-9) << system;
        EXPECT_NEAR(file->model.origin.longitude.deg(), 10, 1e-9) << system;
    }
    const auto unknown = read_as(R"("referenceSystem":"EPSG:99999")", true);
    ASSERT_TRUE(unknown) << unknown.error().message;
    EXPECT_NEAR(unknown->model.origin.latitude.deg(), 50.00005, 1e-9);
    EXPECT_THAT(unknown->warnings,
                ::testing::Contains(HasSubstr("(EPSG:99999) are taken as degrees of WGS-84, latitude")));
    const auto unnamed = read_as("", false);
    ASSERT_TRUE(unnamed) << unnamed.error().message;
    EXPECT_NEAR(unnamed->model.origin.latitude.deg(), 50.00005, 1e-9);
    EXPECT_THAT(unnamed->warnings, ::testing::Contains(HasSubstr("degrees of WGS-84, longitude first")));
}

/// A wall by three corners in three dimensions of WGS 84, latitude first (EPSG:4979).
std::string wall_file(std::string_view vertices) {
    return fmt::format(
        R"({{"type":"CityJSON","version":"1.0","metadata":{{"referenceSystem":"urn:ogc:def:crs:EPSG::4979"}},
        "CityObjects":{{"a":{{"type":"Building","geometry":[{{"type":"MultiSurface","lod":"2",
        "boundaries":[[[0,1,2]]]}}]}}}},"vertices":[{}]}})",
        vertices);
}

TEST(CityJson, ExchangesAxesOnlyWhereALongitudeIsNoLatitude) {
    const auto right = read_cityjson(wall_file("[40.015,-105.27,1600],[40.015,-105.2698,1600],[40.015,-105.27,1630]"));
    ASSERT_TRUE(right) << right.error().message;
    EXPECT_THAT(right->warnings, ::testing::IsEmpty());
    const auto against =
        read_cityjson(wall_file("[-105.27,40.015,1600],[-105.2698,40.015,1600],[-105.27,40.015,1630]"));
    ASSERT_TRUE(against) << against.error().message;
    EXPECT_THAT(against->warnings, ::testing::ElementsAre(HasSubstr("(EPSG:4979) stand longitude first")));
    EXPECT_NEAR(against->model.origin.latitude.deg(), 40.015, 1e-9);
    EXPECT_NEAR(against->model.origin.longitude.deg(), -105.2699, 1e-9);
    EXPECT_EQ(against->model.vertices, right->model.vertices);
    const auto ambiguous = read_cityjson(wall_file("[13.41,52.52,50],[13.4102,52.52,50],[13.41,52.52,80]"));
    ASSERT_TRUE(ambiguous) << ambiguous.error().message;
    EXPECT_NEAR(ambiguous->model.origin.latitude.deg(), 13.4101, 1e-9) << "as its system says";
    EXPECT_THAT(cityjson_refusal(wall_file("[-105,200,0],[-105,200.001,0],[-105,200,9]")),
                HasSubstr("found longitudes 200 … 200.001 and latitudes -105 … -105"));
}

TEST(CityJson, DropsWrongCornersAndSaysSo) {
    const auto file = read_cityjson(cube_file(R"("a":{"type":"Building","geometry":[{"type":"MultiSurface","lod":"2",
        "boundaries":[[[0,1,5,4]],[[0,1,99]],[[0,-1,2]],[["a",1,2]],[[0,1]],[[0,0,0]],7]}]})"));
    ASSERT_TRUE(file) << file.error().message;
    EXPECT_EQ(file->dropped, 6u);
    EXPECT_EQ(file->model.triangles.size(), 2u);
    EXPECT_THAT(file->warnings, ::testing::Contains(HasSubstr("6 surfaces")));
}

// A line each: what all share, and two buildings with corners of their own.
TEST(CityJson, ReadsTextSequences) {
    const std::string head =
        R"({"type":"CityJSON","version":"2.0","transform":{"scale":[1,1,1],"translate":[691000,5334000,5]},)"
        R"("metadata":{"referenceSystem":"https://www.opengis.net/def/crs/EPSG/0/25832"},"CityObjects":{},"vertices":[]})"
        "\n";
    const auto feature = [](int east) {
        return fmt::format(R"({{"type":"CityJSONFeature","id":"b{0}","CityObjects":{{"b{0}":{{"type":"Building",)"
                           R"("geometry":[{1}]}}}},"vertices":[[{0},0,0],[{2},0,0],[{2},10,0],[{0},10,0],)"
                           R"([{0},0,10],[{2},0,10],[{2},10,10],[{0},10,10]]}})"
                           "\r\n",
                           east, solid("\"1\""), east + 10);
    };
    const auto file = parse_cityjson_sequence(head + feature(0) + "\n" + feature(30), "town.city.jsonl", {});
    ASSERT_TRUE(file) << file.error().message;
    EXPECT_EQ(file->buildings, 2u);
    EXPECT_EQ(file->format, "cityjson");
    EXPECT_NEAR(area_of(file->model), 1000, 10) << "but for the scale of the map";
    for (const auto& [text, why] :
         {std::pair(head + "{\"type\":\"CityJSON\"}", ":2: \"type\" is \"CityJSON\", expected \"CityJSONFeature\""),
          std::pair(feature(0), ":1: \"type\" is \"CityJSONFeature\", expected \"CityJSON\""),
          std::pair(head + "{", ":2:2: the text ends within a value"), std::pair(std::string(), ": no line")}) {
        const auto refused = parse_cityjson_sequence(text, "town.city.jsonl", {});
        ASSERT_FALSE(refused);
        EXPECT_THAT(refused.error().message, StartsWith(std::string("town.city.jsonl") + why));
    }
}

TEST(CityJson, RefusesWithOneClearLine) {
    EXPECT_THAT(cityjson_refusal("{"), HasSubstr("town.json:1:2"));
    EXPECT_THAT(cityjson_refusal("{}"), HasSubstr("expected \"CityJSON\""));
    EXPECT_THAT(cityjson_refusal(R"({"type":"CityJSON"})"), HasSubstr("\"vertices\""));
    EXPECT_THAT(cityjson_refusal(R"({"type":"CityJSON","vertices":[[1,2]]})"), HasSubstr("vertex 0"));
    EXPECT_THAT(cityjson_refusal(R"({"type":"CityJSON","vertices":[]})"), HasSubstr("\"CityObjects\""));
    EXPECT_THAT(cityjson_refusal(R"({"type":"CityJSON","transform":{"scale":1},"vertices":[]})"),
                HasSubstr("\"transform\""));
    EXPECT_THAT(cityjson_refusal(cube_file("")), HasSubstr("no surface"));
    EXPECT_THAT(cityjson_refusal(
                    cube_file(fmt::format(R"("a":{{"type":"Building","geometry":[{}]}})", solid("1")), "EPSG:4326")),
                HasSubstr("expected degrees on the globe, found longitudes 2000"));
}

TEST(CityJson, ReadsDelft) {
    SKYLOOP_REQUIRE_SHARED(path, "city/delft.json");
    const auto text = read_text_file(path);
    ASSERT_TRUE(text);
    CityFileSettings settings;
    const auto file = parse_cityjson(*text, "delft.json", settings);
    ASSERT_TRUE(file) << file.error().message;
    EXPECT_EQ(file->buildings, 160u);
    EXPECT_GT(count_of(file->model, SurfaceKind::ground), 1000u);
    EXPECT_GE(file->model.foliage.size(), 10u);
    // Where the middle of the extent that the file states lies: echo 84878.653 447586.818 | cs2cs EPSG:28992 EPSG:4326.
    EXPECT_NEAR(file->model.origin.latitude.deg(), 52.012207498, 1e-5);
    EXPECT_NEAR(file->model.origin.longitude.deg(), 4.365796156, 1e-5);
    // It is 524.4 m by 327.8 m, up to 16.8 m, and the map's north is 0.8° west of true north.
    for (const Eigen::Vector3d& vertex : file->model.vertices) {
        EXPECT_LE(std::abs(vertex.x()), 262.3 + 2.4);
        EXPECT_LE(std::abs(vertex.y()), 164 + 3.7);
        EXPECT_LE(std::abs(vertex.z() - 8), 9);
    }
}

TEST(CityJson, ReadsRotterdam) {
    SKYLOOP_REQUIRE_SHARED(path, "city/rotterdam_subset.json");
    const auto text = read_text_file(path);
    ASSERT_TRUE(text);
    const auto file = parse_cityjson(*text, "rotterdam.json", {});
    ASSERT_TRUE(file) << file.error().message;
    EXPECT_EQ(file->buildings, 16u);
    EXPECT_GT(count_of(file->model, SurfaceKind::wall), 200u);
    EXPECT_GT(count_of(file->model, SurfaceKind::roof), 16u);
    EXPECT_EQ(count_of(file->model, SurfaceKind::ground), 0u);
}

}  // namespace
}  // namespace skyloop::test
