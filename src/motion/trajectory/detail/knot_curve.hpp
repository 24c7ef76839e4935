// Paths that were computed step by step.
// A curve of the fifth degree between two states of motion.
#pragma once

#include <Eigen/Core>

#include <algorithm>
#include <vector>

#include "motion/trajectory/local_shape.hpp"

namespace skyloop::inline motion {

// Keeps position, velocity and acceleration of both ends (FEEDS.md 1.13.3).
class QuinticPiece {
public:
    QuinticPiece() = default;
    // seconds: above zero
    QuinticPiece(const LocalMotion& from, const LocalMotion& to, double seconds) : seconds_(seconds) {
        const double h = seconds;
        const Eigen::Vector3d way = to.position - from.position;
        const Eigen::Vector3d v0 = h * from.velocity, v1 = h * to.velocity;
        const Eigen::Vector3d a0 = h * h * from.acceleration, a1 = h * h * to.acceleration;
        c_.col(0) = from.position;
        c_.col(1) = v0;
        c_.col(2) = a0 / 2;
        c_.col(3) = 10 * way - 6 * v0 - 4 * v1 - 1.5 * a0 + 0.5 * a1;
        c_.col(4) = -15 * way + 8 * v0 + 7 * v1 + 1.5 * a0 - a1;
        c_.col(5) = 6 * way - 3 * v0 - 3 * v1 - 0.5 * a0 + 0.5 * a1;
    }
    // t: s since its beginning. The heading is left as it is.
    [[nodiscard]] LocalMotion at(double t) const {
        const double u = t / seconds_;
        LocalMotion m;
        m.position = c_.col(0) + u * (c_.col(1) + u * (c_.col(2) + u * (c_.col(3) + u * (c_.col(4) + u * c_.col(5)))));
        m.velocity = (c_.col(1) + u * (2 * c_.col(2) + u * (3 * c_.col(3) + u * (4 * c_.col(4) + u * 5 * c_.col(5))))) /
                     seconds_;
        m.acceleration =
            (2 * c_.col(2) + u * (6 * c_.col(3) + u * (12 * c_.col(4) + u * 20 * c_.col(5)))) / (seconds_ * seconds_);
        return m;
    }
    [[nodiscard]] double seconds() const { return seconds_; }

private:
    Eigen::Matrix<double, 3, 6> c_ = Eigen::Matrix<double, 3, 6>::Zero();
    double seconds_ = 1;
};

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

}  // namespace skyloop::inline motion
