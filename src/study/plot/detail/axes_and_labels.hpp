/// A straight axis with round marks, over numbers of any size.
/// Where labels go so that they cover neither each other nor the marks.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "study/plot/svg_document.hpp"

namespace skyloop::inline study {

struct AxisScale {
    double from = 0, to = 1, step = 1;  ///< unit of the numbers; to > from

    /// Where a number stands along the axis, 0 … 1; numbers beyond an end stand at that end.
    [[nodiscard]] double place(double value) const;
    /// Round numbers on the axis.
    [[nodiscard]] std::vector<double> marks() const;
    [[nodiscard]] std::string label(double mark) const;
};

/// An axis over `low` … `high` with at most about `most` marks; it starts at zero where that is near. Equal numbers get
/// some room on both sides.
AxisScale axis_over(double low, double high, int most);

/// The part of ascending numbers that is worth an axis: all within ten interquartile ranges of the quartiles.
struct ShownRange {
    double low = 0, high = 0;
    std::size_t below = 0, above = 0;  ///< numbers outside
};
ShownRange shown_range(std::span<const double> sorted);

/// "2 of 900 beyond the axis, up to 812": what shown_range() left out, "" where it is nothing.
std::string outside_words(const ShownRange& range, std::span<const double> sorted);

/// Where a panel of a picture lies, pixels.
struct PanelArea {
    double left = 0, top = 0, width = 0, height = 0;
    [[nodiscard]] double bottom() const { return top + height; }
    [[nodiscard]] double right() const { return left + width; }
    [[nodiscard]] double x(const AxisScale& axis, double value) const { return left + width * axis.place(value); }
    [[nodiscard]] double y(const AxisScale& axis, double value) const { return bottom() - height * axis.place(value); }
};

/// The axis below a panel with lines across it, numbers and a name.
void draw_bottom_axis(SvgDocument& svg, const PanelArea& area, const AxisScale& axis, const std::string& name);
/// The same at its left.
void draw_left_axis(SvgDocument& svg, const PanelArea& area, const AxisScale& axis, const std::string& name);

/// `text` cut so that it is at most `width` pixels wide.
std::string fitting_text(const std::string& text, double width, double size);

/// A rectangle of the picture.
struct LabelBox {
    double left = 0, top = 0, width = 0, height = 0;
    [[nodiscard]] SvgPoint centre() const { return {left + width / 2, top + height / 2}; }
};

/// Finds places for labels one after the other. Its state is what is already taken.
class LabelPlacement {
public:
    /// An area that labels should not cover.
    void block(const LabelBox& box) { taken_.push_back(box); }
    /// Labels should stay inside this circle.
    void keep_inside(SvgPoint centre, double radius);
    /// The least bad place for a label of `size` beside a mark of `radius` at `mark`; it is taken from then on.
    LabelBox place(SvgPoint mark, double radius, SvgPoint size);

private:
    [[nodiscard]] double cost(const LabelBox& box) const;
    std::vector<LabelBox> taken_;
    SvgPoint centre_;
    double reach_ = 0;  ///< 0: no limit
};

}  // namespace skyloop::inline study
