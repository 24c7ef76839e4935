#include "study/plot/sky_plot.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "base/time/utc_time.hpp"
#include "study/plot/svg_document.hpp"
#include "unit/plot/well_formed.hpp"

namespace skyloop {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

SkyPlotSatellite drawn(int number, double azimuth, double elevation) {
    SkyPlotSatellite s;
    s.id = {Constellation::gps, number};
    s.azimuth = Angle::degrees(azimuth);
    s.elevation = Angle::degrees(elevation);
    return s;
}

SkyPlot empty_sky() {
    SkyPlot plot;
    plot.place = Geodetic::degrees(-33.5, 151.25, 40);
    plot.time = to_gps_time({2010, 7, 1, 12, 0, 0, 0}, LeapSeconds::announced());
    return plot;
}

// The mark of a used satellite: a circle with exactly this centre.
std::string mark_at(double x, double y) {
    return fmt::format("<circle cx=\"{}\" cy=\"{}\"", svg_number(x), svg_number(y));
}

TEST(SkyPlot, satellites_stand_where_azimuth_and_elevation_say) {
    SkyPlot plot = empty_sky();
    plot.satellites = {drawn(1, 90, 0), drawn(2, 0, 0), drawn(3, 180, 45), drawn(4, 270, 60), drawn(5, 123, 90)};
    const std::string svg = sky_plot_svg(plot);
    EXPECT_THAT(svg, HasSubstr(mark_at(sky_plot_centre_x + sky_plot_radius, sky_plot_centre_y)));
    EXPECT_THAT(svg, HasSubstr(mark_at(sky_plot_centre_x, sky_plot_centre_y - sky_plot_radius)));
    EXPECT_THAT(svg, HasSubstr(mark_at(sky_plot_centre_x, sky_plot_centre_y + sky_plot_radius / 2)));
    EXPECT_THAT(svg, HasSubstr(mark_at(sky_plot_centre_x - sky_plot_radius / 3, sky_plot_centre_y)));
    EXPECT_THAT(svg, HasSubstr(mark_at(sky_plot_centre_x, sky_plot_centre_y) + " r=\"7\""));
}

TEST(SkyPlot, is_well_formed_names_every_satellite_and_is_the_same_every_time) {
    SkyPlot plot = empty_sky();
    for (int i = 1; i <= 32; ++i) {
        plot.satellites.push_back(drawn(i, i * 47 % 360, i * 31 % 90));
        plot.satellites.back().cn0 = DbHz(15 + i);
        plot.satellites.back().used = i % 3 != 0;
        plot.satellites.back().healthy = i % 7 != 0;
        for (int k = -20; k < 0; ++k)
            plot.satellites.back().trail.push_back({Angle::degrees(i * 47 + k), Angle::degrees(i * 31 % 90 + 3 * k)});
    }
    plot.satellites.push_back(drawn(5, 10, 10));
    plot.satellites.back().id.constellation = Constellation::galileo;
    plot.mask = Angle::degrees(5);
    plot.dop = Dop{2.1, 1.8, 1.0, 1.5, 1.1, 0.7, 0.7};
    const std::string svg = sky_plot_svg(plot);
    EXPECT_EQ(test::xml_fault(svg), "");
    for (const SkyPlotSatellite& s : plot.satellites)
        EXPECT_THAT(svg, HasSubstr(">" + to_string(s.id) + "</text>"));
    for (const char* word : {"Sky at 33.50000° S, 151.25000° E, 40 m", "2010-07-01 12:00:00 UTC",
                             "33 above the horizon", "PDOP 1.80", ">N</text>", ">E</text>", ">S</text>", ">W</text>",
                             ">330°</text>", ">60°</text>", "mask 5°", ">GPS<", ">Galileo<", "50 dB-Hz", "unhealthy"})
        EXPECT_THAT(svg, HasSubstr(word));
    EXPECT_THAT(svg, Not(HasSubstr("nan")));
    EXPECT_THAT(svg, Not(HasSubstr("GLONASS")));
    EXPECT_EQ(svg, sky_plot_svg(plot));
}

TEST(SkyPlot, use_and_health_show) {
    SkyPlot plot = empty_sky();
    plot.satellites = {drawn(7, 90, 45)};
    const auto satellite_of = [](const SkyPlot& p) {
        const std::string svg = sky_plot_svg(p);
        const std::size_t start = svg.find("<g class=\"satellite\">");
        return svg.substr(start, svg.find("</g>", start) - start);
    };
    EXPECT_THAT(satellite_of(plot), HasSubstr("elevation 45.0°, used"));
    EXPECT_THAT(satellite_of(plot), HasSubstr("fill=\"#1f5fbf\""));
    plot.satellites[0].used = false;
    EXPECT_THAT(satellite_of(plot), HasSubstr("fill=\"#ffffff\" stroke=\"#1f5fbf\""));
    EXPECT_EQ(test::occurrences(satellite_of(plot), "<path"), 0u);
    plot.satellites[0].healthy = false;
    EXPECT_EQ(test::occurrences(satellite_of(plot), "<path"), 2u);
    EXPECT_THAT(satellite_of(plot), Not(HasSubstr("#1f5fbf")));
}

TEST(SkyPlot, a_stronger_signal_is_a_larger_mark) {
    SkyPlot plot = empty_sky();
    plot.satellites = {drawn(1, 90, 45)};
    const std::string place = mark_at(sky_plot_centre_x + sky_plot_radius / 2, sky_plot_centre_y);
    plot.satellites[0].cn0 = DbHz(10);
    EXPECT_THAT(sky_plot_svg(plot), HasSubstr(place + " r=\"4.5\""));
    plot.satellites[0].cn0 = DbHz(60);
    EXPECT_THAT(sky_plot_svg(plot), HasSubstr(place + " r=\"9.5\""));
}

TEST(SkyPlot, a_satellite_without_a_signal_is_the_smallest_mark) {
    SkyPlot plot = empty_sky();
    plot.satellites = {drawn(1, 90, 45), drawn(2, 270, 45)};
    const std::string silent = mark_at(sky_plot_centre_x + sky_plot_radius / 2, sky_plot_centre_y);
    EXPECT_THAT(sky_plot_svg(plot), HasSubstr(silent + " r=\"7\"")) << "no size tells of a C/N0";
    plot.satellites[1].cn0 = DbHz(25);
    EXPECT_THAT(sky_plot_svg(plot), HasSubstr(silent + " r=\"4.5\""));
}

TEST(SkyPlot, leaves_out_what_is_below_the_horizon_or_not_a_number) {
    SkyPlot plot = empty_sky();
    plot.satellites = {drawn(1, 90, -0.1), drawn(2, std::numeric_limits<double>::quiet_NaN(), 10),
                       drawn(3, 10, std::numeric_limits<double>::quiet_NaN())};
    plot.satellites[0].trail = {{Angle::degrees(80), Angle::degrees(-5)}};
    plot.title = "Empty <sky>";
    const std::string svg = sky_plot_svg(plot);
    EXPECT_EQ(test::xml_fault(svg), "");
    EXPECT_EQ(test::occurrences(svg, "class=\"satellite\""), 0u);
    EXPECT_THAT(svg, HasSubstr("Empty &lt;sky&gt;"));
    EXPECT_THAT(svg, HasSubstr("0 above the horizon"));
}

TEST(SkyPlot, is_made_from_a_listing) {
    TruthState truth;
    truth.time = empty_sky().time;
    truth.geodetic = empty_sky().place;
    SatelliteInView seen;
    seen.id = {Constellation::gps, 9};
    seen.azimuth = Angle::degrees(90);
    seen.healthy = false;
    SkyView sky;
    sky.satellites = {seen};
    const SkyPlot plot = sky_plot(sky_listing(truth, sky, Angle::degrees(10)));
    ASSERT_EQ(plot.satellites.size(), 1u);
    EXPECT_EQ(plot.satellites[0].id, seen.id);
    EXPECT_FALSE(plot.satellites[0].used);
    EXPECT_FALSE(plot.satellites[0].healthy);
    EXPECT_EQ(plot.mask, Angle::degrees(10));
    EXPECT_EQ(plot.time, truth.time);
}

}  // namespace
}  // namespace skyloop
