/// A city from above: where its places lie in a picture, and how it is drawn there.
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "study/plot/svg_document.hpp"
#include "world/scene/urban_scene.hpp"

namespace skyloop::inline study {

/// A rectangle of the scene's ground and the rectangle of the picture that shows it; north is up.
class PlanView {
public:
    /// The largest picture of `area` (m east, north) at `corner` that is no larger than `size`.
    PlanView(const Eigen::AlignedBox2d& area, SvgPoint corner, SvgPoint size);
    [[nodiscard]] SvgPoint at(const Eigen::Vector2d& place) const;
    [[nodiscard]] SvgPoint at(const Eigen::Vector3d& place) const { return at(Eigen::Vector2d(place.head<2>())); }
    [[nodiscard]] const Eigen::AlignedBox2d& area() const { return area_; }
    [[nodiscard]] SvgPoint corner() const { return corner_; }
    [[nodiscard]] SvgPoint size() const { return {area_.sizes().x() * scale_, area_.sizes().y() * scale_}; }
    [[nodiscard]] double pixels_per_metre() const { return scale_; }

private:
    Eigen::AlignedBox2d area_;
    SvgPoint corner_;
    double scale_;
};

/// What is inside `box` of a convex polygon (Sutherland and Hodgman 1974); empty when nothing is.
std::vector<Eigen::Vector2d> clipped_polygon(std::vector<Eigen::Vector2d> polygon, const Eigen::AlignedBox2d& box);
/// What is inside `box` of a straight line (Liang and Barsky 1984). @returns false when nothing is
bool clip_line(Eigen::Vector2d& from, Eigen::Vector2d& to, const Eigen::AlignedBox2d& box);

/// The box around the scene with a margin, at most four times as long as wide.
Eigen::AlignedBox2d ground_box(const UrbanScene& scene);

/// Buildings shaded by height, walls as lines, trees green, the ground blank. Up to about 30,000 triangles are drawn as
/// such; of more, heights are sampled and drawn as runs, so that the picture stays below a few megabytes.
/// @param blank_ground false: what was drawn before shows between the buildings
/// @returns the height that the darkest shade stands for, m
double draw_city(SvgDocument& svg, const UrbanScene& scene, const PlanView& view, bool blank_ground = true);

/// A bar of a round length in the lower left corner of the view, and an arrow to the north in the upper right one.
void draw_scale_and_north(SvgDocument& svg, const PlanView& view);

}  // namespace skyloop::inline study
