#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fmt/format.h>

#include "mesh_support.hpp"

namespace skyloop::obj_file_test {
namespace {

using test::refusal;
using ::testing::HasSubstr;

// Eight corners and six faces of a box.
std::string box(double east, double north, double side, double height, int first = 1) {
    std::string text;
    for (const double z : {0.0, height})
        for (const auto& [x, y] : {std::pair{0., 0.}, {1., 0.}, {1., 1.}, {0., 1.}})
            text += fmt::format("v {} {} {}\n", east + x * side, north + y * side, z);
    for (const auto& face :
         {std::array{0, 1, 2, 3}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}})
        text += fmt::format("f {} {} {} {}\n", first + face[0], first + face[1], first + face[2], first + face[3]);
    return text;
}

Result<CityFile> read_obj(std::string_view text, const CityFileSettings& settings = {}) {
    return parse_obj(text, "city.obj", settings);
}

TEST(ObjFile, TellsWallRoofAndGroundOfABox) {
    const auto file = read_obj(box(0, 0, 10, 20));
    ASSERT_TRUE(file) << file.error().message;
    test::expect_sound(*file);
    EXPECT_EQ(file->format, "obj");
    EXPECT_EQ(file->model.vertices.size(), 8U);
    EXPECT_EQ(test::count_of(file->model, SurfaceKind::wall), 8U);
    EXPECT_EQ(test::count_of(file->model, SurfaceKind::roof), 2U);
    EXPECT_EQ(test::count_of(file->model, SurfaceKind::ground), 2U) << "its floor, which covers its box";
    EXPECT_DOUBLE_EQ(test::area_of(file->model), 2 * 100 + 4 * 200);
}

TEST(ObjFile, AMarkOfTheEncodingIsNoPartOfTheFirstVertex) {
    const auto file = read_obj("\xEF\xBB\xBF" + box(0, 0, 10, 20));
    ASSERT_TRUE(file) << file.error().message;
    EXPECT_EQ(file->model.vertices.size(), 8U);
    EXPECT_DOUBLE_EQ(test::area_of(file->model), 2 * 100 + 4 * 200);
    EXPECT_TRUE(file->warnings.empty());
}

TEST(ObjFile, AFloorThatCoversLittleStaysARoof) {
    const auto file = read_obj(box(0, 0, 10, 20) + box(100, 100, 10, 20, 9));
    ASSERT_TRUE(file);
    EXPECT_EQ(test::count_of(file->model, SurfaceKind::ground), 0U);
    EXPECT_EQ(test::count_of(file->model, SurfaceKind::roof), 8U);
}

TEST(ObjFile, TakesGroundAndMaterialsFromNames) {
    const auto file = read_obj(
        "v 0 0 5\nv 1 0 5\nv 0 1 5\nv 0 0 9\n"
        "o Terrain.001\nf 1 2 3\n"
        "o House\nusemtl mat-itu_Brick\nf 1 2 4\nusemtl Glass.003\nf 1 3 4\nusemtl unheard\nf 2 3 4\n");
    ASSERT_TRUE(file);
    EXPECT_EQ(file->model.materials, (std::vector<std::string>{"concrete", "brick", "glass"}));
    ASSERT_EQ(file->model.triangles.size(), 4U);
    EXPECT_EQ(file->model.triangles[0].kind, SurfaceKind::ground);
    EXPECT_EQ(file->model.triangles[1].kind, SurfaceKind::wall);
    EXPECT_EQ(file->model.triangles[1].material, 1);
    EXPECT_EQ(file->model.triangles[2].material, 2);
    EXPECT_EQ(file->model.triangles[3].material, 0);
}

TEST(ObjFile, ReadsEveryFormOfACorner) {
    const auto file = read_obj(
        "# a comment\r\nmtllib a.mtl\r\nv 0 0 0 1.0\r\nv +1 0 0 0.5 0.5 0.5\nv\t0 1e0 .0\nvn 0 0 1\nvt 0 0\n"
        "s off\nf 1 2 3\nf 1/1 2/1 3/1\nf 1//1 2//1 3//1\nf 1/1/1 2/1/1 3/1/1\nf -3 -2 -1 # behind\n"
        "f 1 \\\n 2 3\n");
    ASSERT_TRUE(file) << file.error().message;
    EXPECT_EQ(file->model.triangles.size(), 6U);
    EXPECT_EQ(file->dropped, 0U);
    EXPECT_TRUE(file->warnings.empty());
    EXPECT_EQ(file->model.vertices[1].x(), 1.0);
}

TEST(ObjFile, CutsPolygonsThatAreNotConvexWithinTheirOutline) {
    // An L of 3 m², upright in the plane of x and z.
    const auto file = read_obj("v 0 7 0\nv 2 7 0\nv 2 7 1\nv 1 7 1\nv 1 7 2\nv 0 7 2\nf 2 3 4 5 6 1\n");
    ASSERT_TRUE(file);
    EXPECT_EQ(file->model.triangles.size(), 4U);
    EXPECT_NEAR(test::area_of(file->model), 3, 1e-12);
    // An arrow-head: a fan from its first corner would leave it.
    const auto arrow = read_obj("v 0 0 0\nv 2 1 0\nv 0 2 0\nv 1 1 0\nf 1 2 3 4\n");
    ASSERT_TRUE(arrow);
    EXPECT_NEAR(test::area_of(arrow->model), 1, 1e-12);
}

TEST(ObjFile, TurnsAxesAndUnits) {
    // A left-handed level in centimetres, x north: the tower at x = 300 m, y = 100 m stands north-east, at azimuth
    // atan2(100, 300), not mirrored to the other side of north-east.
    CityFileSettings settings;
    settings.axes = FileAxes::parse("y,x,z").value();
    settings.metres_per_unit = 0.01;
    const auto level = read_obj(box(0, 0, 1000, 900) + box(30'000, 10'000, 1000, 12'000, 9), settings);
    ASSERT_TRUE(level);
    const Eigen::Vector3d tower = test::highest_of(level->model);
    EXPECT_NEAR(tower.x(), 100, 1e-9) << "east";
    EXPECT_NEAR(tower.y(), 300, 1e-9) << "north";
    EXPECT_NEAR(tower.z(), 120, 1e-9);
    EXPECT_EQ(test::count_of(level->model, SurfaceKind::wall), 16U);
    EXPECT_TRUE(doubts_about(level->model).empty());

    CityFileSettings y_up;
    y_up.axes = FileAxes::parse("x,-z,y").value();
    const auto model = read_obj("v 5 30 -7\nv 6 0 -7\nv 5 0 -7\nf 1 2 3\n", y_up);
    ASSERT_TRUE(model);
    EXPECT_EQ(test::highest_of(model->model), Eigen::Vector3d(5, 7, 30));
}

TEST(ObjFile, LiesByItsOriginInTheCoordinatesOfAMap) {
    CityFileSettings utm;
    utm.file_origin = {392'118, 5'820'064, 35};
    const auto town = read_obj(box(392'108, 5'820'054, 20, 120), utm);
    ASSERT_TRUE(town) << town.error().message;
    EXPECT_NEAR((test::highest_of(town->model) - Eigen::Vector3d(-10, -10, 85)).norm(), 0, 1e-6);
    EXPECT_TRUE(doubts_about(town->model).empty());
    ASSERT_TRUE(town->anchor) << "height grids of the map lie beside it";
    EXPECT_FALSE(town->anchor->named);
    EXPECT_NEAR(town->anchor->east, 392'118, 1e-6);
    EXPECT_NEAR(town->anchor->level.value_or(0), 35, 1e-9);

    CityFileSettings feet;  // of a plane with x north, by its own units and axes
    feet.axes = FileAxes::parse("y,x,z").value();
    feet.metres_per_unit = 0.3048;
    feet.file_origin = {640'000, 200'100, 0};
    const auto plane = read_obj(box(640'010, 200'000, 10, 400), feet);
    ASSERT_TRUE(plane) << plane.error().message;
    EXPECT_NEAR((test::highest_of(plane->model) - Eigen::Vector3d(-30.48, 3.048, 121.92)).norm(), 0, 1e-6);

    CityFileSettings beside;
    beside.file_origin = {100, 50, 0};
    const auto local = read_obj(box(0, 0, 20, 120), beside);
    ASSERT_TRUE(local) << local.error().message;
    EXPECT_FALSE(local->anchor) << "such a number is of no map";
}

TEST(ObjFile, CountsWhatCannotBeUsedWithOneWarning) {
    const auto file = read_obj(
        "v 0 0 0\nv 10 0 0\nv 0 0 10\nv nan 0 0\nv 0 inf 0\nv 1e999 0 0\nv 1e-999 0 0\nv 1e200 0 0\n"
        "f 1 2 3\nf 1 2 4\nf 1 2 5\nf 1 2 6\nf 1 2 8\nf 1 2 3 4\nf 1 1 2\nf 1 2 2\nf 1 3 7\n");
    ASSERT_TRUE(file) << file.error().message;
    test::expect_sound(*file);
    EXPECT_EQ(file->model.triangles.size(), 1U);
    EXPECT_EQ(file->model.vertices.size(), 3U);
    EXPECT_EQ(file->dropped, 8U);
    ASSERT_EQ(file->warnings.size(), 1U);
    EXPECT_THAT(file->warnings[0], HasSubstr("dropped 5 facets with a corner that is no number"));
    EXPECT_THAT(file->warnings[0], HasSubstr("3 without area"));
}

TEST(ObjFile, TellsOfStatementsItDoesNotKnow) {
    const auto file = read_obj("v 0 0 0\nv 1 0 0\nv 0 1 0\nsurf 0 1 0 1\nf 1 2 3\ncurv 1 2\n");
    ASSERT_TRUE(file);
    ASSERT_EQ(file->warnings.size(), 1U);
    EXPECT_THAT(file->warnings[0], HasSubstr("city.obj:4: 2 statements"));
    EXPECT_THAT(file->warnings[0], HasSubstr("'surf'"));
}

TEST(ObjFile, NamesTheLineOfWhatIsWrong) {
    const std::string corners = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    EXPECT_THAT(refusal(read_obj(corners + "f 1 2 4\n")), HasSubstr("city.obj:4: a face names vertex 4, of 3"));
    EXPECT_THAT(refusal(read_obj(corners + "\nf 1 2 -4\n")), HasSubstr("city.obj:5: a face names vertex -4"));
    EXPECT_THAT(refusal(read_obj(corners + "f 0 1 2\n")), HasSubstr("city.obj:4: a face names vertex 0"));
    EXPECT_THAT(refusal(read_obj(corners + "f 1 2\n")), HasSubstr("city.obj:4: a face with 2 corners"));
    EXPECT_THAT(refusal(read_obj(corners + "f 1 2 99999999999999999999\n")), HasSubstr("city.obj:4:"));
    EXPECT_THAT(refusal(read_obj(corners + "f 1 2 3x\n")), HasSubstr("found '3x'"));
    EXPECT_THAT(refusal(read_obj("v 0 0\nv 1 0 0\n")), HasSubstr("city.obj:1: expected x, y and z"));
    EXPECT_THAT(refusal(read_obj("v 0 0 0\nv 1 0 zero\n")),
                HasSubstr("city.obj:2: expected x, y and z of a vertex, found 'zero' as z"));
    EXPECT_THAT(refusal(read_obj("f 1 2 3\n" + corners)), HasSubstr("city.obj:1: a face names vertex 1, of 0"));
}

TEST(ObjFile, RefusesNothingAtAll) {
    EXPECT_THAT(refusal(read_obj("")), HasSubstr("holds no triangle"));
    EXPECT_THAT(refusal(read_obj("v 0 0 0\n")), HasSubstr("holds no triangle"));
    EXPECT_THAT(refusal(read_obj("v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n")), HasSubstr("can be used"));
    EXPECT_THAT(refusal(read_obj(std::string_view("\0\1\2\377PK\3\4", 8))), HasSubstr("holds no triangle"));
}

TEST(ObjFile, RefusesMoreTrianglesThanAllowed) {
    CityFileSettings settings;
    settings.most_triangles = 12;
    EXPECT_TRUE(read_obj(box(0, 0, 10, 20), settings));
    settings.most_triangles = 11;
    EXPECT_THAT(refusal(read_obj(box(0, 0, 10, 20), settings)), HasSubstr("more than 11 triangles"));
    EXPECT_THAT(refusal(read_obj(box(0, 0, 10, 20), settings)), HasSubstr("GB of memory"));
    settings.most_triangles = 5;
    EXPECT_THAT(refusal(read_obj(box(0, 0, 10, 20), settings)), HasSubstr("more than 5 triangles"));
}

TEST(ObjFile, EveryCutOfAFileIsReadOrRefusedWithASentence) {
    const std::string whole = "o a\nusemtl brick\n" + box(0, 0, 10, 20) + "o ground\n" + box(5, 5, 3, 4, 9);
    for (std::size_t size = 0; size < whole.size(); ++size) {
        const auto file = read_obj(std::string_view(whole).substr(0, size));
        if (file)
            test::expect_sound(*file);
        else
            EXPECT_THAT(file.error().message, HasSubstr("city.obj")) << size;
    }
}

}  // namespace
}  // namespace skyloop::obj_file_test
