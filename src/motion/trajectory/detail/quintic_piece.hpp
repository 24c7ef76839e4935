// A curve of the fifth degree between two states of motion.
#pragma once

#include <Eigen/Core>

#include "motion/trajectory/local_shape.hpp"

namespace skyloop {

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

}  // namespace skyloop
