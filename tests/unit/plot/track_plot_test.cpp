#include "study/plot/track_plot.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "base/time/utc_time.hpp"
#include "unit/plot/well_formed.hpp"

namespace skyloop {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

constexpr double gps_radius = 26.56e6;

// A circle about the Z axis, or about the Y axis for an even number.
SatelliteTrack circle_track(int number, int points) {
    SatelliteTrack track{{Constellation::gps, number}, {}};
    const GpsTime start = to_gps_time({2010, 7, 1, 0, 0, 0, 0}, LeapSeconds::announced());
    for (int i = 0; i < points; ++i) {
        const double angle = 2 * std::numbers::pi * i / 144.0;
        const double c = gps_radius * std::cos(angle);
        const double s = gps_radius * std::sin(angle);
        track.points.push_back(
            {start + std::chrono::minutes(5 * i), number % 2 ? Position<Ecef>(c, s, 0) : Position<Ecef>(c, 0, s)});
    }
    return track;
}

std::string group_of(const std::string& svg, const std::string& name) {
    const std::size_t start = svg.find("<g class=\"" + name + "\">");
    if (start == std::string::npos) return {};
    return svg.substr(start, svg.find("</g>", start) - start);
}

TEST(TrackPlot, projection_is_isometric) {
    const IsometricPoint x = isometric(Position<Ecef>(1, 0, 0));
    const IsometricPoint y = isometric(Position<Ecef>(0, 1, 0));
    const IsometricPoint z = isometric(Position<Ecef>(0, 0, 1));
    for (const IsometricPoint& p : {x, y, z})
        EXPECT_NEAR(std::hypot(p.right, p.up), std::sqrt(2.0 / 3.0), 1e-12);
    EXPECT_LT(x.right, 0);
    EXPECT_GT(y.right, 0);
    EXPECT_LT(x.up, 0);
    EXPECT_NEAR(z.right, 0, 1e-12);
    EXPECT_GT(z.up, 0);
    const IsometricPoint p = isometric(Position<Ecef>(3, -4, 12));
    EXPECT_NEAR(std::hypot(p.right, p.up, p.towards_viewer), 13, 1e-12);
}

TEST(TrackPlot, the_earth_hides_what_is_behind_its_disc) {
    const double r = gps_radius / std::numbers::sqrt3;
    EXPECT_TRUE(hidden_by_earth(isometric(Position<Ecef>(-r, -r, -r))));
    EXPECT_FALSE(hidden_by_earth(isometric(Position<Ecef>(r, r, r))));
    EXPECT_FALSE(hidden_by_earth(isometric(Position<Ecef>(0, -gps_radius, 0))));
}

TEST(TrackPlot, is_well_formed_complete_and_the_same_every_time) {
    const std::vector<SatelliteTrack> tracks{circle_track(1, 145), circle_track(2, 145)};
    const std::string svg = track_plot_svg(tracks, "Tracks & more");
    EXPECT_EQ(test::xml_fault(svg), "");
    for (const char* word : {">G01</text>", ">G02</text>", "Tracks &amp; more", "X, Mm", "Y, Mm", "Z, Mm", ">-20<",
                             ">20<", "Earth", "2 satellites", "2010-07-01 00:00:00 UTC and 12 h on"})
        EXPECT_THAT(svg, HasSubstr(word));
    EXPECT_THAT(svg, Not(HasSubstr("nan")));
    EXPECT_EQ(svg, track_plot_svg(tracks, "Tracks & more"));
    EXPECT_EQ(test::occurrences(group_of(svg, "front"), "<path"), 2u);
    EXPECT_EQ(test::occurrences(group_of(svg, "back"), "<path"), 2u);
}

TEST(TrackPlot, a_track_behind_the_earth_is_drawn_lighter) {
    SatelliteTrack track{{Constellation::gps, 1}, {}};
    const double r = gps_radius / std::numbers::sqrt3;
    for (int i = 0; i < 5; ++i)
        track.points.push_back({GpsTime(std::chrono::minutes(i)), Position<Ecef>(-r + 4e5 * i, -r - 4e5 * i, -r)});
    const std::string svg = track_plot_svg(std::span(&track, 1), "behind");
    EXPECT_THAT(group_of(svg, "behind-earth"), HasSubstr("opacity=\"0.2\""));
    EXPECT_EQ(test::occurrences(group_of(svg, "front"), "<path"), 0u);
}

TEST(TrackPlot, a_gap_in_time_is_a_gap_in_the_line) {
    SatelliteTrack track = circle_track(1, 40);
    const auto moves = [&] {
        return test::occurrences(group_of(track_plot_svg(std::span(&track, 1), "gap"), "front"), "M");
    };
    const std::size_t whole = moves();
    track.points.erase(track.points.begin() + 8, track.points.begin() + 12);
    EXPECT_EQ(moves(), whole + 1);
}

TEST(TrackPlot, nothing_to_draw_is_an_empty_frame) {
    const std::vector<SatelliteTrack> tracks{{{Constellation::gps, 1}, {}}};
    const std::string svg = track_plot_svg(tracks, "none");
    EXPECT_EQ(test::xml_fault(svg), "");
    EXPECT_THAT(svg, HasSubstr("no satellites"));
    EXPECT_THAT(svg, Not(HasSubstr("G01")));
}

}  // namespace
}  // namespace skyloop
