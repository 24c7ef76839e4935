/// Where labels go so that they cover neither each other nor the marks.
#pragma once

#include <vector>

#include "study/plot/svg_document.hpp"

namespace skyloop {

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

}  // namespace skyloop
