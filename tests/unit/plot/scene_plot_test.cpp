#include "study/plot/scene_plot.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "study/plot/city_run_plot.hpp"
#include "study/plot/sky_plot.hpp"
#include "unit/plot/well_formed.hpp"
#include "world/scene/generated_city.hpp"

namespace skyloop {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

Geodetic plotted_origin() { return Geodetic::degrees(46.4775, 30.7326, 50); }

std::shared_ptr<const UrbanScene> plotted_demo() { return UrbanScene::build(demo_city(plotted_origin())).value(); }

ScenePlotRay plotted_ray(int number, Reception reception) {
    return {{Constellation::gps, number}, reception, {}, Eigen::Vector3d(0.6, 0, 0.8)};
}

TEST(ScenePlot, is_well_formed_and_shows_antenna_rays_scale_and_north) {
    const auto scene = plotted_demo();
    ScenePlot plot;
    plot.title = "A <city> & \"more\"";
    plot.observer = Eigen::Vector3d(0, 0, 1.5);
    plot.rays = {plotted_ray(1, Reception::line_of_sight), plotted_ray(2, Reception::reflected),
                 plotted_ray(3, Reception::blocked)};
    plot.rays[1].points = {Eigen::Vector3d(-10, 5, 4)};
    const std::string svg = scene_plot_svg(*scene, plot);
    EXPECT_EQ(test::xml_fault(svg), "");
    for (const char* part : {">G01<", ">G02<", ">G03<", "class=\"scale\"", ">N<", "G02: reflected"})
        EXPECT_THAT(svg, HasSubstr(part));
    EXPECT_EQ(svg, scene_plot_svg(*scene, plot));
}

TEST(ScenePlot, cuts_buildings_at_the_border_of_its_area) {
    CityModel city;
    city.origin = plotted_origin();
    city.add_quad({Eigen::Vector3d(-1000, -1000, 10), Eigen::Vector3d(1000, -1000, 10), Eigen::Vector3d(1000, 1000, 10),
                   Eigen::Vector3d(-1000, 1000, 10)},
                  SurfaceKind::roof);
    city.add_quad({Eigen::Vector3d(500, 500, 0), Eigen::Vector3d(501, 500, 0), Eigen::Vector3d(501, 501, 0),
                   Eigen::Vector3d(500, 501, 0)},
                  SurfaceKind::ground);
    ScenePlot plot;
    plot.area = scene_plot_area({0, 0, 0}, 100);
    const std::string svg = scene_plot_svg(*UrbanScene::build(city).value(), plot);
    // The square of 740 pixels is full: the roof reaches its corners and nothing lies beyond.
    EXPECT_THAT(svg, HasSubstr("30 76"));
    EXPECT_THAT(svg, HasSubstr("770 816"));
    EXPECT_THAT(svg, Not(HasSubstr("M-")));
    EXPECT_THAT(svg, Not(HasSubstr("L-")));
}

TEST(ScenePlot, of_a_large_city_stays_below_four_megabytes) {
    GeneratedCitySettings settings;
    settings.triangles = 100'000;
    const auto scene = UrbanScene::build(generated_city(settings, plotted_origin()).city).value();
    ASSERT_GT(scene->statistics().triangles, 70'000u);
    const std::string svg = scene_plot_svg(*scene, {});
    EXPECT_LT(svg.size(), 4u << 20);
    EXPECT_GT(svg.size(), 20'000u);
}

TEST(SkyPlotInACity, fills_what_buildings_hide_and_colours_by_reception) {
    SkyPlot plot;
    plot.place = plotted_origin();
    plot.obstruction = SkyMask();
    const std::string open = sky_plot_svg(plot);
    EXPECT_THAT(open, HasSubstr("100 % of the sky is open"));
    EXPECT_THAT(open, Not(HasSubstr("#c3cad3")));
    EXPECT_THAT(open, Not(testing::AnyOf(HasSubstr("above the horizon"), HasSubstr("unhealthy"), HasSubstr("UTC"))));
    plot.title = "town.obj";
    const std::string named = sky_plot_svg(plot);
    EXPECT_THAT(named, testing::AllOf(HasSubstr(">town.obj</text>"), HasSubstr(">Sky at "),
                                      HasSubstr(" m   ·   100 % of the sky is open</text>")));
    // From azimuth 90° to 91° the lowest half is hidden, with a gap of 10° in it.
    for (int elevation = 0; elevation < 45; ++elevation)
        plot.obstruction->blocked[static_cast<std::size_t>(90 * SkyMask::elevations + elevation)] =
            elevation < 20 || elevation >= 30;
    plot.satellites.push_back(
        {{Constellation::gps, 5}, Angle::degrees(10), Angle::degrees(50), {}, true, true, Reception::reflected, {}});
    const std::string svg = sky_plot_svg(plot);
    EXPECT_EQ(test::xml_fault(svg), "");
    EXPECT_THAT(svg, HasSubstr("#c3cad3"));
    EXPECT_EQ(test::occurrences(svg.substr(svg.find("of the sky is open"), 1200), "Z"), 2u);
    EXPECT_THAT(svg, HasSubstr("elevation 50.0°, reflected, used"));
}

CoverageMap plotted_map(int columns, int rows) {
    CoverageMap map;
    map.grid = CoverageGrid::parse("30.730,46.475,30.735,46.480", 10).value();
    map.grid.columns = columns;
    map.grid.rows = rows;
    map.start = map.end = to_gps_time(2300, 0.0);
    map.epochs = 1;
    const double east = map.grid.width() / columns, north = map.grid.height() / rows;
    for (int i = 0; i < columns * rows; ++i) {
        CoverageCell cell;
        cell.position = {east * (i % columns + 0.5), north * (i / columns + 0.5), 0};
        if (i % 7 != 0) {
            cell.figures.emplace();
            cell.figures->line_of_sight = i * 37 % 12;
            cell.figures->hdop = 1 + i % 3;
        }
        map.cells.push_back(cell);
    }
    return map;
}

TEST(CoveragePlot, is_well_formed_for_every_quantity_with_and_without_buildings) {
    const auto scene = plotted_demo();
    for (std::size_t i = 0; i < coverage_quantity_names.size(); ++i)
        for (const UrbanScene* city : {static_cast<const UrbanScene*>(nullptr), scene.get()}) {
            const std::string svg = coverage_plot_svg(plotted_map(13, 9), static_cast<CoverageQuantity>(i), city);
            EXPECT_EQ(test::xml_fault(svg), "") << coverage_quantity_names[i];
        }
}

TEST(CoveragePlot, of_many_cells_stays_below_eight_megabytes) {
    EXPECT_LT(coverage_plot_svg(plotted_map(1000, 1000), CoverageQuantity::line_of_sight, nullptr).size(), 8u << 20);
}

TEST(CityRunPlot, is_well_formed_for_long_runs_and_single_epochs) {
    CityRun run;
    run.start = "2026-01-01T00:00:00.000Z";
    for (int i = 0; i < 5000; ++i) {
        CityRunEpoch epoch;
        epoch.since_start = Seconds(i);
        epoch.truth = Geodetic::degrees(46.4775 + 1e-6 * i, 30.7326 + 1e-7 * i * (i % 10), 52);
        epoch.received = {i / 500, 0, i % 3, 0};
        if (i % 50 > 5) epoch.error = Metres(i % 40);
        run.epochs.push_back(epoch);
    }
    const auto scene = plotted_demo();
    const std::string svg = city_run_plot_svg(run, scene.get(), "Through <the> city");
    EXPECT_EQ(test::xml_fault(svg), "");
    EXPECT_LT(svg.size(), 2u << 20);
    run.epochs.resize(1);
    EXPECT_EQ(test::xml_fault(city_run_plot_svg(run, nullptr, "one epoch")), "");
    run.epochs.clear();
    EXPECT_EQ(test::xml_fault(city_run_plot_svg(run, nullptr, "none")), "");
}

}  // namespace
}  // namespace skyloop
