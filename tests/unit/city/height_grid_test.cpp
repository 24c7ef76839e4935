#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fmt/format.h>

#include "mesh_support.hpp"

namespace skyloop::height_grid_test {
namespace {

using test::refusal;
using ::testing::HasSubstr;

Result<CityFile> read_grid(std::string_view text, const CityFileSettings& settings = {}) {
    return parse_height_grid(text, "hills.asc", settings);
}

TEST(HeightGrid, StandsNorthUpInMetres) {
    const auto file =
        read_grid("ncols 3\nnrows 2\nxllcorner 100\nyllcorner 200\ncellsize 10\nNODATA_value -9999\n1 2 3\n4 5 60\n");
    ASSERT_TRUE(file) << file.error().message;
    test::expect_sound(*file);
    EXPECT_EQ(file->format, "height grid");
    EXPECT_EQ(file->model.vertices.size(), 6U);
    EXPECT_EQ(test::count_of(file->model, SurfaceKind::ground), 4U);
    // The last height of the last row: the south-eastern cell, by its middle.
    EXPECT_EQ(test::highest_of(file->model), Eigen::Vector3d(125, 205, 60));
    const auto middles = read_grid("NROWS 2\nNCOLS 2\nXLLCENTER 0\nYLLCENTER 0\nCELLSIZE 5\n1 2 3 9\n");
    ASSERT_TRUE(middles);
    EXPECT_EQ(test::highest_of(middles->model), Eigen::Vector3d(5, 0, 9));
}

TEST(HeightGrid, LeavesOutCellsWithoutData) {
    const std::string head = "ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 10\nNODATA_value -9999\n";
    for (const char* heights : {"-9999 1 1 1", "1 -9999 1 1", "1 1 -9999 1", "1 1 1 -9999"}) {
        const auto file = read_grid(head + heights);
        ASSERT_TRUE(file) << file.error().message;
        EXPECT_EQ(file->model.triangles.size(), 1U) << heights;
        EXPECT_EQ(file->model.vertices.size(), 3U);
        EXPECT_EQ(file->dropped, 0U);
        EXPECT_DOUBLE_EQ(test::area_of(file->model), 50);
    }
    const auto broken = read_grid(head + "nan 1 1 1");
    ASSERT_TRUE(broken);
    EXPECT_EQ(broken->dropped, 1U);
    EXPECT_EQ(broken->warnings.size(), 1U);
    EXPECT_THAT(refusal(read_grid(head + "-9999 -9999 1 1")), HasSubstr("no four neighbours"));
}

TEST(HeightGrid, AHoleIsMarkedAsTheFormatSaysWhereNothingElseIsNamed) {
    const auto file =
        read_grid("\xEF\xBB\xBFncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 10\n-9999 500 500 500");
    ASSERT_TRUE(file) << file.error().message;
    EXPECT_EQ(file->model.triangles.size(), 1U);
    EXPECT_EQ(file->dropped, 0U);
    const auto named =
        read_grid("ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 10\nNODATA_value 0\n-9999 5 5 5");
    ASSERT_TRUE(named);
    EXPECT_EQ(named->model.triangles.size(), 2U);
}

TEST(HeightGrid, FineGridsInMetresAreNoDegrees) {
    std::string text = "ncols 100\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 0.1\n";
    for (int i = 0; i < 200; ++i)
        text += "3 ";
    const auto file = read_grid(text);
    ASSERT_TRUE(file) << file.error().message;
    EXPECT_NEAR(test::highest_of(file->model).z(), 3, 1e-12);
    EXPECT_NEAR(file->model.vertices.at(99).x(), 9.95, 1e-9);
}

TEST(HeightGrid, LiesBesideTheCityOfItsMap) {
    const std::string text =
        "ncols 3\nnrows 3\nxllcenter 691590\nyllcenter 5334770\ncellsize 10\n520 520 520 520 521 520 520 520 520";
    CityFileSettings settings;
    settings.origin = Geodetic::degrees(48.1374, 11.5755, 600);
    for (const std::string system : {"EPSG:25832", "a map of our own"}) {
        settings.anchor = MapAnchor{system, true, 691603.032, 5334780.031, 515};
        const auto file = read_grid(text, settings);
        ASSERT_TRUE(file) << file.error().message;
        EXPECT_NEAR(file->model.vertices.at(4).x(), -3.03, 0.1) << system;
        EXPECT_NEAR(file->model.vertices.at(4).y(), 0, 0.15) << system;
        EXPECT_NEAR(file->model.vertices.at(4).z(), 6, 0.01) << system;
    }
    settings.anchor.reset();
    const auto alone = read_grid(text, settings);
    ASSERT_TRUE(alone) << alone.error().message;
    EXPECT_NEAR(alone->model.vertices.at(4).norm(), 1, 1e-9) << "its middle at the origin, its ground at its height";
    EXPECT_THAT(alone->warnings, ::testing::Contains(HasSubstr("coordinates are projected (unnamed)")));
}

TEST(HeightGrid, LiesBesideTheMeshOfItsMap) {
    CityFileSettings settings;
    settings.origin = Geodetic::degrees(48.1374, 11.5755, 600);
    settings.file_origin = {691'603, 5'334'780, 515};
    const auto mesh =
        parse_obj("v 691600 5334780 515\nv 691620 5334780 515\nv 691600 5334780 535\nf 1 2 3\n", "a.obj", settings);
    ASSERT_TRUE(mesh) << mesh.error().message;
    const std::string text = "ncols 2\nnrows 2\nxllcenter 691590\nyllcenter 5334770\ncellsize 10\n520 521 520 520";
    EXPECT_THAT(read_grid(text, settings).value().warnings,
                ::testing::Contains(HasSubstr("file_origin means nothing")));
    settings.anchor = mesh->anchor;
    const auto grid = read_grid(text, settings);
    ASSERT_TRUE(grid) << grid.error().message;
    EXPECT_NEAR((test::highest_of(grid->model) - Eigen::Vector3d(-3, 0, 6)).norm(), 0, 1e-6);
    EXPECT_THAT(grid->warnings, ::testing::Not(::testing::Contains(HasSubstr("file_origin"))));
}

TEST(HeightGrid, PlacesDegreesOnTheGlobe) {
    const std::string text =
        "ncols 3\nnrows 3\nxllcenter 30.73\nyllcenter 46.47\ncellsize 0.001\n50 50 50\n50 50 50\n50 50 50\n";
    const auto file = read_grid(text);
    ASSERT_TRUE(file) << file.error().message;
    EXPECT_NEAR(file->model.origin.latitude.deg(), 46.471, 1e-12);
    EXPECT_NEAR(file->model.origin.longitude.deg(), 30.731, 1e-12);
    // A thousandth of a degree at 46.47°: 111.16 m north, 76.8 m east; all at the height of 50 m, less the curvature.
    const Eigen::Vector3d south_west = file->model.vertices[6];
    EXPECT_NEAR(south_west.x(), -76.8, 0.2);
    EXPECT_NEAR(south_west.y(), -111.16, 0.05);
    EXPECT_NEAR(south_west.z(), 50, 0.002);
    CityFileSettings elsewhere;
    elsewhere.origin = Geodetic::degrees(46.471, 30.731, 20);
    const auto lower = read_grid(text, elsewhere);
    ASSERT_TRUE(lower);
    EXPECT_NEAR(lower->model.vertices[4].z(), 30, 1e-6);
}

// As GDAL writes grids whose cells are no squares, Copernicus' north of 50° among them.
TEST(HeightGrid, CellsMayBeWiderThanTall) {
    const auto file = read_grid("ncols 3\nnrows 2\nxllcorner 0\nyllcorner 0\ndx 20\ndy 10\n1 2 3\n4 5 6\n");
    ASSERT_TRUE(file) << file.error().message;
    EXPECT_EQ(file->model.vertices[0], Eigen::Vector3d(10, 15, 1));
    EXPECT_EQ(file->model.vertices[5], Eigen::Vector3d(50, 5, 6));
    EXPECT_THAT(refusal(read_grid("ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ndx 1\ndy 0\n1 1 1 1")),
                HasSubstr("dx 1 and dy 0; expected more than 0"));
    EXPECT_THAT(refusal(read_grid("ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ndx 1\n1 1 1 1")),
                HasSubstr("cellsize, or dx and dy"));
}

TEST(HeightGrid, NamesTheLineOfWhatIsWrong) {
    const std::string head = "ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 10\n";
    EXPECT_THAT(refusal(read_grid("")), HasSubstr("hills.asc:1: '' is no key"));
    EXPECT_THAT(refusal(read_grid("columns 2\n")), HasSubstr("hills.asc:1: 'columns' is no key"));
    EXPECT_THAT(refusal(read_grid("ncols two\n")), HasSubstr("hills.asc:1: expected a number for ncols, found 'two'"));
    EXPECT_THAT(refusal(read_grid("ncols 2\nnrows 2\n1 2 3 4\n")), HasSubstr("hills.asc:2: expected ncols, nrows"));
    EXPECT_THAT(refusal(read_grid(head + "1 2\n3\n")), HasSubstr("ends where a height was expected"));
    EXPECT_THAT(refusal(read_grid(head + "1 2\n3 high\n")), HasSubstr("hills.asc:7: expected a height, found 'high'"));
    EXPECT_THAT(refusal(read_grid(head + "1 2\n3 4\n5\n")), HasSubstr("hills.asc:8: found '5' after the last"));
    EXPECT_THAT(refusal(read_grid("ncols 1\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1\n1 1")),
                HasSubstr("1 by 2 cells"));
    EXPECT_THAT(refusal(read_grid("ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize -1\n1 1 1 1")),
                HasSubstr("cellsize -1"));
    EXPECT_THAT(refusal(read_grid("ncols 2\nnrows 2\nxllcorner nan\nyllcorner 0\ncellsize 1\n1 1 1 1")),
                HasSubstr("nowhere"));
}

TEST(HeightGrid, BelievesNoCountBeforeTheBytesAreThere) {
    const auto head = [](std::string_view columns, std::string_view rows) {
        return fmt::format("ncols {}\nnrows {}\nxllcorner 0\nyllcorner 0\ncellsize 10\n1 2 3 4\n", columns, rows);
    };
    EXPECT_THAT(refusal(read_grid(head("1000000000", "1000000000"))), HasSubstr("GB of memory"));
    EXPECT_THAT(refusal(read_grid(head("1e300", "2"))), HasSubstr("cells"));
    EXPECT_THAT(refusal(read_grid(head("5000", "5000"))), HasSubstr("bytes are left"));
}

}  // namespace
}  // namespace skyloop::height_grid_test
