#include "study/plot/scatter_plot.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "base/core/random.hpp"
#include "unit/plot/well_formed.hpp"

namespace skyloop {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

ScatterCloud normal_cloud(const std::string& name, std::size_t n, double sigma_east, double sigma_north) {
    RandomStream random(1, name);
    ScatterCloud cloud;
    cloud.name = name;
    for (std::size_t i = 0; i < n; ++i) {
        cloud.errors.east.push_back(sigma_east * random.normal());
        cloud.errors.north.push_back(sigma_north * random.normal());
        cloud.errors.horizontal.push_back(std::hypot(cloud.errors.east.back(), cloud.errors.north.back()));
    }
    return cloud;
}

TEST(ScatterPlot, is_well_formed_and_names_both_clouds_and_the_percentage) {
    const ScatterCloud a = normal_cloud("sim & co", 900, 1.5, 2);
    const ScatterCloud b = normal_cloud("real", 500, 1.6, 1.9);
    const std::string svg = scatter_plot_svg(a, b);
    EXPECT_EQ(test::xml_fault(svg), "");
    for (const char* word : {"sim &amp; co", ">real<", "900 fixes", "500 fixes", "east error, m", "north error, m",
                             "fixes, %", "horizontal error, m", "95 % ellipse"})
        EXPECT_THAT(svg, HasSubstr(word));
    EXPECT_THAT(svg, ::testing::ContainsRegex("difference [0-9.]+ %, agreement [0-9.]+ %"));
    EXPECT_THAT(svg, Not(HasSubstr("nan")));
    EXPECT_EQ(test::occurrences(svg, "<ellipse"), 2u);
    EXPECT_EQ(svg, scatter_plot_svg(a, b));
}

TEST(ScatterPlot, tells_no_agreement_below_zero) {
    const std::string svg = scatter_plot_svg(normal_cloud("sim", 900, 8, 8), normal_cloud("real", 900, 2, 2));
    EXPECT_THAT(svg, ::testing::ContainsRegex("horizontal error: difference [23][0-9][0-9]\\.[0-9] % \\(mean"));
    EXPECT_THAT(svg, Not(HasSubstr("agreement")));
}

TEST(ScatterPlot, histograms_show_the_chosen_error_with_its_sign) {
    ScatterCloud a = normal_cloud("sim", 900, 1.5, 2);
    ScatterCloud b = normal_cloud("real", 500, 1.6, 1.9);
    for (ScatterCloud* cloud : {&a, &b}) {
        RandomStream random(2, cloud->name);
        for (std::size_t i = 0; i < cloud->errors.east.size(); ++i)
            cloud->errors.up.push_back(20 + 3 * random.normal());
    }
    const std::string svg = scatter_plot_svg(a, b, ErrorQuantity::up);
    EXPECT_EQ(test::xml_fault(svg), "");
    EXPECT_THAT(svg, ::testing::ContainsRegex("up error: difference [0-9.]+ %, agreement [0-9.]+ %"));
    EXPECT_THAT(svg, ::testing::ContainsRegex("total variation 0\\.[0-9]+, Kolmogorov–Smirnov 0\\.[0-9]+"));
    EXPECT_THAT(svg, HasSubstr(">up error, m<"));
    EXPECT_THAT(svg, ::testing::ContainsRegex("mean (19|20)\\.[0-9]+ m"));
    EXPECT_THAT(svg, HasSubstr(">-20<"));
    for (double& up : a.errors.up)
        up -= 20;
    for (double& up : b.errors.up)
        up -= 20;
    EXPECT_THAT(scatter_plot_svg(a, b, ErrorQuantity::up), HasSubstr("mean of the reference is near zero"));
}

TEST(ScatterPlot, a_wild_fix_is_counted_and_does_not_shrink_the_rest) {
    ScatterCloud a = normal_cloud("sim", 1000, 1, 1);
    const ScatterCloud b = normal_cloud("real", 1000, 1, 1);
    a.errors.east[5] = 5000;
    a.errors.horizontal[5] = 5000;
    const std::string svg = scatter_plot_svg(a, b);
    EXPECT_THAT(svg, ::testing::ContainsRegex("1000 fixes, [123] outside"));
    EXPECT_THAT(svg, HasSubstr(">-2<"));
    // The ellipse that the wild fix has blown up is left out, the other stays.
    EXPECT_EQ(test::occurrences(svg, "<ellipse"), 1u);
}

TEST(ScatterPlot, many_fixes_are_thinned) {
    const ScatterCloud many = normal_cloud("many", 20000, 1, 1);
    const std::string svg = scatter_plot_svg(many, many);
    EXPECT_LT(svg.size(), 600000u);
    EXPECT_THAT(svg, HasSubstr("20000 fixes"));
}

TEST(ScatterPlot, empty_and_constant_clouds_are_drawn_without_figures) {
    ScatterCloud still;
    still.name = "still";
    still.errors.east = still.errors.north = still.errors.horizontal = {0, 0, 0};
    const std::string svg = scatter_plot_svg({"none", {}}, still);
    EXPECT_EQ(test::xml_fault(svg), "");
    EXPECT_THAT(svg, HasSubstr("no percentage can be given"));
    EXPECT_THAT(svg, Not(HasSubstr("nan")));
    EXPECT_THAT(svg, Not(HasSubstr("inf")));
}

TEST(ScatterPlot, ellipse_has_the_axes_of_the_cloud_and_holds_95_percent) {
    // East and north rotated by 30° from independent axes of 3 m and 1 m: the major axis points to azimuth 60°.
    const ScatterCloud cloud = normal_cloud("ellipse", 40000, 3, 1);
    std::vector<double> east, north;
    const double turn = 30 * std::acos(-1.0) / 180;
    for (std::size_t i = 0; i < cloud.errors.east.size(); ++i) {
        const double u = cloud.errors.east[i], v = cloud.errors.north[i];
        east.push_back(u * std::cos(turn) - v * std::sin(turn));
        north.push_back(u * std::sin(turn) + v * std::cos(turn));
    }
    const ErrorEllipse ellipse = error_ellipse_95(east, north);
    EXPECT_NEAR(ellipse.major, 3 * 2.4477, 0.1);
    EXPECT_NEAR(ellipse.minor, 2.4477, 0.04);
    EXPECT_NEAR(ellipse.azimuth.deg(), 60, 1);
    std::size_t inside = 0;
    for (std::size_t i = 0; i < cloud.errors.east.size(); ++i)
        if (std::hypot(cloud.errors.east[i] / ellipse.major, cloud.errors.north[i] / ellipse.minor) <= 1) ++inside;
    EXPECT_NEAR(static_cast<double>(inside) / static_cast<double>(east.size()), 0.95, 0.005);
    EXPECT_EQ(error_ellipse_95({}, {}).major, 0);
}

}  // namespace
}  // namespace skyloop
