// Labels are placed by a private part of the sky plot; what it promises shows in the picture: labels apart from each
// other.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <string>
#include <vector>

#include "study/plot/sky_plot.hpp"

namespace skyloop {
namespace {

struct DrawnLabel {
    double x = 0, y = 0;
};

// Anchors of the satellite labels, read back from the picture.
std::vector<DrawnLabel> labels_of(const std::string& svg) {
    std::vector<DrawnLabel> labels;
    for (std::size_t at = svg.find("class=\"satellite\""); at != std::string::npos;
         at = svg.find("class=\"satellite\"", at + 1)) {
        const std::size_t text = svg.find("<text x=\"", at);
        const std::size_t y = svg.find("y=\"", text);
        labels.push_back({std::strtod(svg.c_str() + text + 9, nullptr), std::strtod(svg.c_str() + y + 3, nullptr)});
    }
    return labels;
}

TEST(LabelPlacement, keeps_labels_of_neighbouring_satellites_apart) {
    SkyPlot plot;
    for (int i = 0; i < 4; ++i) {
        SkyPlotSatellite s;
        s.id = {Constellation::gps, i + 1};
        s.azimuth = Angle::degrees(90 + 4 * i);
        s.elevation = Angle::degrees(50);
        plot.satellites.push_back(s);
    }
    const std::vector<DrawnLabel> labels = labels_of(sky_plot_svg(plot));
    ASSERT_EQ(labels.size(), 4u);
    for (std::size_t i = 0; i < labels.size(); ++i)
        for (std::size_t j = i + 1; j < labels.size(); ++j) {
            const bool apart = std::abs(labels[i].x - labels[j].x) > 20 || std::abs(labels[i].y - labels[j].y) > 11;
            EXPECT_TRUE(apart) << i << " and " << j;
        }
}

TEST(LabelPlacement, keeps_a_label_inside_the_sky) {
    SkyPlot plot;
    SkyPlotSatellite s;
    s.id = {Constellation::gps, 1};
    s.azimuth = Angle::degrees(90);
    plot.satellites.push_back(s);
    const std::vector<DrawnLabel> labels = labels_of(sky_plot_svg(plot));
    ASSERT_EQ(labels.size(), 1u);
    EXPECT_LT(labels[0].x, sky_plot_centre_x + sky_plot_radius);
}

}  // namespace
}  // namespace skyloop
