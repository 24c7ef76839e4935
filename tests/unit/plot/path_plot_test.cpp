// The picture of a path.
#include "study/plot/path_plot.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "motion/trajectory/geometric_paths.hpp"
#include "unit/plot/well_formed.hpp"

namespace skyloop {
namespace {

std::vector<PathSample> plotted(const Trajectory& path, double seconds) {
    return *sample_path(path, {to_gps_time(2300, 0), Seconds(seconds)}, Hertz(2));
}

TEST(PathPlot, ShowsTheWayAndBothCurvesOverTime) {
    const Circle circle(to_gps_time(2300, 0),
                        {Geodetic::degrees(47, 8, 500), Metres(100), MetresPerSecond(10), Angle()});
    const auto samples = plotted(circle, 20 * std::numbers::pi);
    const std::string svg = path_plot_svg(samples, "A <circle>");
    EXPECT_EQ(svg, path_plot_svg(samples, "A <circle>"));
    EXPECT_EQ(test::xml_fault(svg), "");
    EXPECT_NE(svg.find("A &lt;circle&gt;"), std::string::npos);
    for (const std::string_view part : {"height, m above the ellipsoid", "speed, m/s", "time, s", "10 m/s", "50 m"})
        EXPECT_NE(svg.find(part), std::string::npos) << part;
}

TEST(PathPlot, BreaksTheLineAtAJump) {
    const Circle circle(to_gps_time(2300, 0),
                        {Geodetic::degrees(47, 8, 500), Metres(100), MetresPerSecond(10), Angle()});
    auto samples = plotted(circle, 30);
    const std::string whole = path_plot_svg(samples, "path");
    for (std::size_t i = 30; i < samples.size(); ++i)
        samples[i].state.position = samples[i].state.position + Displacement<Ecef>(0, 0, 5000);
    const std::string broken = path_plot_svg(samples, "path");
    EXPECT_GT(test::occurrences(broken, "M"), test::occurrences(whole, "M"));
}

TEST(PathPlot, TakesWhatStandsStillAndNothing) {
    const FixedPoint still(Geodetic::degrees(-90, 0, 0));
    for (const std::string& svg : {path_plot_svg(plotted(still, 1), "still"), path_plot_svg({}, "nothing")}) {
        EXPECT_EQ(svg.find("nan"), std::string::npos);
        EXPECT_EQ(test::xml_fault(svg), "");
    }
}

}  // namespace
}  // namespace skyloop
