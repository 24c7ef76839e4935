#include "study/analysis/coverage_map.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/LU>

#include <cmath>

#include "unit/analysis/scene_shapes.hpp"
#include "world/gnss/dop.hpp"

namespace skyloop {
namespace {

using ::testing::HasSubstr;

SatelliteInView standing(int number, double azimuth_deg, double elevation_deg) {
    const LocalFrame frame(test::scene_origin());
    const double az = Angle::degrees(azimuth_deg).rad(), el = Angle::degrees(elevation_deg).rad();
    SatelliteInView s;
    s.id = {Constellation::gps, number};
    s.range = Metres(2.2e7);
    // Without travel time the Earth has not turned: it stands exactly there.
    s.position_at_transmission = frame.to_ecef(
        Position<Enu>(2.2e7 * Eigen::Vector3d(std::cos(el) * std::sin(az), std::cos(el) * std::cos(az), std::sin(el))));
    return s;
}

std::vector<CoverageEpoch> still_sky(std::initializer_list<SatelliteInView> satellites, int epochs = 3) {
    std::vector<CoverageEpoch> sky;
    for (int k = 0; k < epochs; ++k)
        sky.push_back({advanced(to_gps_time(2300, 0.0), Seconds(60.0 * k)), {satellites}});
    return sky;
}

std::vector<CoverageEpoch> good_sky() {
    return still_sky({standing(1, 0, 60), standing(2, 90, 30), standing(3, 180, 45), standing(4, 270, 20),
                      standing(5, 45, 80), standing(6, 200, 3)});
}

// About 40 by 60 m around the origin of the scenes.
CoverageGrid small_grid(double step) {
    return CoverageGrid::parse("30.73234,46.47723,30.73286,46.47777", Metres(step)).value();
}

TEST(CoverageGrid, lies_across_the_180th_meridian) {
    for (const char* area : {"179.999,-16.801,-179.999,-16.799", "179.999,-16.801,180.001,-16.799"}) {
        const auto grid = CoverageGrid::parse(area, 10);
        ASSERT_TRUE(grid) << grid.error().message;
        EXPECT_NEAR(grid->width(), 213.2, 0.2) << area;
        EXPECT_NEAR(std::abs(grid->middle().longitude.deg()), 180, 1e-9);
        EXPECT_LE(std::abs(grid->middle().longitude.deg()), 180);
    }
}

TEST(CoverageGrid, cuts_an_area_into_cells_of_about_the_step) {
    const CoverageGrid grid = small_grid(5);
    EXPECT_NEAR(grid.width(), 39.95, 0.1);
    EXPECT_NEAR(grid.height(), 60.03, 0.1);
    EXPECT_EQ(grid.columns, 8);
    EXPECT_EQ(grid.rows, 12);
    EXPECT_EQ(CoverageGrid::parse("30.73234,46.47723,30.73286,46.47777", 12)->rows, 12);
}

TEST(CoverageGrid, refuses_what_is_no_area_and_says_why) {
    const auto message = [](std::string_view text) { return CoverageGrid::parse(text, Metres(10)).error().message; };
    EXPECT_THAT(message("1,2,3"), HasSubstr("found 3 values"));
    EXPECT_THAT(message("2,1,1,3"), HasSubstr("west is not less than east"));
    EXPECT_THAT(message("1,3,2,3"), HasSubstr("south is not less than north"));
    EXPECT_THAT(message("1,x,2,3"), HasSubstr("'x'"));
    EXPECT_THAT(message("1,nan,2,3"), HasSubstr("'nan'"));
    EXPECT_THAT(message("0,0,10,10"), HasSubstr("too large"));
    EXPECT_THAT(message("0,0,0.5,0.5"), HasSubstr("cells"));
    EXPECT_FALSE(CoverageGrid::parse("0,0,0.1,0.1", Metres(0)));
    EXPECT_FALSE(CoverageGrid::parse("0,0,0.1,0.1", 0));
    EXPECT_FALSE(CoverageGrid::parse("0,0,0.1,0.1", Metres(1e-300)));
}

TEST(CoverageMap, of_an_open_sky_is_the_same_everywhere) {
    const CoverageMap map = coverage_map(nullptr, small_grid(10), good_sky(), {});
    ASSERT_EQ(map.cells.size(), 24u);
    const auto dop = dilution_of_precision(std::vector<SkyDirection>{{Angle::degrees(0), Angle::degrees(60)},
                                                                     {Angle::degrees(90), Angle::degrees(30)},
                                                                     {Angle::degrees(180), Angle::degrees(45)},
                                                                     {Angle::degrees(270), Angle::degrees(20)},
                                                                     {Angle::degrees(45), Angle::degrees(80)}});
    for (const CoverageCell& cell : map.cells) {
        ASSERT_TRUE(cell.figures);
        EXPECT_EQ(cell.figures->line_of_sight, 5);  // the sixth stands below the mask
        EXPECT_EQ(cell.figures->reflected, 0);
        EXPECT_EQ(cell.figures->fix_share, 1);
        EXPECT_EQ(cell.figures->line_of_sight_fix_share, 1);
        EXPECT_NEAR(*cell.figures->hdop, dop->hdop, 1e-4);
        EXPECT_NEAR(*cell.figures->pdop, dop->pdop, 1e-4);
        EXPECT_EQ(*cell.figures->reflection_error, 0);
    }
}

TEST(CoverageMap, in_a_canyon_shows_satellites_above_the_arctangent_of_height_over_distance) {
    constexpr double half_width = 10, wall = 30;
    CoverageSettings settings;
    settings.reflections = false;
    const double eastward_deg = 75;
    const CoverageMap map = coverage_map(test::canyon_scene(half_width, wall), small_grid(2),
                                         still_sky({standing(1, 90, eastward_deg)}), settings);
    int seen = 0, hidden = 0;
    for (const CoverageCell& cell : map.cells) {
        const double east = cell.position.x();
        if (std::abs(east) > half_width) continue;
        const double edge = std::atan((wall - 1.5) / (half_width - east)) / std::numbers::pi * 180;
        if (std::abs(edge - eastward_deg) < 0.1) continue;
        ASSERT_TRUE(cell.figures);
        EXPECT_EQ(cell.figures->line_of_sight, eastward_deg > edge ? 1 : 0) << east;
        (eastward_deg > edge ? seen : hidden) += 1;
    }
    EXPECT_GT(seen, 50);
    EXPECT_GT(hidden, 50);
}

TEST(CoverageMap, leaves_cells_inside_houses_empty) {
    const CoverageMap map = coverage_map(test::canyon_scene(10, 30), small_grid(4), good_sky(), {});
    std::size_t inside = 0;
    for (const CoverageCell& cell : map.cells) {
        if (std::abs(std::abs(cell.position.x()) - 10) < 0.1) continue;
        EXPECT_EQ(cell.figures.has_value(), std::abs(cell.position.x()) < 10) << cell.position.transpose();
        if (!cell.figures) ++inside;
    }
    EXPECT_GT(inside, 20u);
    EXPECT_THAT(coverage_csv(map), HasSubstr(",,,,,,,\n"));
}

TEST(CoverageMap, tells_the_error_that_a_reflection_makes_of_four_satellites) {
    // One wall stands west and hides what is low in the west; behind the antenna another one sends it back.
    const auto scene = test::canyon_scene(10, 30);
    CoverageSettings settings;
    settings.search.rays = 16384;
    const auto sky = still_sky({standing(1, 0, 50), standing(2, 180, 50), standing(3, 0, 85), standing(4, 270, 60)});
    const CoverageMap map = coverage_map(scene, small_grid(2), sky, settings);
    int reflected = 0;
    for (const CoverageCell& cell : map.cells) {
        if (!cell.figures || cell.figures->reflected != 1) continue;
        ++reflected;
        // Four satellites: no redundancy, and only satellite 4 and the near zenith tell east. Unknowns are solved here
        // by elimination: H dx = b with b of the one reflected satellite.
        Eigen::Matrix4d h;
        const double angles[4][2] = {{0, 50}, {180, 50}, {0, 85}, {270, 60}};
        for (int i = 0; i < 4; ++i) {
            const double az = Angle::degrees(angles[i][0]).rad(), el = Angle::degrees(angles[i][1]).rad();
            h.row(i) << std::cos(el) * std::sin(az), std::cos(el) * std::cos(az), std::sin(el), 1;
        }
        // From the eastern wall: 2 (distance to it) cos 60°; the satellite is due west.
        const double excess = 2 * (10 - cell.position.x()) * 0.5;
        const Eigen::Vector4d shift = h.partialPivLu().solve(Eigen::Vector4d(0, 0, 0, excess));
        EXPECT_NEAR(*cell.figures->reflection_error, shift.head<2>().norm(), 0.01 * shift.norm());
    }
    EXPECT_GT(reflected, 5);
}

TEST(CoverageMap, is_the_same_with_any_number_of_threads) {
    std::string first;
    for (const int threads : {1, 2, 4}) {
        CoverageSettings settings;
        settings.threads = threads;
        const std::string csv =
            coverage_csv(coverage_map(test::canyon_scene(10, 30), small_grid(6), good_sky(), settings));
        if (first.empty()) first = csv;
        EXPECT_EQ(csv, first) << threads;
    }
}

}  // namespace
}  // namespace skyloop
