// Paths that were computed step by step.
#pragma once

#include <algorithm>
#include <vector>

#include "quintic_piece.hpp"

namespace skyloop {

// A curve of the fifth degree through states of motion.
class KnotCurve : public LocalShape {
public:
    explicit KnotCurve(const LocalMotion& beginning) : knots_{{0, beginning}} {}
    // t: s since the beginning, after that of the knot before. The curve ends at rest with its last knot.
    void add(double t, const LocalMotion& motion) { knots_.push_back({t, motion}); }
    [[nodiscard]] double duration() const override { return knots_.back().t; }
    [[nodiscard]] const LocalMotion& end() const { return knots_.back().motion; }
    [[nodiscard]] LocalMotion at(double t) const override {
        if (t <= 0 || knots_.size() < 2) return knots_.front().motion;
        if (t >= duration()) return knots_.back().motion;
        const auto after = std::upper_bound(knots_.begin(), knots_.end(), t,
                                            [](double value, const Knot& knot) { return value < knot.t; });
        const Knot& from = *std::prev(after);
        LocalMotion m = QuinticPiece(from.motion, after->motion, after->t - from.t).at(t - from.t);
        m.heading = from.motion.heading;
        return m;
    }

private:
    struct Knot {
        double t;
        LocalMotion motion;
    };
    std::vector<Knot> knots_;
};

}  // namespace skyloop
