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

std::string gml_file(std::string_view members, std::string_view system = "a map of our own") {
    return fmt::format(R"(<?xml version="1.0"?><CityModel xmlns:gml="g" xmlns:bldg="b"><gml:boundedBy>
        <gml:Envelope srsName="{}" srsDimension="3"/></gml:boundedBy>{}</CityModel>)",
                       system, members);
}

std::string gml_polygon(std::string_view places, std::string_view hole = "") {
    std::string text = fmt::format(
        "<gml:surfaceMember><gml:Polygon><gml:exterior><gml:LinearRing><gml:posList>{}</gml:posList></gml:LinearRing>"
        "</gml:exterior>",
        places);
    if (!hole.empty()) text += fmt::format("<gml:interior><gml:LinearRing>{}</gml:LinearRing></gml:interior>", hole);
    return text + "</gml:Polygon></gml:surfaceMember>";
}

const std::string roof_places = "0 0 9 10 0 9 10 10 9 0 10 9 0 0 9";
const std::string wall_places = "0 0 1 10 0 1 10 0 9 0 0 9 0 0 1";
const std::string floor_places = "0 0 1 10 0 1 10 10 1 0 10 1 0 0 1";

Result<CityFile> read_citygml(std::string_view text, const CityFileSettings& settings = {}) {
    return parse_citygml(text, "town.gml", settings);
}

std::string citygml_refusal(std::string_view text) {
    const auto file = read_citygml(text);
    EXPECT_FALSE(file);
    if (file) return "";
    EXPECT_EQ(file.error().code, ErrorCode::input);
    EXPECT_EQ(file.error().message.find('\n'), std::string::npos);
    EXPECT_THAT(file.error().message, StartsWith("town.gml"));
    return file.error().message;
}

TEST(CityGml, TakesToldSurfacesOfTheHighestLevel) {
    const auto file = read_citygml(gml_file(
        "<m><bldg:Building><bldg:lod1Solid>" + gml_polygon("0 0 0 99 0 0 99 99 0") +
        "</bldg:lod1Solid><bldg:boundedBy>" + "<bldg:RoofSurface><bldg:lod2MultiSurface>" +
        gml_polygon(
            roof_places,
            "<gml:pos>2 2 9</gml:pos><gml:pos>4 2 9</gml:pos><gml:pos>4 4 9</gml:pos><gml:pos>2 4 9</gml:pos>") +
        "</bldg:lod2MultiSurface></bldg:RoofSurface></"
        "bldg:boundedBy><bldg:boundedBy><bldg:WallSurface><bldg:lod2MultiSurface>" +
        gml_polygon(wall_places) + "</bldg:lod2MultiSurface></bldg:WallSurface></bldg:boundedBy><bldg:boundedBy>" +
        "<bldg:GroundSurface><bldg:lod2MultiSurface>" + gml_polygon(floor_places) +
        "</bldg:lod2MultiSurface></bldg:GroundSurface></bldg:boundedBy></bldg:Building></m>"));
    ASSERT_TRUE(file) << file.error().message;
    EXPECT_EQ(file->buildings, 1u);
    EXPECT_DOUBLE_EQ(area_of(file->model), 96 + 80);
    EXPECT_EQ(count_of(file->model, SurfaceKind::wall), 2u);
    EXPECT_EQ(count_of(file->model, SurfaceKind::ground), 0u);
    EXPECT_DOUBLE_EQ(highest_of(file->model).z(), 8);
    EXPECT_THAT(file->warnings.at(0), HasSubstr("a map of our own"));
}

TEST(CityGml, JudgesBoundariesOfAnotherTypeBySlope) {
    const auto file =
        read_citygml(gml_file("<Building><lod2Solid>" + gml_polygon(wall_places) +
                              "</lod2Solid><boundedBy><RoofSurface><lod2MultiSurface>" + gml_polygon(roof_places) +
                              "</lod2MultiSurface></RoofSurface></boundedBy><boundedBy><x:Facade><lod2MultiSurface>" +
                              gml_polygon(wall_places) + "</lod2MultiSurface></x:Facade></boundedBy></Building>"));
    ASSERT_TRUE(file) << file.error().message;
    EXPECT_EQ(count_of(file->model, SurfaceKind::roof), 2u);
    EXPECT_EQ(count_of(file->model, SurfaceKind::wall), 2u) << "the solid says the same once more";
}

TEST(CityGml, TellsWallsAndRoofsOfASolidBySlope) {
    const auto file =
        read_citygml(gml_file("<bldg:Building><bldg:lod1Solid>" + gml_polygon(roof_places) + gml_polygon(wall_places) +
                              gml_polygon(floor_places) + "</bldg:lod1Solid></bldg:Building>"));
    ASSERT_TRUE(file) << file.error().message;
    EXPECT_EQ(count_of(file->model, SurfaceKind::wall), 2u);
    EXPECT_EQ(count_of(file->model, SurfaceKind::roof), 2u);
}

TEST(CityGml, ReadsGeographicPlacesAndRelief) {
    const auto file =
        read_citygml(gml_file("<Relief><TINRelief><gml:Triangle><gml:exterior><gml:LinearRing><gml:posList>35 139 3 "
                              "35.001 139 3 35 139.001 3 "
                              "</gml:posList></gml:LinearRing></gml:exterior></gml:Triangle></TINRelief></Relief>",
                              "http://www.opengis.net/def/crs/EPSG/0/6697"));
    ASSERT_TRUE(file) << file.error().message;
    EXPECT_EQ(count_of(file->model, SurfaceKind::ground), 1u);
    EXPECT_NEAR(file->model.origin.latitude.deg(), 35.0005, 1e-9);
    EXPECT_NEAR(file->model.origin.longitude.deg(), 139.0005, 1e-9);
    EXPECT_NEAR(file->model.origin.height.above_ellipsoid.value(), 3, 1e-9);
    EXPECT_NEAR(file->model.vertices.at(1).y() - file->model.vertices.at(0).y(), 110.94, 0.02);
}

std::string square_roof(double east, double north, double height) {
    return "<Building><lod2MultiSurface>" +
           gml_polygon(fmt::format("{0} {1} {4} {2} {1} {4} {2} {3} {4} {0} {3} {4} {0} {1} {4}", east, north,
                                   east + 100, north + 100, height)) +
           "</lod2MultiSurface></Building>";
}

TEST(CityGml, LaysKnownProjectionsOnTheEarth) {
    // The middle of Munich in UTM 32: east of the grid is 1.9187° south of east, 1.0000509 m of the grid are a
    // metre of the ellipsoid, 1.0000815 m at 520 m.
    const std::string town = gml_file(square_roof(691553.032, 5334730.031, 520), "EPSG:25832");
    const auto file = read_citygml(town);
    ASSERT_TRUE(file) << file.error().message;
    EXPECT_NEAR(file->model.origin.latitude.deg(), 48.1374, 1e-8);
    EXPECT_NEAR(file->model.origin.longitude.deg(), 11.5755, 1e-8);
    EXPECT_TRUE(file->warnings.empty()) << file->warnings.at(0);
    const Eigen::Vector3d edge = file->model.vertices.at(1) - file->model.vertices.at(0);
    EXPECT_NEAR(edge.head<2>().norm(), 100 * 1.0000815 / 1.0000509, 1e-3);
    EXPECT_NEAR(std::atan2(-edge.y(), edge.x()), Angle::degrees(1.9187).rad(), 1e-5);

    CityFileSettings aside;
    aside.origin = Geodetic::degrees(48.1374, 11.5755 + 0.001, 600);
    const auto seen = read_citygml(town, aside);
    ASSERT_TRUE(seen) << seen.error().message;
    const Eigen::Vector3d middle = (seen->model.vertices.at(0) + seen->model.vertices.at(2)) / 2;
    EXPECT_NEAR(middle.x(), -74.4, 0.1);
    EXPECT_NEAR(middle.z(), 0, 0.01) << "the ground of the file lies at the height of the origin";
    EXPECT_THAT(seen->warnings, ::testing::ElementsAre(HasSubstr("at 520.000 of the file")));
}

/// A lamp whose shape is an upright triangle, 1 m wide and 2 m tall, that is doubled and put 10 m east and 1 m up of a
/// reference point.
std::string lamp(std::string_view place, std::string_view shape) {
    return fmt::format(
        "<frn:CityFurniture><frn:lod1ImplicitRepresentation><ImplicitGeometry>"
        "<transformationMatrix>2 0 0 10 0 2 0 0 0 0 2 1 0 0 0 1</transformationMatrix>{}"
        "<referencePoint><gml:Point><gml:pos>{}</gml:pos></gml:Point></referencePoint>"
        "</ImplicitGeometry></frn:lod1ImplicitRepresentation></frn:CityFurniture>",
        shape, place);
}

const std::string lamp_shape = "<relativeGMLGeometry><gml:MultiSurface gml:id='lamp'>" +
                               gml_polygon("0 0 0 1 0 0 1 0 2 0 0 0") + "</gml:MultiSurface></relativeGMLGeometry>";

TEST(CityGml, StandsImplicitGeometriesAtTheirReferencePoints) {
    const auto utm = read_citygml(gml_file(
        square_roof(691553.032, 5334730.031, 520) + lamp("691603.032 5334780.031 520", lamp_shape), "EPSG:25832"));
    ASSERT_TRUE(utm) << utm.error().message;
    EXPECT_TRUE(utm->warnings.empty()) << utm->warnings.at(0);
    EXPECT_NEAR(utm->model.origin.latitude.deg(), 48.1374, 1e-8);
    // East of the grid is 1.9187° south of east there.
    const Eigen::Vector3d top(12 * std::cos(Angle::degrees(1.9187).rad()), -12 * std::sin(Angle::degrees(1.9187).rad()),
                              5);
    EXPECT_LT((highest_of(utm->model) - top).norm(), 0.02) << highest_of(utm->model).transpose();

    const auto degrees = read_citygml(gml_file(
        "<Building><lod2MultiSurface>" + gml_polygon("35 139 3 35 139.001 3 35.001 139.001 3 35.001 139 3 35 139 3") +
            "</lod2MultiSurface></Building>" + lamp("35.0005 139.0005 3", lamp_shape),
        "EPSG:6667"));
    ASSERT_TRUE(degrees) << degrees.error().message;
    EXPECT_LT((highest_of(degrees->model) - Eigen::Vector3d(12, 0, 5)).norm(), 0.02)
        << highest_of(degrees->model).transpose();
}

TEST(CityGml, TakesLinkedShapesAndCountsImplicitGeometriesThatItCannotUse) {
    const std::string town = square_roof(691550, 5334730, 520);
    const auto file = read_citygml(
        gml_file(town + lamp("691600 5334780 520", "<relativeGMLGeometry xlink:href='#lamp'/>") +
                     lamp("691610 5334780 520", lamp_shape) +
                     lamp("691620 5334780 520", "<libraryObject>lamp.obj</libraryObject>") +
                     lamp("691630 5334780 520", "<relativeGMLGeometry xlink:href='#none'/>") + lamp("", lamp_shape),
                 "EPSG:25832"));
    ASSERT_TRUE(file) << file.error().message;
    EXPECT_EQ(count_of(file->model, SurfaceKind::wall), 2u);
    EXPECT_THAT(file->warnings, ::testing::ElementsAre(HasSubstr("3 implicit geometries")));
    const std::string circle = "<relativeGMLGeometry><a gml:id='lamp'>" +
                               lamp("0 0 0", "<relativeGMLGeometry xlink:href='#lamp'/>") +
                               "</a></relativeGMLGeometry>";
    const auto round = read_citygml(gml_file(town + lamp("691600 5334780 520", circle), "EPSG:25832"));
    ASSERT_TRUE(round) << round.error().message;
    EXPECT_THAT(round->warnings, ::testing::ElementsAre(HasSubstr("1 implicit geometries")));
}

TEST(CityGml, TakesTheZoneOffEastingsAndRefusesThoseBeyondTheMap) {
    for (const std::string_view system : {"urn:adv:crs:ETRS89_UTM33*DE_DHHN2016_NH", "EPSG:25833", "EPSG:5650"}) {
        const auto file = read_citygml(gml_file(square_roof(33392068.4866, 5820014.6749, 20), system));
        ASSERT_TRUE(file) << file.error().message;
        EXPECT_NEAR(file->model.origin.latitude.deg(), 52.52, 1e-8) << system;
        EXPECT_NEAR(file->model.origin.longitude.deg(), 13.41, 1e-8) << system;
    }
    EXPECT_THAT(citygml_refusal(gml_file(square_roof(32392068, 5820014, 20), "EPSG:25833")),
                HasSubstr("EPSG:25833: no place of this map lies 32392118 m east and 5820064 m north"));
}

TEST(CityGml, FilesOfOneMapLieBesideEachOther) {
    for (const std::string_view system : {"EPSG:32632", "EPSG:25832", "our own"}) {
        const auto first = read_citygml(gml_file(square_roof(691550, 5334730, 20), system));
        ASSERT_TRUE(first) << first.error().message;
        CityFileSettings beside;
        beside.origin = first->model.origin;
        beside.anchor = first->anchor;
        const auto second = read_citygml(gml_file(square_roof(692150, 5334730, 27), system), beside);
        ASSERT_TRUE(second) << second.error().message;
        const Eigen::Vector3d way = second->model.vertices.at(0) - first->model.vertices.at(0);
        EXPECT_NEAR(way.head<2>().norm(), 600, 0.1) << system;
        EXPECT_NEAR(way.z(), 7, 0.1) << system;
    }
}

TEST(CityGml, AFileOfAnotherMapIsNotSaidToLieBesideTheFirst) {
    const auto first = read_citygml(gml_file(square_roof(691550, 5334730, 20), "our own"));
    ASSERT_TRUE(first) << first.error().message;
    CityFileSettings beside;
    beside.origin = first->model.origin;
    beside.anchor = first->anchor;
    for (const auto& [system, of] :
         {std::pair("our own", "of the map, as for the file before"), std::pair("their own", "of the file")}) {
        const auto second = read_citygml(gml_file(square_roof(692150, 5334730, 27), system), beside);
        ASSERT_TRUE(second) << second.error().message;
        EXPECT_THAT(second->warnings, ::testing::Contains(::testing::AllOf(HasSubstr(system), HasSubstr(of))));
    }
}

/// The grid that the build made; where the machine has no proj-data there is none.
class CityHeightsTest : public ::testing::Test {
protected:
    void SetUp() override {
        auto geoid = Geoid::open(built_data() / "geoids/egm96-15.pgm");
        if (!geoid) GTEST_SKIP() << geoid.error().message;
        geoid_.emplace(std::move(*geoid));
        settings_.geoid = &*geoid_;
    }
    /// Up of a roof at 20 m in the file, at an origin of 100 m above the ellipsoid.
    [[nodiscard]] double up_of_roof(std::string_view places, std::string_view system) {
        const auto file = read_citygml(
            gml_file("<Building><lod2MultiSurface>" + gml_polygon(places) + "</lod2MultiSurface></Building>", system),
            settings_);
        EXPECT_TRUE(file) << file.error().message;
        return file ? file->model.vertices.at(0).z() : 0;
    }
    std::optional<Geoid> geoid_;
    CityFileSettings settings_;
};

TEST_F(CityHeightsTest, CountFromTheSeaWhereTheSystemOrTheKeySaysSo) {
    const std::string_view yokosuka = "35.26 139.74 20 35.2601 139.74 20 35.2601 139.7401 20 35.26 139.74 20";
    settings_.origin = Geodetic::degrees(35.26, 139.74, 100);
    const double geoid = geoid_->undulation(Angle::degrees(35.26), Angle::degrees(139.74)).value();
    EXPECT_GT(geoid, 30);
    EXPECT_NEAR(up_of_roof(yokosuka, "http://www.opengis.net/def/crs/EPSG/0/6697"), 20 + geoid - 100, 1e-3);
    EXPECT_NEAR(up_of_roof(yokosuka, "urn:ogc:def:crs,crs:EPSG::6668,crs:EPSG::6695"), 20 + geoid - 100, 1e-3);
    EXPECT_NEAR(up_of_roof(yokosuka, "EPSG:6667"), 20 - 100, 1e-3);
    settings_.heights = CityHeights::sea_level;
    EXPECT_NEAR(up_of_roof(yokosuka, "EPSG:6667"), 20 + geoid - 100, 1e-3);
    settings_.heights = CityHeights::ellipsoid;
    EXPECT_NEAR(up_of_roof(yokosuka, "EPSG:6697"), 20 - 100, 1e-3);
}

TEST_F(CityHeightsTest, OfAProjectionAreFittedToTheOriginUnlessTheyAreTold) {
    const std::string_view munich = "691603 5334780 20 691613 5334780 20 691613 5334790 20 691603 5334780 20";
    settings_.origin = Geodetic::degrees(48.1374, 11.5755, 100);
    const double geoid = geoid_->undulation(Angle::degrees(48.1374), Angle::degrees(11.5755)).value();
    EXPECT_NEAR(up_of_roof(munich, "EPSG:25832"), 0, 1e-3);
    EXPECT_NEAR(up_of_roof(munich, "EPSG:5555"), 20 + geoid - 100, 1e-3);
    EXPECT_NEAR(up_of_roof(munich, "EPSG:25832+7837"), 20 + geoid - 100, 1e-3);
    EXPECT_NEAR(up_of_roof(munich, "urn:adv:crs:ETRS89_UTM32*DE_DHHN2016_NH"), 20 + geoid - 100, 1e-3);
    EXPECT_NEAR(up_of_roof(munich, "urn:adv:crs:ETRS89_UTM32"), 0, 1e-3);
    settings_.heights = CityHeights::ellipsoid;
    EXPECT_NEAR(up_of_roof(munich, "EPSG:25832"), 20 - 100, 1e-3);
}

TEST_F(CityHeightsTest, AnOriginOfTheFileIsOnItsGroundAndAMissingGeoidIsTold) {
    const std::string town =
        gml_file("<Building><lod2MultiSurface>" +
                     gml_polygon("35.26 139.74 20 35.2601 139.74 20 35.2601 139.7401 20 35.26 139.74 20") +
                     "</lod2MultiSurface></Building>",
                 "EPSG:6697");
    const auto file = read_citygml(town, settings_);
    ASSERT_TRUE(file) << file.error().message;
    EXPECT_NEAR(file->model.origin.height.above_ellipsoid.value(), 55.3, 0.1);
    EXPECT_NEAR(file->model.vertices.at(0).z(), 0, 1e-3);
    EXPECT_THAT(file->warnings,
                ::testing::ElementsAre(::testing::AllOf(
                    HasSubstr("heights (JGD2011 (vertical) height of EPSG:6697) are taken as above mean "
                              "sea level, the geoid EGM96: the grid "),
                    HasSubstr(" is not installed"))));
    const auto without = read_citygml(town);
    ASSERT_TRUE(without) << without.error().message;
    EXPECT_NEAR(without->model.origin.height.above_ellipsoid.value(), 20, 1e-9);
    EXPECT_THAT(without->warnings, ::testing::ElementsAre(HasSubstr("the geoid's grid is not there")));
}

TEST(CityGml, DropsWrongPolygonsAndSaysSo) {
    const auto file = read_citygml(gml_file(
        "<Building><lod2MultiSurface>" + gml_polygon(roof_places) + gml_polygon("0 0 1 2") + gml_polygon("") +
        gml_polygon("a b c 1 2 3 4 5 6") + gml_polygon("0 0 nan 1 0 0 1 1 0") + "</lod2MultiSurface></Building>"));
    ASSERT_TRUE(file) << file.error().message;
    EXPECT_EQ(file->dropped, 4u);
    EXPECT_THAT(file->warnings, ::testing::Contains(HasSubstr("4 surfaces")));
}

// Amersfoort, a test point of RDNAPTRANS: 155000, 463000, 0 is 52.155172897° N 5.387203657°
// E, 43.2551 m.
TEST_F(CityHeightsTest, AgreeWithTheDutchTransformationToAMetre) {
    const auto file = read_citygml(gml_file(square_roof(154950, 462950, 0), "EPSG:7415"), settings_);
    ASSERT_TRUE(file) << file.error().message;
    const Position<Ecef> expected = to_ecef(Geodetic::degrees(52.155172897, 5.387203657, 43.2551));
    EXPECT_LT((to_ecef(file->model.origin).vector() - expected.vector()).norm(), 1);
}

TEST(CityGml, RefusesWithOneClearLine) {
    EXPECT_THAT(citygml_refusal("<CityModel>\n<a>"), HasSubstr("town.gml:2"));
    EXPECT_THAT(citygml_refusal(""), HasSubstr("no XML"));
    EXPECT_THAT(citygml_refusal("<kml/>"), HasSubstr("<kml>"));
    EXPECT_THAT(citygml_refusal("<CityModel/>"), HasSubstr("no surface"));
    std::string deep = "<CityModel>";
    for (int i = 0; i < 5000; ++i)
        deep += "<a>";
    for (int i = 0; i < 5000; ++i)
        deep += "</a>";
    EXPECT_THAT(citygml_refusal(deep + "</CityModel>"), HasSubstr("nest deeper"));
}

TEST(CityGml, ReadsYokosuka) {
    SKYLOOP_REQUIRE_SHARED(path, "city/52397519_bldg_6697_op.gml");
    const auto text = read_text_file(path);
    ASSERT_TRUE(text);
    const auto file = parse_citygml(*text, "yokosuka.gml", {});
    ASSERT_TRUE(file) << file.error().message;
    EXPECT_EQ(file->buildings, 13u);
    EXPECT_EQ(file->dropped, 0u);
    EXPECT_GT(count_of(file->model, SurfaceKind::wall), 100u);
    // The file states an envelope of 361 m by 301 m, 2.2 m to 21.7 m high.
    EXPECT_NEAR(file->model.origin.latitude.deg(), 35.26, 0.002);
    EXPECT_NEAR(file->model.origin.longitude.deg(), 139.739, 0.002);
    for (const Eigen::Vector3d& vertex : file->model.vertices) {
        EXPECT_LE(std::abs(vertex.x()), 151);
        EXPECT_LE(std::abs(vertex.y()), 181);
        EXPECT_LE(std::abs(vertex.z()), 19.6);
    }
}

}  // namespace
}  // namespace skyloop::test
