#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fmt/format.h>

#include "base/geo/local_frame.hpp"
#include "mesh_support.hpp"
#include "world/city/city_file.hpp"

namespace skyloop::test {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

Result<CityFile> read_geojson(std::string_view text, const CityFileSettings& settings = {}) {
    return parse_geojson(text, "town.geojson", settings);
}

std::string feature(std::string_view properties, std::string_view geometry) {
    return fmt::format(R"({{"type":"Feature","properties":{},"geometry":{}}})", properties, geometry);
}

std::string collection(std::string_view features, std::string_view more = "") {
    return fmt::format(R"({{"type":"FeatureCollection"{},"features":[{}]}})", more, features);
}

/// A square with sides of so many degrees at 10° E 50° N.
std::string square(double side, double east = 0) {
    return fmt::format(R"({{"type":"Polygon","coordinates":[[[{0},50],[{1},50],[{1},{2}],[{0},{2}],[{0},50]]]}})",
                       10 + east, 10 + east + side, 50 + side);
}

std::string geojson_refusal(std::string_view text) {
    const auto file = read_geojson(text);
    EXPECT_FALSE(file);
    if (file) return "";
    EXPECT_EQ(file.error().code, ErrorCode::input);
    EXPECT_EQ(file.error().message.find('\n'), std::string::npos);
    EXPECT_THAT(file.error().message, StartsWith("town.geojson"));
    return file.error().message;
}

TEST(GeoJson, RaisesAHouseInTheMiddleOfItsExtent) {
    const auto file = read_geojson(collection(feature(R"({"height":12.5,"min_height":"2 m"})", square(0.001))));
    ASSERT_TRUE(file) << file.error().message;
    EXPECT_EQ(file->buildings, 1u);
    EXPECT_TRUE(file->warnings.empty());
    EXPECT_NEAR(file->model.origin.latitude.deg(), 50.0005, 1e-9);
    EXPECT_NEAR(file->model.origin.longitude.deg(), 10.0005, 1e-9);
    EXPECT_EQ(file->model.triangles.size(), 4u * 2 + 2);
    // 111.229 m and 71.69 m a thousandth of a degree: M = 6 373 157 m… at 50° N, N cos 50° = 4 107 864 m.
    double east = 0, north = 0;
    for (const Eigen::Vector3d& vertex : file->model.vertices) {
        east = std::max(east, vertex.x());
        north = std::max(north, vertex.y());
        EXPECT_TRUE(std::abs(vertex.z() - 2) < 0.01 || std::abs(vertex.z() - 12.5) < 0.01) << vertex.z();
    }
    const CurvatureRadii radii = curvature_radii(Angle::degrees(50));
    EXPECT_NEAR(2 * north, radii.meridian * Angle::degrees(0.001).rad(), 0.01);
    EXPECT_NEAR(2 * east, radii.prime_vertical * std::cos(Angle::degrees(50).rad()) * Angle::degrees(0.001).rad(),
                0.01);
}

TEST(GeoJson, StandsAtTheGivenOrigin) {
    CityFileSettings settings;
    settings.origin = Geodetic::degrees(50, 10, 321);
    const auto file = read_geojson(collection(feature(R"({"height":10})", square(0.001))), settings);
    ASSERT_TRUE(file) << file.error().message;
    EXPECT_EQ(file->model.origin.height.above_ellipsoid.value(), 321);
    EXPECT_NEAR(file->model.vertices.front().norm(), 0, 0.01);
}

TEST(GeoJson, ReadsLevelsMaterialsAndWoods) {
    const auto file = read_geojson(
        collection(feature(R"({"Building:Levels":"4","building":"yes","building:material":"glass"})", square(0.001)) +
                   "," + feature(R"({"natural":"wood","height":"20"})", square(0.001, 0.01)) + "," +
                   feature(R"({"landuse":"residential"})", square(0.1))));
    ASSERT_TRUE(file) << file.error().message;
    EXPECT_EQ(file->buildings, 1u);
    EXPECT_NEAR(highest_of(file->model).z(), 12, 0.1);
    EXPECT_EQ(file->model.materials.at(file->model.triangles.front().material), "glass");
    ASSERT_EQ(file->model.foliage.size(), 1u);
    EXPECT_NEAR(file->model.foliage.front().top, 20, 0.1);
    EXPECT_NEAR(file->model.foliage.front().top - file->model.foliage.front().base, 15, 1e-9) << "trunks are no crown";
    ASSERT_EQ(file->warnings.size(), 1u);
    EXPECT_THAT(file->warnings[0], HasSubstr("1 features"));
}

TEST(GeoJson, BuildsNoHousesOnCarParksAndLakes) {
    const std::string others = feature(R"({"amenity":"parking"})", square(0.001, 0.01)) + "," +
                               feature(R"({"water":"lake","height":3})", square(0.001, 0.02)) + "," +
                               feature(R"({"power":"substation"})", square(0.001, 0.03));
    const std::string plain = feature(R"({"id":7,"building":""})", square(0.001, 0.04));
    const std::string tall = feature(R"({"name":"tower","height":80})", square(0.001, 0.05));
    const std::string tank = feature(R"({"man_made":"storage_tank","height":15})", square(0.001, 0.06));
    const auto buildings = [&](const std::string& features) {
        const auto file = read_geojson(collection(features));
        EXPECT_TRUE(file) << file.error().message;
        return file ? file->buildings : 0;
    };
    const std::string rest = others + "," + plain + "," + tall + "," + tank;
    EXPECT_EQ(buildings(rest), 3U) << "where nothing is named a building, what has a height or no other name is one";
    const std::string named = feature(R"({"tags":{"building":"yes"}})", square(0.001));
    EXPECT_EQ(buildings(named + "," + rest), 2U) << "the one that is named and the tower";
}

TEST(GeoJson, WideWoodsFollowTheEarth) {
    const auto file = read_geojson(collection(feature(R"({"natural":"wood"})", square(0.1))));
    ASSERT_TRUE(file) << file.error().message;
    EXPECT_GT(file->model.foliage.size(), 100u);
    double area = 0;
    for (const FoliageVolume& trees : file->model.foliage) {
        Eigen::Vector2d lowest = trees.ring.front(), highest = lowest;
        for (const Eigen::Vector2d& corner : trees.ring) {
            lowest = lowest.cwiseMin(corner);
            highest = highest.cwiseMax(corner);
        }
        EXPECT_LE((highest - lowest).maxCoeff(), 500);
        area += (highest - lowest).prod();
        EXPECT_NEAR(trees.top, 12 - ((lowest + highest) / 2).squaredNorm() / 2 / 6.378e6, 0.1);
        EXPECT_NEAR(trees.top - trees.base, 9, 1e-9);
    }
    EXPECT_NEAR(area / (0.1 * 111'230 * 0.1 * 71'580), 1, 0.01);
}

TEST(GeoJson, CountsMissingHeightsInOneWarning) {
    CityFileSettings settings;
    settings.default_height = 7;
    const auto file = read_geojson(
        collection(feature("{}", square(0.001)) + "," + feature(R"({"height":"tall"})", square(0.001, 0.002)) + "," +
                   feature(R"({"height":5})", square(0.001, 0.004)) + "," +
                   feature(R"({"height":-5})", square(0.001, 0.006))),
        settings);
    ASSERT_TRUE(file) << file.error().message;
    ASSERT_EQ(file->warnings.size(), 1u);
    EXPECT_THAT(file->warnings[0], HasSubstr("3 of 4 buildings have no height"));
    EXPECT_NEAR(highest_of(file->model).z(), 7, 0.1);
}

TEST(GeoJson, TakesMetresWhenNumbersAreNoDegrees) {
    const auto local = read_geojson(feature(R"({"height":5})", R"({"type":"MultiPolygon","coordinates":[
        [[[0,0],[40,0],[40,30],[0,30],[0,0]],[[10,10],[20,10],[20,20],[10,20]]],[[[100,0],[110,0],[110,10]]]]})"));
    ASSERT_TRUE(local) << local.error().message;
    EXPECT_EQ(local->buildings, 2u);
    EXPECT_DOUBLE_EQ(area_of(local->model), 140 * 5 + 1100 + 40 * 5 + (20 + std::sqrt(200)) * 5 + 50);
    EXPECT_THAT(local->warnings.at(0), HasSubstr("metres"));

    const auto utm = read_geojson(collection(
        feature(
            R"({"height":5})",
            R"({"type":"Polygon","coordinates":[[[500000,5500000],[500040,5500000],[500040,5500030],[500000,5500030]]]})"),
        R"(,"crs":{"type":"name","properties":{"name":"a map of our own"}})"));
    ASSERT_TRUE(utm) << utm.error().message;
    EXPECT_DOUBLE_EQ(highest_of(utm->model).z(), 5);
    EXPECT_DOUBLE_EQ(area_of(utm->model), 140 * 5 + 1200);
    EXPECT_LE(utm->model.vertices.front().head<2>().norm(), 25.001);
    EXPECT_THAT(utm->warnings.at(0), HasSubstr("a map of our own"));
}

TEST(GeoJson, AHeightThatTellsNothingHidesNoOther) {
    const auto top_of = [](std::string_view properties) {
        const auto file = read_geojson(feature(properties, square(0.001)));
        EXPECT_TRUE(file) << file.error().message;
        return file ? std::round(100 * highest_of(file->model).z()) / 100 : 0;
    };
    EXPECT_EQ(top_of(R"({"height":0,"levels":7})"), 21);
    EXPECT_EQ(top_of(R"({"height":-1,"levels":7})"), 21);
    EXPECT_EQ(top_of(R"({"height":"0 m","render_height":"0","est_height":14})"), 14);
    EXPECT_EQ(top_of(R"({"height":"20,5"})"), 20.5);
    EXPECT_EQ(top_of(R"({"height":"20,5 m"})"), 20.5);
    EXPECT_EQ(top_of(R"({"building:levels":"5;6"})"), 15);
    EXPECT_EQ(top_of(R"({"height":"20,m","levels":2})"), 6);
    EXPECT_EQ(top_of(R"({"height":0,"levels":0})"), 9);
}

TEST(GeoJson, ReadsTheOtherTagsOfGdal) {
    const auto top_of = [](std::string_view others) {
        const auto file = read_geojson(
            collection(feature(fmt::format(R"({{"building":"yes","other_tags":"{}"}})", others), square(0.001))));
        EXPECT_TRUE(file) << file.error().message;
        return file ? std::round(100 * highest_of(file->model).z()) / 100 : 0;
    };
    EXPECT_EQ(top_of(R"(\"building:levels\"=>\"6\",\"name\"=>\"the \\\"tower\\\", \\\\\",\"height\"=>\"21\")"), 21);
    EXPECT_EQ(top_of(R"(\"building:levels\"=>\"6\")"), 18);
    for (const std::string_view cut : {"", R"(\")", R"(\"height\"=>)", R"(\"height\"=>\"21)", R"(\"height\"=>\"21\\)"})
        EXPECT_EQ(top_of(cut), 9) << cut;
}

TEST(GeoJson, ReadsThePropertiesOfOverture) {
    const auto file = read_geojson(
        collection(feature(R"({"num_floors":10,"roof_height":2.5,"is_underground":false})", square(0.001)) + "," +
                   feature(R"({"num_floors":3,"is_underground":true})", square(0.001, 0.01))));
    ASSERT_TRUE(file) << file.error().message;
    EXPECT_EQ(file->buildings, 1U);
    EXPECT_NEAR(highest_of(file->model).z(), 32.5, 0.05);
    const auto high = read_geojson(feature(R"({"num_floors":20,"min_floor":10})", square(0.001)));
    ASSERT_TRUE(high) << high.error().message;
    for (const Eigen::Vector3d& vertex : high->model.vertices)
        EXPECT_GT(vertex.z(), 29.9);
}

/// A square between two longitudes at 16.8° S.
std::string fijian_square(double west, double east) {
    return fmt::format(
        R"({{"type":"Polygon","coordinates":[[[{0},-16.8],[{1},-16.8],[{1},-16.7998],[{0},-16.7998],[{0},-16.8]]]}})",
        west, east);
}

TEST(GeoJson, JoinsWhatIsCutAtThe180thMeridian) {
    const auto file = read_geojson(collection(feature(R"({"height":20})", fijian_square(179.9998, 180)) + "," +
                                              feature(R"({"height":20})", fijian_square(-180, -179.9998))));
    ASSERT_TRUE(file) << file.error().message;
    EXPECT_TRUE(file->warnings.empty());
    EXPECT_NEAR(std::abs(file->model.origin.longitude.deg()), 180, 1e-9);
    for (const Eigen::Vector3d& vertex : file->model.vertices) {
        EXPECT_LT(vertex.head<2>().norm(), 30);
        EXPECT_LT(vertex.z(), 20.1);
    }
    CityFileSettings east;
    east.origin = Geodetic::degrees(-16.8, -179.9998, 0);
    const auto seen = read_geojson(feature("{}", fijian_square(179.9998, 180)), east);
    ASSERT_TRUE(seen) << seen.error().message;
    EXPECT_LT(seen->model.vertices.front().norm(), 60);
}

TEST(GeoJson, AStrayFeatureMakesNoMetresOfDegrees) {
    const std::string town = feature("{}", square(0.001)) + "," + feature("{}", square(0.001, 0.002));
    EXPECT_THAT(geojson_refusal(collection(town + "," + feature("{}", square(0.001, 6)))),
                HasSubstr("within 5 degrees of each other, found 10 … 16.001"));
}

TEST(GeoJson, KnowsDegreesByTheirSystemOrTheirNumbers) {
    for (const std::string_view system :
         {"urn:ogc:def:crs:EPSG::4490", "EPSG:4674", "epsg:4619", "urn:ogc:def:crs:EPSG:6.9:4167",
          "http://www.opengis.net/gml/srs/epsg.xml#4171", "EPSG:4258+5773", "EPSG:99999", "one of our own"}) {
        const auto file =
            read_geojson(collection(feature(R"({"height":20})", square(0.001)),
                                    fmt::format(R"(,"crs":{{"type":"name","properties":{{"name":"{}"}}}})", system)));
        ASSERT_TRUE(file) << file.error().message;
        EXPECT_NEAR(file->model.origin.longitude.deg(), 10.0005, 1e-9) << system;
        EXPECT_TRUE(file->warnings.empty()) << system;
    }
}

TEST(GeoJson, SaysWhichSettingsMeanNothing) {
    CityFileSettings settings;
    settings.axes = FileAxes{};
    settings.file_origin = {1, 2, 3};
    settings.metres_per_unit = 0.01;
    const auto file = read_geojson(feature(R"({"height":5})", square(0.001)), settings);
    ASSERT_TRUE(file);
    EXPECT_THAT(file->warnings, ::testing::ElementsAre(HasSubstr("axes mean nothing"), HasSubstr("file_origin means"),
                                                       HasSubstr("length of a unit")));
}

TEST(GeoJson, ScalesWebMercator) {
    const auto file = read_geojson(collection(
        feature(R"({"height":5})", R"({"type":"Polygon","coordinates":[[[1224464.4,6123457.4],[1224564.4,6123457.4],
            [1224564.4,6123557.4],[1224464.4,6123557.4]]]})"),
        R"(,"crs":{"type":"name","properties":{"name":"urn:ogc:def:crs:EPSG::3857"}})"));
    ASSERT_TRUE(file) << file.error().message;
    EXPECT_TRUE(file->warnings.empty());
    EXPECT_NEAR(file->model.origin.latitude.deg(), 48.1, 1e-6);
    EXPECT_NEAR(file->model.origin.longitude.deg(), 11, 1e-6);
    EXPECT_NEAR(area_of(file->model), 66.9 * 66.7 + 2 * 5 * (66.9 + 66.7), 10);
}

TEST(GeoJson, PartsReplaceTheirBuilding) {
    const std::string whole = feature(R"({"building":"yes","height":50})", square(0.001));
    const std::string part = feature(R"({"building:part":"yes","height":20})", square(0.00099));
    const std::string small_part = feature(R"({"building:part":"yes","height":20})", square(0.0001));
    const auto replaced = read_geojson(collection(whole + "," + part));
    ASSERT_TRUE(replaced) << replaced.error().message;
    EXPECT_NEAR(highest_of(replaced->model).z(), 20, 0.1);
    const auto kept = read_geojson(collection(small_part + "," + whole));
    ASSERT_TRUE(kept) << kept.error().message;
    EXPECT_NEAR(highest_of(kept->model).z(), 50, 0.1);
    EXPECT_EQ(kept->buildings, 2u);
}

TEST(GeoJson, PartsInheritWhatTheyDoNotTell) {
    const std::string whole = feature(R"({"building":"yes","height":50,"building:material":"glass"})", square(0.001));
    const auto file = read_geojson(
        collection(feature(R"({"building:part":"yes","roof:shape":"gabled"})", square(0.00099)) + "," + whole));
    ASSERT_TRUE(file) << file.error().message;
    EXPECT_EQ(file->buildings, 1u);
    EXPECT_TRUE(file->warnings.empty());
    EXPECT_NEAR(highest_of(file->model).z(), 50, 0.1);
    EXPECT_EQ(file->model.materials.at(file->model.triangles.front().material), "glass");
    const auto above =
        read_geojson(collection(whole + "," + feature(R"({"building:part":"yes","min_height":60})", square(0.0001))));
    ASSERT_TRUE(above) << above.error().message;
    EXPECT_EQ(above->buildings, 2u) << "one that begins above its building is as tall as a level";
    EXPECT_NEAR(highest_of(above->model).z(), 63, 0.1);
}

TEST(GeoJson, DropsWhatIsNoPolygonAndSaysSo) {
    const auto file = read_geojson(
        collection(feature(R"({"height":9})", square(0.001)) + "," +
                   feature(R"({"height":9})", R"({"type":"Polygon","coordinates":[[[10,50],[10,50]]]})") + "," +
                   feature(R"({"height":9})", R"({"type":"Polygon","coordinates":[[["a",50],[10,50],[11,51]]]})") +
                   "," + feature(R"({"height":9})", R"({"type":"Polygon","coordinates":7})") + "," +
                   feature(R"({"height":9})", R"({"type":"Point","coordinates":[10,50]})") + ",17"));
    ASSERT_TRUE(file) << file.error().message;
    EXPECT_EQ(file->dropped, 3u);
    EXPECT_EQ(file->buildings, 1u);
    EXPECT_THAT(file->warnings, ::testing::Contains(HasSubstr("3 outlines")));
}

TEST(GeoJson, RefusesWithOneClearLine) {
    EXPECT_THAT(geojson_refusal("{\"type\":\"FeatureCollection\",\n\"features\":["),
                HasSubstr("town.geojson:2:13: the text ends"));
    EXPECT_THAT(geojson_refusal("{\"type\" \"Feature\"}"), HasSubstr("town.geojson:1:"));
    EXPECT_THAT(geojson_refusal(R"({"type":"Topology"})"), HasSubstr("\"Topology\""));
    EXPECT_THAT(geojson_refusal(R"({"version":0.6,"elements":[]})"), HasSubstr("ask it for [out:xml]"));
    EXPECT_THAT(geojson_refusal(R"({"type":"FeatureCollection","features":3})"), HasSubstr("\"features\""));
    EXPECT_THAT(geojson_refusal(collection("")), HasSubstr("no outline"));
    EXPECT_THAT(geojson_refusal("[1e999]"), HasSubstr("number"));
    EXPECT_THAT(geojson_refusal(std::string(100'000, '[')), HasSubstr("nested deeper"));
    EXPECT_THAT(geojson_refusal(""), HasSubstr("ends"));
    EXPECT_THAT(geojson_refusal(feature("{}", R"({"type":"Polygon","coordinates":[[[0,0],[1e300,0],[1e300,1e300]]]})")),
                HasSubstr("could be used"));
    CityFileSettings few;
    few.most_triangles = 9;
    const auto file = read_geojson(feature("{}", square(0.001)), few);
    ASSERT_FALSE(file);
    EXPECT_THAT(file.error().message, HasSubstr("more than 9 triangles"));
}

}  // namespace
}  // namespace skyloop::test
